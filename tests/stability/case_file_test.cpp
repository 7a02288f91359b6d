// Stiff cases as files.
#include "measure/stability/case_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/atomic_file.h"
#include "measure/stability/cases/random_case.h"

namespace froth {
namespace {

class CaseFile : public testing::Test {
 protected:
  CaseFile()
      : path_(std::filesystem::temp_directory_path() /
              (std::string("froth_case_") + testing::UnitTest::GetInstance()->current_test_info()->name() + ".json")) {}
  ~CaseFile() override { std::filesystem::remove(path_); }

  StiffCase writeAndRead(const StiffCase& stiffCase) {
    const Status written = writeCase(path_, stiffCase);
    EXPECT_TRUE(written) << written.error().message;
    Result<StiffCase> read = readCase(path_);
    if (read) return std::move(*read);
    ADD_FAILURE() << read.error().message;
    return {};
  }

  std::string text() const {
    std::ostringstream text;
    text << std::ifstream(path_).rdbuf();
    return text.str();
  }

  // The message with which a file is refused in which `from` stands as `to`.
  std::string refusalOf(std::string_view from, std::string_view to) {
    std::string changed = text();
    const size_t place = changed.find(from);
    EXPECT_NE(place, std::string::npos) << from;
    changed.replace(place, from.size(), to);
    const Result<StiffCase> read = parseCase({reinterpret_cast<const uint8_t*>(changed.data()), changed.size()}, "case.json");
    if (!read) return read.error().message;
    return "none";
  }

  const std::filesystem::path path_;
};

void expectSameFoam(const Foam& a, const Foam& b) {
  EXPECT_EQ(a.cellCount, b.cellCount);
  EXPECT_EQ(a.detailCount, b.detailCount);
  EXPECT_EQ(a.lobeCount, b.lobeCount);
  EXPECT_EQ(a.sites, b.sites);
  EXPECT_EQ(a.radii, b.radii);
  EXPECT_EQ(a.densities, b.densities);
  EXPECT_EQ(a.orientations, b.orientations);
  EXPECT_EQ(a.detailSites, b.detailSites);
  EXPECT_EQ(a.detailHeights, b.detailHeights);
  EXPECT_EQ(a.lobeAxes, b.lobeAxes);
  EXPECT_EQ(a.lobeColours, b.lobeColours);
  EXPECT_EQ(a.baseColours, b.baseColours);
  EXPECT_EQ(a.lobeOffsets, b.lobeOffsets);
}

TEST_F(CaseFile, EveryNumberComesBackWithTheSameBits) {
  for (uint64_t seed = 0; seed < 60; ++seed) {
    StiffCase drawn = drawCase(seed);
    drawn.moved = {1e6 + 0.1, -1e9, 1.0 / 3};
    drawn.isImported = seed % 2 == 0;
    drawn.known = {{"exact", "raster", "over its bound", 1.0 / 3, "a \"cause\""}};
    const StiffCase read = writeAndRead(drawn);
    EXPECT_EQ(read.name, drawn.name);
    EXPECT_EQ(read.moved, drawn.moved);
    EXPECT_EQ(read.isImported, drawn.isImported);
    ASSERT_EQ(read.known.size(), 1u);
    EXPECT_EQ(read.known[0].preset, "exact");
    EXPECT_EQ(read.known[0].renderer, "raster");
    EXPECT_EQ(read.known[0].kind, "over its bound");
    EXPECT_EQ(read.known[0].factor, 1.0 / 3);
    EXPECT_EQ(read.known[0].cause, "a \"cause\"");
    expectSameFoam(read.foam, drawn.foam);
    ASSERT_EQ(read.views.size(), drawn.views.size());
    for (size_t i = 0; i < read.views.size(); ++i) {
      EXPECT_EQ(read.views[i].worldFromCamera, drawn.views[i].worldFromCamera);
      EXPECT_EQ(read.views[i].fx, drawn.views[i].fx);
      EXPECT_EQ(read.views[i].nearRatio, drawn.views[i].nearRatio);
      EXPECT_EQ(read.views[i].lens.kind, drawn.views[i].lens.kind);
    }
  }
}

TEST_F(CaseFile, LimitsOfFloatComeBack) {
  StiffCase drawn = drawCase(1);
  drawn.foam.sites[0] = {-0.0f, std::numeric_limits<float>::denorm_min(), -0x1p50f};
  drawn.foam.radii[0] = std::numeric_limits<float>::min();
  const StiffCase read = writeAndRead(drawn);
  expectSameFoam(read.foam, drawn.foam);
  ASSERT_FALSE(read.foam.sites.empty());
  EXPECT_TRUE(std::signbit(read.foam.sites[0].x));
}

TEST_F(CaseFile, ACompressedFoamComesBack) {
  StiffCase drawn = drawCase(1);
  Foam& foam = drawn.foam;
  foam.lobeCount = 2;
  foam.lobeAxes.clear();
  foam.lobeColours.clear();
  foam.lobeOffsets = {0};
  for (uint32_t site = 0; site < foam.cellCount * foam.detailCount; ++site) {
    foam.baseColours.push_back({0.1f, 0.2f, 0.3f * static_cast<float>(site)});
    for (uint32_t lobe = 0; lobe < site % 3; ++lobe) {
      foam.lobeAxes.push_back({1, 2, 3});
      foam.lobeColours.push_back({0.3f, 0.2f, 0.1f});
    }
    foam.lobeOffsets.push_back(foam.lobeAxes.size());
  }
  expectSameFoam(writeAndRead(drawn).foam, foam);
}

TEST_F(CaseFile, AFaultIsNamedWithItsPlace) {
  StiffCase drawn = drawCase(1);
  drawn.foam.radii[0] = 0.625f;
  drawn.foam.densities[0] = 1.75f;
  ASSERT_TRUE(writeCase(path_, drawn));
  using testing::HasSubstr;
  EXPECT_THAT(refusalOf("\"radius\": 0.625", "\"radius\": \"0.625\""), HasSubstr("case.json: cell 0, field 'radius'"));
  EXPECT_THAT(refusalOf("\"radius\": 0.625", "\"radius\": 1e39"), HasSubstr("cell 0, field 'radius'"));
  EXPECT_THAT(refusalOf("\"radius\": 0.625", "\"radius\": -1"), HasSubstr("cell 0: radius -1"));
  EXPECT_THAT(refusalOf("\"density\": 1.75,", ""), HasSubstr("cell 0, field 'density': found nothing"));
  EXPECT_THAT(refusalOf("\"density\": 1.75,", "\"density\": 1e999,"), HasSubstr("case.json"));
  EXPECT_THAT(refusalOf("\"site\": [", "\"site\": [1,"), HasSubstr("field 'site': give 3 numbers"));
  EXPECT_THAT(refusalOf("\"place\":[", "\"place\":[1,"), HasSubstr("cell 0, detail site 0, field 'place'"));
  EXPECT_THAT(refusalOf("\"lobes\":[[", "\"lobes\":[[1,"), HasSubstr("detail site 0, field 'lobes'"));
  EXPECT_THAT(refusalOf("\"most_lobes\": ", "\"most_lobes\": -"), HasSubstr("field 'most_lobes'"));
  EXPECT_THAT(refusalOf("\"moved\": [", "\"moved\": [[],"), HasSubstr("field 'moved'"));
  EXPECT_THAT(refusalOf("\"cells\": [", "\"cells\": [3,"), HasSubstr("cell 0"));
  EXPECT_THAT(refusalOf("\"width\"", "\"wide\""), HasSubstr("view 0"));
  EXPECT_THAT(refusalOf("\"name\"", "\"nom\""), HasSubstr("field 'name': found nothing"));
}

TEST_F(CaseFile, ACutFileIsRefused) {
  ASSERT_TRUE(writeCase(path_, drawCase(2)));
  const std::string whole = text();
  for (size_t length = 0; length + 2 < whole.size(); length += 1 + whole.size() / 97) {
    EXPECT_FALSE(parseCase({reinterpret_cast<const uint8_t*>(whole.data()), length}, "cut.json")) << length;
  }
}

TEST_F(CaseFile, ACaseThatCouldNotBeReadIsNotWritten) {
  StiffCase drawn = drawCase(3);
  drawn.foam.lobeColours[0].x = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(writeCase(path_, drawn));
  EXPECT_FALSE(std::filesystem::exists(path_));
}

}  // namespace
}  // namespace froth
