#include <bit>
#include <cmath>

#include "tests/checkpoint/import_checks.h"

namespace froth {
namespace {

TEST(ImportCheckpoint, ReadsEveryTensorIntoItsPlace) {
  const Result<Foam> foam = importSpec(sampleCheckpoint());
  ASSERT_TRUE(foam) << foam.error().message;
  EXPECT_EQ(foam->cellCount, 2u);
  EXPECT_EQ(foam->detailCount, 3u);
  EXPECT_EQ(foam->lobeCount, 2u);
  const float step = 1.0f / 64;
  EXPECT_EQ(foam->sites[1], glm::vec3(-1 + 3 * step, -1 + 4 * step, -1 + 5 * step));
  EXPECT_EQ(foam->radii[1], 0.25f + step);
  EXPECT_EQ(foam->densities[1], 0.5f + step);
  EXPECT_EQ(foam->detailSites[5], glm::vec2(-0.5f + 10 * step, -0.5f + 11 * step));
  EXPECT_EQ(foam->detailHeights[5], -0.125f + 5 * step);
  EXPECT_EQ(foam->lobeAxes[11], glm::vec3(1 + 33 * step, 1 + 34 * step, 1 + 35 * step));
  EXPECT_EQ(foam->lobeColours[11], glm::vec3(-1 + 33 * step, -1 + 34 * step, -1 + 35 * step));
}

TEST(ImportCheckpoint, NormalisesQuaternionsAndActivatesRadiiAndDensities) {
  CheckpointSpec checkpoint = sampleCheckpoint();
  checkpoint.setFloats("quaternions", {2, 4}, {0, 3, 0, -4, 0, 0, 2, 0});
  checkpoint.setFloats("radii", {2}, {0, 0.2001f});
  checkpoint.setFloats("density", {2}, {-0.05f, -5});
  const Result<Foam> foam = importSpec(checkpoint);
  ASSERT_TRUE(foam) << foam.error().message;
  EXPECT_EQ(foam->orientations[0], glm::vec4(0, 0.6f, 0, -0.8f));
  EXPECT_EQ(foam->orientations[1], glm::vec4(0, 0, 1, 0));
  EXPECT_EQ(foam->radii[0], static_cast<float>(std::log(2.0) / 100));
  EXPECT_EQ(foam->radii[1], 0.2001f);
  EXPECT_EQ(foam->densities[0], static_cast<float>(std::log1p(std::exp(100 * double{-0.05f})) / 100));
  EXPECT_EQ(foam->densities[1], 0.0f);
}

TEST(ImportCheckpoint, ReadsLobesOfThreeAndOfFourDimensionsAlike) {
  CheckpointSpec checkpoint = sampleCheckpoint(2, 3, 2);
  const Result<Foam> flat = importSpec(checkpoint);
  for (const char* key : {"texel_sv_axis", "texel_sv_rgb"}) {
    checkpoint.tensor(key).shape = {2, 3, 2, 3};
    checkpoint.tensor(key).strides = {18, 6, 3, 1};
  }
  const Result<Foam> nested = importSpec(checkpoint);
  ASSERT_TRUE(flat && nested) << nested.error().message;
  expectSameFoam(*flat, *nested);
}

TEST(ImportCheckpoint, FollowsStridesOfATransposedTensor) {
  CheckpointSpec checkpoint = sampleCheckpoint();
  checkpoint.setFloats("points", {2, 3}, {1, 4, 2, 5, 3, 6});
  checkpoint.tensor("points").strides = {1, 2};
  const Result<Foam> foam = importSpec(checkpoint);
  ASSERT_TRUE(foam) << foam.error().message;
  EXPECT_EQ(foam->sites[0], glm::vec3(1, 2, 3));
  EXPECT_EQ(foam->sites[1], glm::vec3(4, 5, 6));
}

TEST(ImportCheckpoint, ReadsTwoTensorsFromOneStorageByTheirOffsets) {
  CheckpointSpec checkpoint = sampleCheckpoint();
  checkpoint.storages["radii"] = packNumbers<float>({9, 1, 2, 3, 4});
  checkpoint.tensor("radii") = {"radii", 5, {2}, {1}, 1};
  checkpoint.tensor("density") = {"radii", 5, {2}, {1}, 3};
  const Result<Foam> foam = importSpec(checkpoint);
  ASSERT_TRUE(foam) << foam.error().message;
  EXPECT_EQ(foam->radii, (std::vector<float>{1, 2}));
  EXPECT_EQ(foam->densities, (std::vector<float>{3, 4}));
}

TEST(ImportCheckpoint, ReadsExpandedTensorsWhoseStridesAreZero) {
  CheckpointSpec checkpoint = sampleCheckpoint();
  checkpoint.setFloats("texel_height", {2, 3}, {0.5f});
  checkpoint.tensor("texel_height").strides = {0, 0};
  const Result<Foam> foam = importSpec(checkpoint);
  ASSERT_TRUE(foam) << foam.error().message;
  EXPECT_EQ(foam->detailHeights, std::vector<float>(6, 0.5f));
}

// Bit patterns of 1, -2, 0.5 and of small numbers: the smallest that are normal as float32, and a subnormal half, which
// is.
TEST(ImportCheckpoint, ReadsHalfBFloat16AndDouble) {
  struct Case {
    const char* storageClass;
    std::string bytes;
    std::vector<float> values;
  };
  const Case cases[] = {
      {"HalfStorage",
       packNumbers<uint16_t>({0x3c00, 0xc000, 0x3800, 0x0400, 0x8001, 0x0000}),
       {1, -2, 0.5f, 0x1p-14f, -0x1p-24f, 0}},
      {"BFloat16Storage",
       packNumbers<uint16_t>({0x3f80, 0xc000, 0x3f00, 0x0080, 0x8081, 0x0000}),
       {1, -2, 0.5f, 0x1p-126f, -0x1.02p-126f, 0}},
      {"DoubleStorage",
       packNumbers<double>({1, -2, 0.5, 0x1p-126, -0x1.02p-126, 1e-60}),
       {1, -2, 0.5f, 0x1p-126f, -0x1.02p-126f, 0}},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.storageClass);
    CheckpointSpec checkpoint = sampleCheckpoint();
    checkpoint.tensor("texel_height").storageClass = c.storageClass;
    checkpoint.storages["texel_height"] = c.bytes;
    const Result<Foam> foam = importSpec(checkpoint);
    ASSERT_TRUE(foam) << foam.error().message;
    EXPECT_EQ(foam->detailHeights, c.values);
  }
}

TEST(ImportCheckpoint, RefusesNumbersThatAreDenormalAsFloat32) {
  CheckpointSpec checkpoint = sampleCheckpoint();
  checkpoint.tensor("texel_height").storageClass = "DoubleStorage";
  checkpoint.storages["texel_height"] = packNumbers<double>({1, 2, 3, 4, 1e-42, 6});
  const Result<Foam> foam = importSpec(checkpoint);
  ASSERT_FALSE(foam);
  EXPECT_NE(foam.error().message.find("tensor 'texel_height': cell 1 of 2 holds"), std::string::npos)
      << foam.error().message;
}

TEST(ImportCheckpoint, IgnoresOtherKeysAndLeavesTheirTensorsUnread) {
  CheckpointSpec checkpoint = sampleCheckpoint();
  checkpoint.tensor("adjacency") = {"storage that is not there", 7, {7}, {1}, 0, "IntStorage"};
  const Result<Foam> foam = importSpec(checkpoint);
  EXPECT_TRUE(foam) << foam.error().message;
}

TEST(ImportCheckpoint, FindsThePickleUnderAnyFolder) {
  for (const char* prefix : {"", "archive/", "a/b/"}) {
    CheckpointSpec checkpoint = sampleCheckpoint();
    checkpoint.prefix = prefix;
    const Result<Foam> foam = importSpec(checkpoint);
    EXPECT_TRUE(foam) << prefix << ": " << foam.error().message;
  }
}

TEST(ImportCheckpoint, ReadsZip64Archives) {
  const Result<Foam> foam = importBytes(buildZip(zipEntries(sampleCheckpoint()), /*isZip64=*/true));
  EXPECT_TRUE(foam) << foam.error().message;
}

TEST(ImportCheckpoint, ReadsArchivesWithACommentBehind) {
  std::string bytes = buildCheckpoint(sampleCheckpoint());
  bytes.replace(bytes.size() - 2, 2, packNumber(uint16_t{4}) + "note");
  const Result<Foam> foam = importBytes(bytes);
  EXPECT_TRUE(foam) << foam.error().message;
}

// The same dict as protocol 4 spells it: frames, short strings, numbered memo, globals from the stack; and an
// ordered dict.
TEST(ImportCheckpoint, ReadsPicklesOfProtocolFour) {
  const auto shortText = [](const std::string& text) {
    return "\x8c" + std::string(1, static_cast<char>(text.size())) + text;
  };
  const auto stackGlobal = [&](const char* module, const char* name) {
    return shortText(module) + "\x94" + shortText(name) + "\x94" + "\x93";
  };
  CheckpointSpec checkpoint = sampleCheckpoint(1);
  std::string opcodes = stackGlobal("collections", "OrderedDict") + ")R(";
  for (const auto& [key, tensor] : checkpoint.tensors) {
    const std::string id = "(" + shortText("storage") + stackGlobal("torch", "FloatStorage") +
                           shortText(tensor.storage) + shortText("cpu") + pickleInteger(tensor.storageCount) + "t\x94Q";
    opcodes += shortText(key) + stackGlobal("torch._utils", "_rebuild_tensor_v2") + "(" + id + pickleInteger(0) +
               pickleIntegers(tensor.shape) + pickleIntegers(tensor.strides) + "\x89" +
               stackGlobal("collections", "OrderedDict") + ")RtR";
  }
  opcodes += "u.";
  checkpoint.pickle = "\x80\x04\x95" + packNumber(uint64_t{opcodes.size()}) + opcodes;
  const Result<Foam> foam = importSpec(checkpoint);
  EXPECT_TRUE(foam) << foam.error().message;
}

TEST(ImportCheckpoint, StopsWhenProgressSaysSo) {
  const std::string bytes = buildCheckpoint(sampleCheckpoint());
  uint64_t lastDone = 0, lastTotal = 0;
  const auto watch = [&](std::string_view, uint64_t done, uint64_t total) {
    lastDone = done;
    lastTotal = total;
    return true;
  };
  const std::span data(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
  EXPECT_TRUE(importCheckpointBytes(data, "model.pt", watch));
  EXPECT_EQ(lastDone, lastTotal);
  const Result<Foam> stopped = importCheckpointBytes(data, "model.pt", [](auto, auto, auto) { return false; });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().kind, ErrorKind::kCancelled);
}

TEST(ImportCheckpoint, ReadsALargeTensorInSlicesAndStopsBetweenThem) {
  // 3,072,000 numbers of lobe axes, as many of colours.
  const std::string bytes = buildCheckpoint(sampleCheckpoint(16000, 2, 32));
  const std::span data(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
  size_t slices = 0;
  const Result<Foam> foam = importCheckpointBytes(data, "model.pt", [&](std::string_view stage, auto, auto) {
    slices += stage == "import";
    return true;
  });
  ASSERT_TRUE(foam) << foam.error().message;
  EXPECT_EQ(slices, 10u);
  ASSERT_EQ(foam->lobeAxes.size(), 1024000u);
  for (size_t i = 0; i < foam->lobeAxes.size(); ++i) {
    const glm::vec3 place(3 * i, 3 * i + 1, 3 * i + 2);
    ASSERT_EQ(foam->lobeAxes[i], 1.0f + place / 64.0f) << i;
    ASSERT_EQ(foam->lobeColours[i], -1.0f + place / 64.0f) << i;
  }

  for (const std::string_view stopped : {"checksums", "import"}) {
    int reports = 0;
    const auto stopAtTheNinth = [&](std::string_view stage, auto, auto) {
      EXPECT_LT(reports, 9);
      reports += stage == stopped;
      return reports < 9;
    };
    const Result<Foam> result = importCheckpointBytes(data, "model.pt", stopAtTheNinth);
    ASSERT_FALSE(result) << stopped;
    EXPECT_EQ(result.error().kind, ErrorKind::kCancelled);
  }
}

TEST(ImportCheckpoint, RefusesWhatIsNoRegularFile) {
  const std::string folder = testing::TempDir();
  for (const auto& [path, part] : {std::pair<std::string, std::string>{folder, "directory"},
                                   {folder + "/no such file.pt", "No such file"},
                                   {"/dev/null", "device"}}) {
    const Result<Foam> foam = importCheckpoint(path);
    ASSERT_FALSE(foam);
    EXPECT_EQ(foam.error().kind, ErrorKind::kBadInput);
    EXPECT_THAT(foam.error().message, testing::AllOf(testing::HasSubstr(path), testing::HasSubstr(part)));
  }
}

}  // namespace
}  // namespace froth
