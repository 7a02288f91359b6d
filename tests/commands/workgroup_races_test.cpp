// Inside of a shader, barriers stand between what threads of a workgroup do in shared memory. lavapipe runs these
// threads in an order of its own, so that no image shows a barrier that is missing.
//
// What it does not see: memory that threads of a workgroup share in buffers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <vector>

#include "planted_list.h"
#include "shader_list.h"
#include "tests/commands/spirv.h"
#include "tests/commands/workgroup_races.h"

namespace froth::test {
namespace {

struct NamedCode {
  std::string name;
  std::span<const uint32_t> code;
};
#define FROTH_NAMED(name) {#name, name##_spirv},
const NamedCode kShaders[] = {FROTH_SHADERS(FROTH_NAMED)};
const NamedCode kPlanted[] = {FROTH_PLANTED(FROTH_NAMED)};
#undef FROTH_NAMED

// Where they begin.
std::vector<size_t> barriersOf(std::span<const uint32_t> code) {
  std::vector<size_t> places;
  for (const spirv::Instruction& instruction : spirv::split(code)) {
    if (instruction.op == spirv::kControlBarrier) places.push_back(instruction.words.data() - code.data());
  }
  return places;
}

TEST(WorkgroupRaces, AreInNoShader) {
  for (const NamedCode& shader : kShaders) EXPECT_THAT(findRaces(shader.code), testing::IsEmpty()) << shader.name;
}

// What keeps the test above from seeing nothing.
TEST(WorkgroupRaces, AppearWhereAnyBarrierIsLeftOut) {
  std::vector<std::string> needless;
  size_t barriers = 0;
  for (const NamedCode& shader : kShaders) {
    for (const size_t barrier : barriersOf(shader.code)) {
      std::vector<uint32_t> code(shader.code.begin(), shader.code.end());
      code.erase(code.begin() + barrier, code.begin() + barrier + (code[barrier] >> 16));
      if (findRaces(code).empty()) needless.push_back(shader.name);
      ++barriers;
    }
  }
  EXPECT_GT(barriers, 60u);
  // The first one of scanExclusive, but where it is called in a loop. In order_tiles, the one behind placeClasses: that
  // one follows.
  EXPECT_THAT(needless,
              testing::UnorderedElementsAre("choose_cells", "compact_cells", "count_tiles", "emit_pairs",
                                            "nearest_balls", "order_tiles", "sort_scatter", "sort_scatter_many"));
}

TEST(WorkgroupRaces, AppearWhereABarrierDoesNotOrderSharedMemory) {
  const auto code = std::ranges::find(kPlanted, "ONE_STORES_BEFORE_BARRIER", &NamedCode::name)->code;
  std::vector<uint32_t> changed(code.begin(), code.end());
  uint32_t* words = &changed[barriersOf(code).at(0)];
  EXPECT_THAT(findRaces(changed), testing::IsEmpty());
  words[3] = words[2];  // the constant 2, which is "acquire" as semantics
  EXPECT_THAT(findRaces(changed), testing::SizeIs(1));
}

TEST(WorkgroupRaces, ArePlacesOfWhichThreadsUseTheSameUnordered) {
  std::vector<std::string> found;
  for (const NamedCode& planted : kPlanted) {
    if (!findRaces(planted.code).empty()) found.push_back(planted.name);
  }
  EXPECT_THAT(found, testing::UnorderedElementsAre("OTHERS_PLACE", "UNKNOWN_PLACE", "LOAD_BEFORE_STORE", "ONE_STORES",
                                                   "BRANCHES", "ALL_STORE", "ATOMIC_AND_LOAD", "HALVES_WITHOUT_BARRIER",
                                                   "ROUNDS_WITHOUT_BARRIER", "SOME_MEET"));
}

}  // namespace
}  // namespace froth::test
