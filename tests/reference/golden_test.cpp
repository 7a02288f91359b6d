// The reference in double, without a cut-off, against renders of the published code. Exact agreement is not
// to be had: the goldens come from float with half-precision planes, and a cell within rounding of a near
// limit changes many pixels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "foam/checkpoint/checkpoint.h"
#include "reference/image/metrics.h"
#include "reference/render/reference.h"
#include "tests/surroundings.h"

namespace froth {
namespace {

struct Golden {
  Image colour, alpha, distance;
};

class AgainstPublishedRenders : public ::testing::Test {
 protected:
  void SetUp() override {
    root_ = test::dataFolder() / "foams";
    if (!std::filesystem::exists(root_)) FROTH_SKIP() << "no foams at " << root_ << "; set FROTH_DATA";
  }

  void render(const std::string& name, size_t viewIndex) {
    const Result<Foam> foam = importCheckpoint(root_ / name / "model.pt");
    ASSERT_TRUE(foam) << foam.error().message;
    const Result<CameraSet> cameras = readCameras(root_ / name / "cameras.json");
    ASSERT_TRUE(cameras) << cameras.error().message;
    const View& view = cameras->views.at(viewIndex);
    ReferenceOptions options;
    options.nearDepth = *view.nearDepth;
    Result<RenderedImages> images = ReferenceRenderer(*foam).render(view, options);
    ASSERT_TRUE(images) << images.error().message;
    images_ = std::move(*images);
    golden_ = {load(name, view.goldenColour), load(name, view.goldenAlpha), load(name, view.goldenDepth)};
  }

  Image load(const std::string& name, const std::string& file) const {
    Result<Image> image = readImage(root_ / name / file, &images_.alpha);
    if (image) return std::move(*image);
    ADD_FAILURE() << image.error().message;
    return {};
  }

  std::filesystem::path root_;
  RenderedImages images_;
  Golden golden_;
};

TEST_F(AgainstPublishedRenders, MikuPlushView0AgreesInColourAlphaAndDepth) {
  ASSERT_NO_FATAL_FAILURE(render("miku_plush", 0));
  EXPECT_GE(compareImages(images_.colour, golden_.colour)->psnr, 69);
  EXPECT_GE(compareImages(images_.alpha, golden_.alpha)->psnr, 70);

  std::vector<double> differences;
  size_t foundInOne = 0;
  for (size_t i = 0; i < golden_.distance.values.size(); ++i) {
    const float ours = images_.distance.values[i], theirs = golden_.distance.values[i];
    if ((ours < 0) != (theirs < 0)) {
      ++foundInOne;
    } else if (ours >= 0) {
      differences.push_back(std::abs(ours - theirs));
    }
  }
  ASSERT_FALSE(differences.empty());
  const auto median = differences.begin() + std::ptrdiff_t(differences.size() / 2);
  std::nth_element(differences.begin(), median, differences.end());
  EXPECT_LE(*median, 2e-3);
  EXPECT_LE(double(foundInOne), 1e-4 * double(golden_.distance.values.size()));
}

TEST_F(AgainstPublishedRenders, MikuPlushView6Agrees) {
  ASSERT_NO_FATAL_FAILURE(render("miku_plush", 6));
  EXPECT_GE(compareImages(images_.colour, golden_.colour)->psnr, 72);
}

TEST_F(AgainstPublishedRenders, TankardRoughView2AgreesWithItsNearDepth) {
  ASSERT_NO_FATAL_FAILURE(render("tankard_rough", 2));
  EXPECT_GE(compareImages(images_.colour, golden_.colour)->psnr, 57);
}

}  // namespace
}  // namespace froth
