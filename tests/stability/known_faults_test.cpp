// A known fault excuses itself alone.
#include "measure/stability/known_faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace froth {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const SeenFault kSeen{"exact", "raster", "over its bound", 20, "exact, raster: 20 times its bound"};
const KnownFault kKnown{"exact", "raster", "over its bound", 15, "colours are halves"};

TEST(KnownFaults, ExcuseTheSameFaultOfAboutTheSameSize) {
  EXPECT_THAT(unexplainedFaults({kKnown}, {kSeen}), IsEmpty());
}

TEST(KnownFaults, ExcuseNoOther) {
  for (const auto& change : std::vector<void (*)(SeenFault&)>{[](SeenFault& fault) { fault.preset = "high"; },
                                                              [](SeenFault& fault) { fault.renderer = "walk"; },
                                                              [](SeenFault& fault) { fault.kind = "another image"; }}) {
    SeenFault other = kSeen;
    change(other);
    other.text = "other";
    EXPECT_THAT(unexplainedFaults({kKnown}, {kSeen, other}), ElementsAre("other"));
  }
}

TEST(KnownFaults, ExcuseNothingThatHasGrown) {
  SeenFault grown = kSeen;
  grown.factor = 31;
  EXPECT_THAT(unexplainedFaults({kKnown}, {grown}), testing::Contains(grown.text));
}

TEST(KnownFaults, FailWhenTheyAreGoneOrMuchSmaller) {
  EXPECT_THAT(unexplainedFaults({kKnown}, {}), ElementsAre(HasSubstr("known but not seen")));
  SeenFault smaller = kSeen;
  smaller.factor = 7;
  EXPECT_THAT(unexplainedFaults({kKnown}, {smaller}), testing::Contains(HasSubstr("known but not seen")));
}

}  // namespace
}  // namespace froth
