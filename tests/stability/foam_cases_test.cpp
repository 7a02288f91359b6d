// What becomes of a user's foam.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "baker/synth/synth.h"
#include "measure/stability/case_judge.h"
#include "measure/stability/cases/stiff_case.h"
#include "reference/camera/view_rays.h"
#include "reference/image/metrics.h"
#include "reference/render/reference.h"

namespace froth {
namespace {

View frontView() {
  View view;
  view.name = "front";
  view.width = 320, view.height = 200;
  view.fx = view.fy = 200, view.cx = 160, view.cy = 100;
  view.worldFromCamera = {1, 0, 0, 0.2, 0, 1, 0, 0.3, 0, 0, 1, -2.5};
  return view;
}

class FoamCases : public testing::Test {
 protected:
  void SetUp() override {
    Result<Foam> foam = synthesizeFoam({"random", 0, 1});
    ASSERT_TRUE(foam) << foam.error().message;
    foam_ = std::move(*foam);
    cases_ = casesOfFoam(foam_, {frontView()});
  }
  const StiffCase& find(const std::string& name) const {
    for (const StiffCase& found : cases_) {
      if (found.name == name) return found;
    }
    ADD_FAILURE() << name;
    return cases_[0];
  }
  RenderedImages render(const StiffCase& stiffCase) const {
    Result<RenderedImages> images =
        ReferenceRenderer(stiffCase.foam).render(stiffCase.views[0], optionsOfCase(stiffCase, 0));
    EXPECT_TRUE(images);
    return images ? std::move(*images) : RenderedImages{};
  }

  Foam foam_;
  std::vector<StiffCase> cases_;
};

TEST_F(FoamCases, AreTwelveOfDifferentNamesAndAtMost160PixelsWide) {
  std::set<std::string> names;
  for (const StiffCase& stiffCase : cases_) {
    names.insert(stiffCase.name);
    EXPECT_EQ(stiffCase.views[0].width, 160u);
    EXPECT_EQ(stiffCase.views[0].height, 100u);
  }
  EXPECT_EQ(names.size(), 12u);
}

TEST_F(FoamCases, OtherUnitsGiveTheSameImage) {
  const RenderedImages plain = render(find("foam/placed_1e+03_away"));
  for (const char* name : {"foam/units_1e-06", "foam/units_1e+06"}) {
    EXPECT_LE(compareImages(render(find(name)).colour, plain.colour)->maxError, 1e-4) << name;
  }
}

TEST_F(FoamCases, FloatsAThousandUnitsAwayGiveNearlyTheSameImage) {
  const RenderedImages plain = render(find("foam/placed_1e+03_away"));
  EXPECT_LE(compareImages(render(find("foam/saved_1e+03_away")).colour, plain.colour)->maxError, 0.05);
}

// Power distance of a point, which may lie outside the floats.
double power(const Foam& foam, uint32_t cell, const glm::dvec3& point) {
  const glm::dvec3 local = point - glm::dvec3(foam.sites[cell]);
  return glm::dot(local, local) - double{foam.radii[cell]} * foam.radii[cell];
}

// How many cells share the least power at a point, but for rounding.
uint32_t countNearest(const Foam& foam, const glm::dvec3& point) {
  double least = INFINITY;
  for (uint32_t i = 0; i < foam.cellCount; ++i) least = std::min(least, power(foam, i, point));
  uint32_t count = 0;
  for (uint32_t i = 0; i < foam.cellCount; ++i) count += power(foam, i, point) <= least + 1e-12;
  return count;
}

TEST_F(FoamCases, EyesLieWhereTheirNamesSay) {
  EXPECT_GE(countNearest(foam_, eyeOf(find("foam/eye_on_vertex").views[0])), 4u);
  const glm::dvec3 site = eyeOf(find("foam/eye_on_site").views[0]);
  const auto found = std::find(foam_.sites.begin(), foam_.sites.end(), glm::vec3(site));
  ASSERT_NE(found, foam_.sites.end());
  EXPECT_EQ(glm::dvec3(*found), site);
  const auto cell = static_cast<uint32_t>(found - foam_.sites.begin());
  EXPECT_NEAR(power(foam_, cell, eyeOf(find("foam/eye_on_sphere").views[0])), 0, 1e-12);
  const glm::dvec3 onPlane = eyeOf(find("foam/eye_on_radical_plane").views[0]);
  uint32_t equals = 0;
  for (uint32_t i = 0; i < foam_.cellCount; ++i) {
    equals += std::abs(power(foam_, i, onPlane) - power(foam_, cell, onPlane)) < 1e-12;
  }
  EXPECT_GE(equals, 2u);
}

}  // namespace
}  // namespace froth
