// Section codecs: every one gives back every bit, and refuses every other.
#include <cstring>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "codec_samples.h"
#include "format/container.h"
#include "format/draco_positions.h"
#include "format/position_order.h"
#include "format/read/section_codec_read.h"
#include "format/write/section_codec_write.h"

namespace froth {
namespace {

using testing::HasSubstr;

Result<std::vector<uint8_t>> decode(SectionCodec codec, std::span<const uint8_t> stored, size_t rawSize,
                                    SectionShape shape) {
  SectionRecord record;
  record.codec = static_cast<uint16_t>(codec);
  record.hash = hashBytes(stored);
  std::vector<uint8_t> raw(rawSize);
  if (Status status = decodeSection(record, stored, raw, "here", shape); !status) return status.error();
  return raw;
}

void expectRoundTrip(std::span<const uint8_t> raw, SectionShape shape) {
  const Result<EncodedSection> section = encodeSection(raw, shape);
  ASSERT_TRUE(section) << section.error().message;
  EXPECT_LE(section->stored.size(), raw.size());
  EXPECT_LE(raw.size(), kMaxExpansion * section->stored.size());
  const Result<std::vector<uint8_t>> decoded = decode(section->codec, section->stored, raw.size(), shape);
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_TRUE(std::equal(raw.begin(), raw.end(), decoded->begin()));
}

constexpr SectionShape kShapes[] = {{1, 1}, {1, 3}, {2, 1}, {2, 2}, {4, 1}, {4, 3}, {4, 4}};

// Points in the order in which Draco gives them.
std::vector<LatticePoint> inDracoOrder(const std::vector<LatticePoint>& points) {
  const Result<std::vector<uint32_t>> order = dracoOrder(points);
  EXPECT_TRUE(order);
  std::vector<LatticePoint> ordered;
  for (const uint32_t i : *order) ordered.push_back(points[i]);
  return ordered;
}

EncodedSection sectionIn(SectionCodec codec) {
  static const std::vector<LatticePoint> points = [] {
    std::vector<LatticePoint> sorted = randomPoints(50, 8);
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  }();
  const uint32_t run = 50;
  if (codec == SectionCodec::kDraco) return {codec, *writeDracoPositions(inDracoOrder(points), {&run, 1})};
  return *encodePositions(bytesOf(points), {&run, 1});
}

TEST(Codec, GivesBackRandomNumbersOfEveryShape) {
  for (const SectionShape shape : kShapes) expectRoundTrip(randomBytes(24 * 1000), shape);
}

TEST(Codec, GivesBackConstantExtremeAndSingleEntries) {
  for (const SectionShape shape : kShapes) {
    expectRoundTrip(std::vector<uint8_t>(24 * 1000, 0), shape);
    expectRoundTrip(std::vector<uint8_t>(24 * 1000, 0xff), shape);
    expectRoundTrip(std::vector<uint8_t>(size_t{shape.elementSize} * shape.components, 0x80), shape);
    std::vector<uint8_t> alternating(24 * 100);
    for (size_t i = 0; i < alternating.size(); ++i) alternating[i] = i / 12 % 2 ? 0xff : 0;
    expectRoundTrip(alternating, shape);
  }
}

TEST(Codec, GivesBackASectionLargerThanTheSampleThatChoosesIt) {
  std::vector<uint32_t> numbers(600000);
  std::iota(numbers.begin(), numbers.end(), 0u);
  const std::vector<uint8_t> noise = randomBytes(numbers.size());
  for (size_t i = 300000; i < numbers.size(); ++i) numbers[i] = noise[i] * 0x01010101u;
  expectRoundTrip(bytesOf(numbers), {4, 1});
}

TEST(Codec, ChoosesDifferencesForARamp) {
  std::vector<uint16_t> ramp(5000);
  std::iota(ramp.begin(), ramp.end(), uint16_t{40000});
  EXPECT_EQ(encodeSection(bytesOf(ramp), {2, 1})->codec, SectionCodec::kDeltaPlanes);
}

TEST(Codec, ChoosesTheSameBytesAgain) {
  const std::vector<uint8_t> raw = randomBytes(120000);
  EXPECT_EQ(encodeSection(raw, {4, 3})->stored, encodeSection(raw, {4, 3})->stored);
}

void expectPositions(const std::vector<LatticePoint>& points, std::vector<uint32_t> runs) {
  const std::span<const uint8_t> raw = bytesOf(points);
  const Result<EncodedSection> section = encodePositions(raw, runs);
  ASSERT_TRUE(section) << section.error().message;
  EXPECT_LE(section->stored.size(), raw.size());
  const Result<std::vector<uint8_t>> decoded = decode(section->codec, section->stored, raw.size(), kPositionShape);
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_TRUE(std::equal(raw.begin(), raw.end(), decoded->begin()));
}

TEST(PositionCodec, GivesBackPointsInAnyOrder) {
  for (const uint32_t bits : {1u, 8u, 16u, 21u, 22u, 32u}) expectPositions(randomPoints(3000, bits), {2000, 1000});
  expectPositions({{INT32_MIN, 0, INT32_MAX}}, {1});
  expectPositions({{INT32_MIN, 0, 5}, {INT32_MAX, -1, 5}}, {1, 1});
  expectPositions(std::vector<LatticePoint>(1000, {4, 5, 6}), {1000});
}

TEST(PositionCodec, TakesDracoWhereEveryRunLiesInItsOrder) {
  const std::vector<LatticePoint> points = randomPoints(6000, 14);
  std::vector<LatticePoint> ordered = inDracoOrder({points.begin(), points.begin() + 4000});
  const std::vector<LatticePoint> second = inDracoOrder({points.begin() + 4000, points.end()});
  ordered.insert(ordered.end(), second.begin(), second.end());
  const std::vector<uint32_t> runs = {4000, 2000}, wrongRuns = {3000, 3000};
  EXPECT_EQ(encodePositions(bytesOf(ordered), runs)->codec, SectionCodec::kDraco);
  EXPECT_NE(encodePositions(bytesOf(ordered), wrongRuns)->codec, SectionCodec::kDraco);
  expectPositions(ordered, runs);
}

TEST(PositionCodec, OrderOfDracoIsAPermutationThatDoesNotDependOnTheOrderGiven) {
  std::vector<LatticePoint> points = randomPoints(2000, 5);  // with many equal ones
  const std::vector<LatticePoint> ordered = inDracoOrder(points);
  EXPECT_TRUE(std::is_permutation(points.begin(), points.end(), ordered.begin()));
  std::reverse(points.begin(), points.end());
  EXPECT_EQ(inDracoOrder(points), ordered);
}

TEST(PositionCodec, ChosenOrderIsThatOfThePointsOrDracos) {
  const std::vector<LatticePoint> points = randomPoints(4000, 16);
  const Result<PositionOrder> choice = choosePositionOrder(points);
  ASSERT_TRUE(choice);
  ASSERT_TRUE(choice->isDraco);
  EXPECT_EQ(choice->order, *dracoOrder(points));
  const std::vector<LatticePoint> wide = randomPoints(100, 30);
  ASSERT_TRUE(choosePositionOrder(wide));
  EXPECT_FALSE(choosePositionOrder(wide)->isDraco);
  EXPECT_TRUE(choosePositionOrder({})->order.empty());
}

class HostileCodec : public testing::TestWithParam<SectionCodec> {};

TEST_P(HostileCodec, RefusesEveryTruncation) {
  const EncodedSection section = sectionIn(GetParam());
  const std::span<const uint8_t> stored = section.stored;
  for (size_t size = 0; size < stored.size(); ++size) {
    EXPECT_FALSE(decode(section.codec, stored.first(size), 600, kPositionShape)) << size;
  }
}

TEST_P(HostileCodec, RefusesAnotherCount) {
  const EncodedSection section = sectionIn(GetParam());
  for (const size_t points : {1u, 49u, 51u, 100000u}) {
    EXPECT_FALSE(decode(section.codec, section.stored, points * 12, kPositionShape)) << points;
  }
}

TEST_P(HostileCodec, RefusesBytesBehindUnlessTheyAreZero) {
  EncodedSection section = sectionIn(GetParam());
  section.stored.push_back(0);
  EXPECT_TRUE(decode(section.codec, section.stored, 600, kPositionShape));
  section.stored.push_back(1);
  EXPECT_FALSE(decode(section.codec, section.stored, 600, kPositionShape));
}

TEST_P(HostileCodec, RefusesOrDecodesEveryFlippedBit) {
  const EncodedSection section = sectionIn(GetParam());
  for (size_t bit = 0; bit < section.stored.size() * 8; ++bit) {
    std::vector<uint8_t> flipped = section.stored;
    flipped[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
    (void)decode(section.codec, flipped, 600, kPositionShape);
  }
}

INSTANTIATE_TEST_SUITE_P(Codecs, HostileCodec, testing::Values(SectionCodec::kMortonDelta, SectionCodec::kDraco));

TEST(Codec, RefusesAWrongShapeOrAnUnknownCodec) {
  const EncodedSection section = sectionIn(SectionCodec::kDraco);
  const std::vector<uint8_t> bytes(12);
  EXPECT_THAT(decode(section.codec, section.stored, 600, {4, 1}).error().message, HasSubstr("positions only"));
  EXPECT_THAT(decode(SectionCodec{6}, bytes, 12, {4, 1}).error().message, HasSubstr("codec 6 is unknown"));
  EXPECT_THAT(decode(SectionCodec::kStored, bytes, 12, {4, 4}).error().message, HasSubstr("no whole entries"));
  EXPECT_THAT(decode(SectionCodec::kStored, bytes, 8, {4, 1}).error().message, HasSubstr("stored as they are"));
}

TEST(Codec, RefusesDracoThatExpandsTooMuch) {
  const EncodedSection section = sectionIn(SectionCodec::kDraco);
  const size_t rawSize = (section.stored.size() * kMaxDracoExpansion / 12 + 1) * 12;
  EXPECT_THAT(decode(section.codec, section.stored, rawSize, kPositionShape).error().message, HasSubstr("less than"));
}

}  // namespace
}  // namespace froth
