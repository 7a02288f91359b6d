// What the program says to bad files: exit code 3, a message that names file, place, found value and remedy,
// and no output, whole or partial.
#include <cstdlib>
#include <functional>
#include <limits>

#include <gmock/gmock.h>

#include "format/read/asset_reader.h"
#include "format/write/asset_writer.h"
#include "tests/checkpoint/checkpoint_builder.h"
#include "tests/surroundings.h"
#include "tests/tool/program_runner.h"

namespace froth::test {
namespace {

using testing::HasSubstr;

class BadInput : public ToolTest {
 protected:
  // `command` fails with a message that names `file` and each of `parts`, and changes nothing in the folder.
  void expectRefusal(const std::vector<std::string>& command, const std::string& file,
                     const std::vector<std::string>& parts) const {
    const std::vector<std::string> before = filesInFolder();
    const ProgramRun run = froth(command);
    EXPECT_EQ(run.exitCode, 3) << run.err;
    EXPECT_THAT(run.err, HasSubstr("froth: "));
    EXPECT_THAT(run.err, HasSubstr(file));
    for (const std::string& part : parts) EXPECT_THAT(run.err, HasSubstr(part));
    EXPECT_EQ(filesInFolder(), before) << "something was left behind";
  }

  // The same of a bake.
  void expectBakeRefused(const std::string& input, const std::vector<std::string>& parts) const {
    expectRefusal({"bake", input, "-o", "out.froth"}, input, parts);
  }

  // random.froth, changed and signed again, as bad.froth.
  void changeAsset(const std::function<void(AssetContents&)>& change) const {
    makeRandomFoam("60");
    Result<AssetContents> contents = readAsset(folder_ / "random.froth");
    ASSERT_TRUE(contents) << contents.error().message;
    change(*contents);
    const Status written = writeAsset(folder_ / "bad.froth", *contents);
    ASSERT_TRUE(written) << written.error().message;
  }

  void writeCheckpoint(const CheckpointSpec& checkpoint) const {
    writeBytes(folder_ / "bad.pt", buildCheckpoint(checkpoint));
  }
};

TEST_F(BadInput, AMissingFile) {
  expectBakeRefused("none.pt", {});
  expectRefusal({"info", "none.froth"}, "none.froth", {});
  expectRefusal({"verify", "none.froth"}, "none.froth", {});
}

TEST_F(BadInput, AnEmptyFile) {
  writeBytes(folder_ / "bad.pt", "");
  writeBytes(folder_ / "bad.froth", "");
  expectBakeRefused("bad.pt", {});
  expectRefusal({"info", "bad.froth"}, "bad.froth", {});
  expectRefusal({"verify", "bad.froth"}, "bad.froth", {});
}

TEST_F(BadInput, ADirectory) {
  std::filesystem::create_directory(folder_ / "bad.pt");
  std::filesystem::create_directory(folder_ / "bad.froth");
  expectBakeRefused("bad.pt", {"directory"});
  expectRefusal({"info", "bad.froth"}, "bad.froth", {"directory"});
}

TEST_F(BadInput, ATruncatedCheckpoint) {
  const std::string whole = buildCheckpoint(sampleCheckpoint());
  for (const size_t length : {size_t{1}, size_t{100}, whole.size() / 2, whole.size() - 1}) {
    writeBytes(folder_ / "bad.pt", whole.substr(0, length));
    expectBakeRefused("bad.pt", {});
  }
}

TEST_F(BadInput, ABitFlipInEveryPartOfAnAsset) {
  makeRandomFoam("60");
  const std::string whole = readBytes(folder_ / "random.froth");
  for (size_t part = 0; part < 12; ++part) {
    std::string flipped = whole;
    flipped[part * (whole.size() - 1) / 11] ^= 0x10;
    writeBytes(folder_ / "bad.froth", flipped);
    expectRefusal({"verify", "bad.froth"}, "bad.froth", {});
  }
}

TEST_F(BadInput, ATruncatedAsset) {
  makeRandomFoam("60");
  const std::string whole = readBytes(folder_ / "random.froth");
  for (const size_t length : {size_t{3}, size_t{64}, whole.size() / 2, whole.size() - 1}) {
    writeBytes(folder_ / "bad.froth", whole.substr(0, length));
    expectRefusal({"verify", "bad.froth"}, "bad.froth", {});
    expectRefusal({"synth", "tile", "--of", "bad.froth", "--count", "2", "-o", "out.froth"}, "bad.froth", {});
  }
}

TEST_F(BadInput, AnAssetOfAnotherVersionHasTheSameExitCodeEverywhere) {
  makeRandomFoam("12");
  writeBytes(folder_ / "bad.froth", readBytes(sourceFolder() / "tests/format/golden/version_1_0.froth"));
  expectRefusal({"verify", "bad.froth"}, "bad.froth", {"format version 1.0"});
  expectRefusal({"info", "bad.froth"}, "bad.froth", {"format version 1.0"});
  expectRefusal({"render", "bad.froth", "--cameras", "cameras.json", "--renderer", "reference", "-o", "out"},
                "bad.froth", {"format version 1.0"});
  if (!hasDevice()) GTEST_SKIP() << "no suitable Vulkan device";
  expectRefusal({"render", "bad.froth", "--cameras", "cameras.json", "--renderer", "raster", "-o", "out"}, "bad.froth",
                {"format version 1.0"});
}

TEST_F(BadInput, AnAssetWithoutSolidBallsWhereThereIsSomethingSolid) {
  changeAsset([](AssetContents& contents) {
    for (ChunkContents& chunk : contents.chunks) {
      for (uint32_t& ball : chunk.solidBalls) ball &= 0xffffff;
    }
  });
  expectRefusal({"verify", "bad.froth"}, "bad.froth", {"chunk 0: the solid ball of cell "});
}

TEST_F(BadInput, AnAssetWithoutAGraph) {
  changeAsset([](AssetContents& contents) {
    for (ChunkContents& chunk : contents.chunks) {
      chunk.neighbours.clear();
      chunk.neighbourOffsets.assign(chunk.cellCount + 1, 0);
      chunk.alphaCounts.assign(chunk.liveCount, 0);
    }
  });
  expectRefusal({"verify", "bad.froth"}, "bad.froth", {"graphs: "});
}

TEST_F(BadInput, TextOfAnAssetThatWouldSteerATerminal) {
  changeAsset([](AssetContents& contents) {
    contents.preset = "\x1b[2Jclean\r";
    contents.source = "\a";
    contents.errors.push_back({"\x1b]0;title", "\n", 1, 2});
  });
  const std::string shown = frothWell({"info", "bad.froth"});
  EXPECT_THAT(shown, HasSubstr("\\x1b[2Jclean\\x0d, from \\x07\n"));
  EXPECT_EQ(shown.find_first_of("\x1b\r\a"), std::string::npos) << shown;
  writeBytes(folder_ / "cameras.json", R"({"views": [{"\u001b[2J": 1}]})");
  const ProgramRun run =
      froth({"render", "random.froth", "--cameras", "cameras.json", "--renderer", "reference", "-o", "out"});
  EXPECT_EQ(run.exitCode, 3);
  EXPECT_EQ(run.err.find('\x1b'), std::string::npos) << run.err;
}

TEST_F(BadInput, AKeyThatComesTwiceInJson) {
  makeRandomFoam("12");
  writeBytes(folder_ / "cameras.json", R"({"views": [], "scene": "a", "scene": "b"})");
  expectRefusal({"render", "random.froth", "--cameras", "cameras.json", "--renderer", "reference", "-o", "out"},
                "cameras.json", {"key 'scene' stands twice"});
  writeBytes(folder_ / "a.json", R"({"frames": {"a": 1, "a": 2}})");
  expectRefusal({"compare-bench", "a.json", "a.json"}, "a.json", {"key 'a' stands twice"});
}

TEST_F(BadInput, ABitFlipInACheckpointsData) {
  std::string flipped = buildCheckpoint(sampleCheckpoint());
  // A mantissa byte of a stored number: only the archive's checksum can tell.
  const size_t name = flipped.find("model/data/points");
  ASSERT_NE(name, std::string::npos);
  flipped[name + std::string("model/data/points").size() + 5] ^= 0x01;
  writeBytes(folder_ / "bad.pt", flipped);
  expectBakeRefused("bad.pt", {"points"});
}

TEST_F(BadInput, APickleThatCallsTheSystem) {
  CheckpointSpec checkpoint = sampleCheckpoint();
  const std::string trap = (folder_ / "trap").string();
  checkpoint.pickle =
      pickleProgram(pickleCall(pickleGlobal("os", "system"), pickleTuple({pickleText("touch " + trap)})));
  writeCheckpoint(checkpoint);
  expectBakeRefused("bad.pt", {"os", "system"});
  EXPECT_FALSE(std::filesystem::exists(trap));
}

TEST_F(BadInput, ParametersThatAreNotFinite) {
  for (const char* key :
       {"points", "radii", "density", "quaternions", "texel_sites", "texel_height", "texel_sv_axis", "texel_sv_rgb"}) {
    for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
      CheckpointSpec checkpoint = sampleCheckpoint();
      checkpoint.storages[key].replace(4, 4, packNumber(value));
      writeCheckpoint(checkpoint);
      expectBakeRefused("bad.pt", {key});
    }
  }
}

TEST_F(BadInput, NegativeCounts) {
  CheckpointSpec checkpoint = sampleCheckpoint();
  checkpoint.tensor("radii").shape = {-2};
  writeCheckpoint(checkpoint);
  expectBakeRefused("bad.pt", {"data.pkl", "tensor 'radii'", "sizes [-2]", "sizes and strides >= 0"});
}

TEST_F(BadInput, ACellCountOf10To12) {
  CheckpointSpec checkpoint = sampleCheckpoint();
  for (auto& [key, tensor] : checkpoint.tensors) tensor.shape[0] = 1'000'000'000'000;
  writeCheckpoint(checkpoint);
  expectBakeRefused("bad.pt", {"1000000000000"});
}

TEST_F(BadInput, CamerasThatAreNoJson) {
  makeRandomFoam("60");
  writeBytes(folder_ / "cameras.json", "{\"views\": [");
  expectRefusal({"render", "random.froth", "--cameras", "cameras.json", "--renderer", "reference", "-o", "out"},
                "cameras.json", {"JSON"});
}

TEST_F(BadInput, ImagesOfDifferentSizes) {
  writeBytes(folder_ / "a.pfm", "Pf\n1 1\n-1\n" + packNumber(0.5f));
  writeBytes(folder_ / "b.pfm", "Pf\n2 1\n-1\n" + packNumbers<float>({0.5f, 0.5f}));
  expectRefusal({"compare", "a.pfm", "b.pfm"}, "a.pfm and b.pfm", {"1 x 1", "2 x 1"});
}

TEST_F(BadInput, AnAssetOnTheDeviceIsNamedOnce) {
  if (!hasDevice()) FROTH_SKIP() << "no suitable Vulkan device";
  makeRandomFoam("12");
  writeBytes(folder_ / "bad.froth", readBytes(folder_ / "random.froth").substr(0, 200));
  expectRefusal({"render", "bad.froth", "--cameras", "cameras.json", "--renderer", "raster", "-o", "out"},
                "froth: bad.froth: 200 bytes", {});
}

TEST_F(BadInput, FilesFoundInTheWild) {
  const std::filesystem::path folder = dataFolder() / "malformed";
  if (!std::filesystem::exists(folder)) FROTH_SKIP() << folder << " is absent; set FROTH_DATA";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) expectBakeRefused(entry.path().string(), {});
  }
}

}  // namespace
}  // namespace froth::test
