// Stiff cases as files.
#include "measure/stability/case_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>

#include "base/atomic_file.h"
#include "measure/stability/cases/case_parts.h"
#include "measure/stability/cases/random_case.h"
#include "tests/surroundings.h"

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
    const Result<StiffCase> read =
        parseCase({reinterpret_cast<const uint8_t*>(changed.data()), changed.size()}, "case.json");
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

constexpr float kNever = std::numeric_limits<float>::infinity();

// Two views, and everything that is neither foam nor view.
StiffCase withAllParts() {
  StiffCase stiff{"parts/all",
                  "",
                  "",
                  foamOfCells(cloud(3, 5)),
                  {caseView({0, 0, -3}, {0, 0, 0}, 3, 2), caseView({0, 0, 3}, {0, 0, 0}, 1, 4)}};
  stiff.places = {{}, {{1.0 / 3, -1e9, 0.1}, glm::normalize(glm::quat(0.9f, 0.1f, 0.35f, -0.1f)), 1.0f / 3}};
  stiff.ends = {{3, 2, 1, {kNever, -0.0f, 0.1f, 1.0f / 3, -2.5f, std::numeric_limits<float>::denorm_min()}},
                {1, 4, 1, {0, kNever, 1e30f, 2}}};
  stiff.jitter = {0.3f, -0.0f};
  stiff.layers = 2;
  stiff.chunkCells = 7;
  return stiff;
}

bool hasSameBits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

void expectSameParts(const StiffCase& a, const StiffCase& b) {
  EXPECT_EQ(a.places, b.places);
  ASSERT_EQ(a.ends.size(), b.ends.size());
  for (size_t i = 0; i < a.ends.size(); ++i) {
    EXPECT_EQ(a.ends[i].width, b.ends[i].width);
    EXPECT_EQ(a.ends[i].height, b.ends[i].height);
    EXPECT_EQ(a.ends[i].channels, b.ends[i].channels);
    EXPECT_TRUE(hasSameBits(a.ends[i].values, b.ends[i].values)) << i;
  }
  EXPECT_TRUE(hasSameBits({a.jitter.x, a.jitter.y}, {b.jitter.x, b.jitter.y}));
  EXPECT_EQ(a.layers, b.layers);
  EXPECT_EQ(a.chunkCells, b.chunkCells);
}

TEST_F(CaseFile, EveryNumberComesBackWithTheSameBits) {
  for (uint64_t seed = 0; seed < 100; ++seed) {
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
    expectSameParts(read, drawn);
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

TEST_F(CaseFile, InstancesEndsJitterLayersAndChunksComeBackWithTheSameBits) {
  const StiffCase stiff = withAllParts();
  expectSameParts(writeAndRead(stiff), stiff);
}

TEST_F(CaseFile, EveryBuiltInCaseWithSuchPartsComesBack) {
  uint32_t count = 0;
  for (const auto& family : {instanceCases(), depthCases(), layerCases(), viewCases()}) {
    for (const StiffCase& stiff : family) {
      expectSameParts(writeAndRead(stiff), stiff);
      ++count;
    }
  }
  EXPECT_GE(count, 20u);
}

TEST_F(CaseFile, WhatAFileLacksIsAsInMostCases) {
  const std::filesystem::path old = test::sourceFolder() / "tests/stability/found/face_edge_on.json";
  const Result<StiffCase> read = readCase(old);  // written before there were such parts
  ASSERT_TRUE(read) << read.error().message;
  expectSameParts(*read, StiffCase());
  EXPECT_EQ(read->views.size(), 1u);
}

TEST_F(CaseFile, AFaultOfAPartIsNamedWithItsField) {
  ASSERT_TRUE(writeCase(path_, withAllParts()));
  using testing::HasSubstr;
  EXPECT_THAT(refusalOf("\"position\": [", "\"position\": [1,"),
              HasSubstr("case.json: place 0, field 'position': give 3 numbers"));
  EXPECT_THAT(refusalOf("\"position\": [0.0", "\"position\": [null"),
              HasSubstr("place 0, field 'position': give finite numbers"));
  EXPECT_THAT(refusalOf("\"rotation\": [1.0", "\"rotation\": [1.01"),
              HasSubstr("place 0, field 'rotation': a quaternion of squared length"));
  EXPECT_THAT(refusalOf("\"rotation\": [1.0", "\"rotation\": [0"), HasSubstr("place 0, field 'rotation'"));
  EXPECT_THAT(refusalOf("\"scale\": 1.0", "\"scale\": 0"), HasSubstr("place 0, field 'scale'"));
  EXPECT_THAT(refusalOf("\"scale\": 1.0", "\"scale\": -1"), HasSubstr("place 0, field 'scale'"));
  EXPECT_THAT(refusalOf("\"scale\": 1.0", "\"scale\": 1e-60"), HasSubstr("place 0, field 'scale'"));
  EXPECT_THAT(refusalOf("\"scale\": 1.0", "\"size\": 1.0"), HasSubstr("place 0, field 'scale': found nothing"));
  EXPECT_THAT(refusalOf("\"places\": [", "\"places\": [1, 1, 1,"),
              HasSubstr("field 'places': found 5; give at most 4"));
  EXPECT_THAT(refusalOf("\"places\": [", "\"places\": [1,"), HasSubstr("place 0"));
  EXPECT_THAT(refusalOf("\"jitter\": [", "\"jitter\": [1,"), HasSubstr("field 'jitter': give 2 numbers"));
  EXPECT_THAT(refusalOf("\"jitter\": [0.3", "\"jitter\": [1e39"), HasSubstr("field 'jitter': give finite numbers"));
  for (const char* layers : {"0", "4", "1.5", "-1", "\"2\""}) {
    EXPECT_THAT(refusalOf("\"layers\": 2", std::string("\"layers\": ") + layers),
                HasSubstr("case.json, field 'layers'"))
        << layers;
  }
  for (const char* cells : {"1048577", "0.5", "-1", "[]"}) {
    EXPECT_THAT(refusalOf("\"chunk_cells\": 7", std::string("\"chunk_cells\": ") + cells),
                HasSubstr("field 'chunk_cells'"))
        << cells;
  }
}

TEST_F(CaseFile, AFaultOfEndsIsNamedWithItsViewAndRow) {
  ASSERT_TRUE(writeCase(path_, withAllParts()));
  using testing::HasSubstr;
  EXPECT_THAT(refusalOf("\"ends\": [", "\"ends\": [[],"),
              HasSubstr("case.json, field 'ends': found 3 images; give one for each of the 2 views"));
  EXPECT_THAT(refusalOf("[\"never\",-0.0", "[[],-0.0"),
              HasSubstr("field 'ends': view 0, row 0: give finite numbers, or \"never\""));
  EXPECT_THAT(refusalOf("[\"never\",-0.0", "[\"nowhere\",-0.0"), HasSubstr("view 0, row 0: give finite"));
  EXPECT_THAT(refusalOf("[\"never\",-0.0", "[1e39,-0.0"), HasSubstr("view 0, row 0: give finite"));
  EXPECT_THAT(refusalOf("[\"never\",-0.0", "[null,-0.0"), HasSubstr("view 0, row 0: give finite"));
  EXPECT_THAT(refusalOf("[\"never\",-0.0", "[-0.0"), HasSubstr("view 0, row 0: give 3 numbers"));
  EXPECT_THAT(refusalOf("[\"never\",-0.0", "3,[\"never\",-0.0"), HasSubstr("view 0: give 2 rows"));
  EXPECT_THAT(refusalOf("[2.0]", "2.0"), HasSubstr("view 1, row 3: give 1 numbers"));
}

// The images that a view's size does not tell of, and numbers that JSON does not know.
TEST_F(CaseFile, PartsThatCouldNotBeReadAreNotWritten) {
  const auto refusalOfChange = [&](const std::function<void(StiffCase&)>& change) {
    StiffCase stiff = withAllParts();
    change(stiff);
    const Status written = writeCase(path_, stiff);
    EXPECT_FALSE(std::filesystem::exists(path_));
    return written ? std::string("none") : written.error().message;
  };
  using testing::HasSubstr;
  EXPECT_THAT(refusalOfChange([](StiffCase& stiff) { stiff.ends.pop_back(); }),
              HasSubstr("field 'ends': found 1 images"));
  EXPECT_THAT(refusalOfChange([](StiffCase& stiff) { std::swap(stiff.ends[0].width, stiff.ends[0].height); }),
              HasSubstr("'ends': view 0"));
  EXPECT_THAT(refusalOfChange([](StiffCase& stiff) {
                stiff.ends[1] = {1, 4, 3, std::vector<float>(12)};
              }),
              HasSubstr("'ends': view 1"));
  EXPECT_THAT(refusalOfChange([](StiffCase& stiff) { stiff.ends[1].values.pop_back(); }), HasSubstr("'ends': view 1"));
  EXPECT_THAT(refusalOfChange([](StiffCase& stiff) { stiff.ends[0].values[4] = NAN; }),
              HasSubstr("'ends': view 0, row 1: give finite"));
  EXPECT_THAT(refusalOfChange([](StiffCase& stiff) { stiff.ends[0].values[0] = -kNever; }),
              HasSubstr("'ends': view 0, row 0: give finite"));
  EXPECT_THAT(refusalOfChange([](StiffCase& stiff) { stiff.places.resize(5); }), HasSubstr("'places'"));
  EXPECT_THAT(refusalOfChange([](StiffCase& stiff) { stiff.places[1].position.y = NAN; }),
              HasSubstr("place 1, field 'position'"));
  EXPECT_THAT(refusalOfChange([](StiffCase& stiff) {
                stiff.places[1].rotation = {0, 0, 0, 0};
              }),
              HasSubstr("place 1, field 'rotation'"));
  EXPECT_THAT(refusalOfChange([](StiffCase& stiff) { stiff.places[1].scale = 0; }),
              HasSubstr("place 1, field 'scale'"));
  EXPECT_THAT(refusalOfChange([](StiffCase& stiff) { stiff.places[1].scale = kNever; }),
              HasSubstr("place 1, field 'scale'"));
  EXPECT_THAT(refusalOfChange([](StiffCase& stiff) { stiff.jitter.y = NAN; }), HasSubstr("'jitter'"));
  EXPECT_THAT(refusalOfChange([](StiffCase& stiff) { stiff.layers = 4; }), HasSubstr("'layers'"));
  EXPECT_THAT(refusalOfChange([](StiffCase& stiff) { stiff.chunkCells = 1048577; }), HasSubstr("'chunk_cells'"));
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
