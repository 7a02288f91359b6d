// What the flags of `froth bake` make of a bake's options.
#include "tool/bake_flags.h"

#include <gtest/gtest.h>

namespace froth::test {
namespace {

BakeOptions optionsFor(const std::string& arguments, uint32_t cells) {
  CLI::App command;
  BakeFlags flags;
  flags.addTo(command);
  command.parse(arguments);
  const Result<BakeOptions> options = flags.options(cells);
  EXPECT_TRUE(options);
  return options ? *options : BakeOptions();
}

TEST(BakeFlags, GiveLevelsToLargeScenes) {
  EXPECT_FALSE(optionsFor("", 499'999).levels);
  EXPECT_TRUE(optionsFor("", 500'000).levels);
  EXPECT_TRUE(optionsFor("--lod", 100).levels);
  EXPECT_FALSE(optionsFor("--no-lod", 5'000'000).levels);
  EXPECT_FALSE(optionsFor("--no-walk", 5'000'000).levels) << "levels need the graph";
}

TEST(BakeFlags, HalveChunksOfScenesWithLevels) {
  const uint32_t whole = optionsFor("", 100).chunkCells;
  EXPECT_EQ(optionsFor("", 500'000).chunkCells, whole / 2);
  EXPECT_EQ(optionsFor("--no-lod", 500'000).chunkCells, whole);
  EXPECT_EQ(optionsFor("--chunk-cells 512", 500'000).chunkCells, 512u);
}

}  // namespace
}  // namespace froth::test
