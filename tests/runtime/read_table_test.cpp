// What reads may be under way together.
#include "runtime/reads/read_table.h"

#include <vector>

#include <gtest/gtest.h>

namespace froth {
namespace {

constexpr uint64_t kMebibyte = 1u << 20;

// Of a reader that never writes, so that large ranges take no memory.
class ReadTableTest : public testing::Test {
 protected:
  uint64_t begin(uint64_t size) {
    FrothReader reader{};
    reader.read = [](void*, uint64_t, uint64_t, uint64_t, void*) {};
    return table_.begin(reader, {0, size});
  }
  bool hasRoom(std::vector<ByteRange> ranges) const { return table_.hasRoom(ranges); }

  ReadTable table_;
};

TEST_F(ReadTableTest, HasRoomForSixteenMebibytesTogether) {
  const uint64_t first = begin(10 * kMebibyte);
  EXPECT_TRUE(hasRoom({{0, 4 * kMebibyte}, {8 * kMebibyte, 2 * kMebibyte}}));
  EXPECT_FALSE(hasRoom({{0, 4 * kMebibyte}, {8 * kMebibyte, 2 * kMebibyte + 1}}));
  EXPECT_TRUE(table_.complete(first, FROTH_OK));
  EXPECT_FALSE(hasRoom({{0, 7 * kMebibyte}})) << "answered, and not taken";
  EXPECT_EQ(table_.take(first).read.range.size, 10 * kMebibyte);
  EXPECT_TRUE(hasRoom({{0, 16 * kMebibyte}}));
}

TEST_F(ReadTableTest, HasRoomForALargerRangeAlone) {
  EXPECT_TRUE(hasRoom({{0, 100 * kMebibyte}}));
  const uint64_t first = begin(100 * kMebibyte);
  EXPECT_FALSE(hasRoom({{0, 1}}));
  table_.drop(first);
  EXPECT_FALSE(hasRoom({{0, 1}})) << "dropped, and not answered";
  EXPECT_TRUE(table_.complete(first, FROTH_ERROR_FILE));
  EXPECT_TRUE(hasRoom({{0, 100 * kMebibyte}}));
}

TEST_F(ReadTableTest, HasRoomForThirtyTwoRanges) {
  for (int i = 0; i < 30; ++i) begin(1);
  EXPECT_TRUE(hasRoom({{0, 1}, {8, 1}}));
  EXPECT_FALSE(hasRoom({{0, 1}, {8, 1}, {16, 1}}));
  EXPECT_FALSE(table_.cancelAll());
}

}  // namespace
}  // namespace froth
