// Drivers may fuse a product and a sum in one place and not in another. What two places must find with the same bits is
// made of operations that forbid it, and not of OpDot, which a driver takes apart as it likes: keys and planes of a
// walk, clearances that two cells share.
#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "spirv/walk_with_names.h"

namespace froth {
namespace {

struct ArithmeticOfFunction {
  int fixed = 0, free = 0, dots = 0;
};

// By the names of functions, without their arguments.
std::map<std::string, ArithmeticOfFunction> arithmeticOfWalk() {
  enum : uint32_t { kOpName = 5, kOpFunction = 54, kOpDecorate = 71, kOpDot = 148, kNoContraction = 42 };
  // negate, add, subtract, multiply, divide, vector times scalar
  const std::set<uint32_t> arithmetic = {127, 129, 131, 133, 136, 142};
  std::map<uint32_t, std::string> names;
  std::set<uint32_t> fixed;
  std::map<std::string, ArithmeticOfFunction> found;
  ArithmeticOfFunction* current = nullptr;
  const size_t count = std::size(walk_with_names_spirv);
  for (size_t i = 5; i < count; i += walk_with_names_spirv[i] >> 16) {
    const uint32_t* word = &walk_with_names_spirv[i];
    const uint32_t op = word[0] & 0xffff;
    if (op == kOpName) names[word[1]] = reinterpret_cast<const char*>(word + 2);
    if (op == kOpDecorate && word[2] == kNoContraction) fixed.insert(word[1]);
    if (op == kOpFunction) {
      const std::string& name = names[word[2]];
      current = &found[name.substr(0, name.find('('))];
    }
    if (!current) continue;
    if (op == kOpDot) ++current->dots;
    if (arithmetic.count(op) > 0) ++(fixed.count(word[2]) > 0 ? current->fixed : current->free);
  }
  return found;
}

TEST(FixedBits, NoDriverMayFuseWhatTwoPlacesMustFindAlike) {
  const auto found = arithmeticOfWalk();
  for (const char* name : {"fixedDot", "radicalOffset", "radicalClearance", "eyePlane", "parallelPlane", "nearnessOf",
                           "ballOf", "fromSiteToSite", "orderAlong", "restOfProducts", "comesBefore"}) {
    ASSERT_EQ(found.count(name), 1u) << name;
    const ArithmeticOfFunction& function = found.at(name);
    EXPECT_GT(function.fixed, 0) << name;
    EXPECT_EQ(function.free, 0) << name;
    EXPECT_EQ(function.dots, 0) << name;
  }
  // Made of these alone, and of comparisons.
  for (const char* name : {"keyOf", "comesFirst", "sharedClearance"}) {
    ASSERT_EQ(found.count(name), 1u) << name;
    EXPECT_EQ(found.at(name).dots, 0) << name;
    if (std::string(name) == "sharedClearance") continue;  // it negates, exactly
    EXPECT_EQ(found.at(name).fixed + found.at(name).free, 0) << name;
  }
}

}  // namespace
}  // namespace froth
