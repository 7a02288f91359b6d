// Archives and tensors that are broken or lie. None may crash, hang, or take memory that the file's size does
// not justify.
#include <cmath>
#include <limits>

#include "tests/checkpoint/import_checks.h"

namespace froth {
namespace {

TEST(HostileArchive, IsRefusedAtEveryLengthButItsOwn) {
  const std::string bytes = buildCheckpoint(sampleCheckpoint(1, 1, 1));
  for (size_t length = 0; length < bytes.size(); ++length) {
    ASSERT_FALSE(importBytes(bytes.substr(0, length))) << length;
  }
  EXPECT_TRUE(importBytes(bytes));
}

TEST(HostileArchive, GivesAnErrorOrTheSameFoamWhicheverBitIsFlipped) {
  std::string bytes = buildCheckpoint(sampleCheckpoint(1, 1, 1));
  const Result<Foam> original = importBytes(bytes);
  ASSERT_TRUE(original);
  for (size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ 1 << bit % 8);
    const Result<Foam> foam = importBytes(bytes);
    if (foam) {
      expectSameFoam(*original, *foam);
    } else {
      EXPECT_EQ(foam.error().kind, ErrorKind::kBadInput);
    }
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ 1 << bit % 8);
  }
}

TEST(HostileArchive, NoticesAFlippedBitInAStorage) {
  std::string bytes = buildCheckpoint(sampleCheckpoint());
  const size_t place = bytes.find("model/data/points") + 20;
  bytes[place] = static_cast<char>(bytes[place] ^ 1);
  expectRefusal(importBytes(bytes), "member 'model/data/points' is damaged");
}

TEST(HostileArchive, IsRefusedWithItsCauseInTheMessage) {
  const auto refuse = [](void (*spoil)(std::vector<ZipEntrySpec>&), const char* part) {
    std::vector<ZipEntrySpec> entries = zipEntries(sampleCheckpoint());
    spoil(entries);
    expectRefusal(importBytes(buildZip(entries)), part);
    expectRefusal(importBytes(buildZip(entries, /*isZip64=*/true)), part);
  };
  using Entries = std::vector<ZipEntrySpec>&;
  refuse([](Entries e) { e[2].method = 8; }, "'model/data/density' is compressed (method 8)");
  refuse([](Entries e) { e[2].flags |= 1; }, "'model/data/density' is encrypted");
  refuse([](Entries e) { e[2].statedBegin = 0; }, "'model/data/density': local header at 0 contradicts");
  refuse([](Entries e) { e[2].statedBegin = 1u << 30; }, "no local header at 1073741824");
  refuse([](Entries e) { e[2].statedSize = 1u << 30; }, "1073741824 bytes");
  refuse([](Entries e) { e[2].statedSize = 20; }, "overlap");
  refuse([](Entries e) { e.push_back(e[2]); }, "two members are called 'model/data/density'");
  refuse([](Entries e) { e.erase(e.begin() + 2); }, "tensor 'density': its storage 'density' is not in the archive");
  refuse([](Entries e) { e.erase(e.begin()); }, "without data.pkl");
  refuse([](Entries e) { e.push_back({"other/data.pkl", e[0].bytes}); }, "two pickles");
  refuse([](Entries e) { e[1].bytes = "big"; }, "byte order 'big'");
  refuse([](Entries e) { e[0].crc32 = 1; }, "'model/data.pkl' is damaged");
  refuse([](Entries e) { e.clear(); }, "without data.pkl");
}

TEST(HostileArchive, MayNotClaimMoreMembersThanItsDirectoryHolds) {
  std::string bytes = buildCheckpoint(sampleCheckpoint());
  bytes.replace(bytes.size() - 12, 2, packNumber(uint16_t{60000}));
  expectRefusal(importBytes(bytes), "cannot hold 60000 members");
}

TEST(HostileArchive, MayNotPointItsZip64RecordsOutOfTheFile) {
  std::string bytes = buildZip(zipEntries(sampleCheckpoint()), /*isZip64=*/true);
  const size_t record = bytes.rfind("PK\x06\x06"), locator = bytes.rfind("PK\x06\x07");
  for (const uint64_t value : {~uint64_t{0}, ~uint64_t{0} - 40, uint64_t{1} << 40}) {
    std::string spoilt = bytes;
    spoilt.replace(locator + 8, 8, packNumber(value));
    expectRefusal(importBytes(spoilt), "no zip64 record lies");
    spoilt = bytes;
    spoilt.replace(record + 48, 8, packNumber(value));
    expectRefusal(importBytes(spoilt), "reaches past");
    spoilt = bytes;
    spoilt.replace(record + 32, 8, packNumber(value));
    expectRefusal(importBytes(spoilt), "cannot hold");
  }
}

TEST(HostileTensor, IsRefusedWhenItLeavesItsStorage) {
  constexpr int64_t kHuge = 1'000'000'000'000, kLargest = std::numeric_limits<int64_t>::max();
  const auto refuse = [](void (*spoil)(TensorSpec&), const char* part) {
    CheckpointSpec checkpoint = sampleCheckpoint();
    spoil(checkpoint.tensor("points"));
    expectRefusal(importSpec(checkpoint), part);
  };
  refuse([](TensorSpec& t) { t.offset = 1; }, "leaves its storage of 6 elements");
  refuse([](TensorSpec& t) { t.strides = {4, 1}; }, "leaves its storage");
  refuse([](TensorSpec& t) { t.shape = {kHuge, 3}; }, "shape [1000000000000, 3]");
  refuse([](TensorSpec& t) { t.shape = {kLargest, kLargest}; }, "leaves its storage");
  refuse([](TensorSpec& t) { t.strides = {kLargest, kLargest}; }, "leaves its storage");
  refuse([](TensorSpec& t) { t.offset = kLargest; }, "leaves its storage");
  refuse([](TensorSpec& t) { t.storageCount = kHuge; }, "has 24 bytes, expected 1000000000000 elements");
  refuse([](TensorSpec& t) { t.storageCount = 5; }, "has 24 bytes, expected 5 elements");
  refuse([](TensorSpec& t) { t.storageClass = "LongStorage"; }, "'points' holds integers");
  refuse([](TensorSpec& t) { t.shape = {-1, 3}; }, "sizes and strides >= 0");
  refuse([](TensorSpec& t) { t.strides = {-3, 1}; }, "sizes and strides >= 0");
  refuse([](TensorSpec& t) { t.offset = -1; }, "offset >= 0");
  refuse([](TensorSpec& t) { t.strides = {3}; }, "equally many sizes and strides");
  refuse([](TensorSpec& t) { t.storageCount = -6; }, "count >= 0");
  refuse([](TensorSpec& t) { t.shape = t.strides = std::vector<int64_t>(9, 1); }, "at most 8");
}

TEST(HostileTensor, MayNotExpandASmallFileToAHugeFoam) {
  CheckpointSpec checkpoint = sampleCheckpoint(1, 1, 1);
  for (auto& [key, tensor] : checkpoint.tensors) {
    tensor.shape[0] = 1'000'000;
    tensor.strides[0] = 0;
  }
  expectRefusal(importSpec(checkpoint), "expand to 72000000 bytes");
  for (auto& [key, tensor] : checkpoint.tensors) {
    tensor.shape[0] = 1'000'000'000'000;
  }
  expectRefusal(importSpec(checkpoint), "[1000000000000, 3]");
}

TEST(HostileTensor, IsRefusedWhenItsShapeDoesNotFitTheOthers) {
  const auto refuse = [](const char* key, const std::vector<int64_t>& shape, const char* part) {
    CheckpointSpec checkpoint = sampleCheckpoint(2, 3, 2);
    checkpoint.tensor(key).shape = shape;
    checkpoint.tensor(key).strides = std::vector<int64_t>(shape.size(), 0);
    expectRefusal(importSpec(checkpoint), part);
  };
  refuse("points", {0, 3}, "'points' has shape [0, 3]");
  refuse("points", {3, 3}, "'density' has shape [2], the others ask for [3]");
  refuse("points", {2, 4}, "'points' has shape [2, 4], the others ask for [2, 3]");
  refuse("points", {}, "'points' has shape []");
  refuse("radii", {2, 1}, "'radii' has shape [2, 1]");
  refuse("quaternions", {2, 3}, "'quaternions' has shape [2, 3]");
  refuse("texel_sites", {2, 0, 2}, "1 <= K <= 32");
  refuse("texel_sites", {2, 33, 2}, "1 <= K <= 32");
  refuse("texel_sv_axis", {2, 3, 0}, "1 <= M <= 32");
  refuse("texel_sv_axis", {2, 3, 99}, "1 <= M <= 32");
  refuse("texel_sv_axis", {2, 3, 7}, "'texel_sv_axis' has shape [2, 3, 7], the others ask for [2, 3, 6]");
  refuse("texel_sv_rgb", {2, 3, 3}, "'texel_sv_rgb' has shape [2, 3, 3]");
  refuse("texel_height", {2, 2}, "'texel_height' has shape [2, 2]");
}

TEST(HostileTensor, IsNamedWithItsCellWhenAValueIsNotFinite) {
  for (const auto& [key, spec] : sampleCheckpoint(2, 3, 2).tensors) {
    for (const float value : {NAN, INFINITY, -INFINITY}) {
      SCOPED_TRACE(testing::Message() << key << " " << value);
      CheckpointSpec checkpoint = sampleCheckpoint(2, 3, 2);
      std::string& bytes = checkpoint.storages[key];
      bytes.replace(bytes.size() - 4, 4, packNumber(value));
      expectRefusal(importSpec(checkpoint), "tensor '" + key + "'");
      expectRefusal(importSpec(checkpoint), "cell 1");
    }
  }
}

TEST(HostileTensor, IsNamedWithItsCellWhenADoubleDoesNotFitIntoAFloat) {
  CheckpointSpec checkpoint = sampleCheckpoint(2, 1, 1);
  checkpoint.tensor("quaternions").storageClass = "DoubleStorage";
  checkpoint.storages["quaternions"] = packNumbers<double>({1, 0, 0, 0, 1e300, 0, 0, 0});
  expectRefusal(importSpec(checkpoint), "the quaternion of cell 1 has length inf");
  checkpoint = sampleCheckpoint(2, 1, 1);
  checkpoint.tensor("points").storageClass = "DoubleStorage";
  checkpoint.storages["points"] = packNumbers<double>({0, 0, 0, 0, -1e39, 0});
  expectRefusal(importSpec(checkpoint), "tensor 'points': cell 1 of 2 holds -inf");
}

TEST(HostileTensor, IsNamedWithItsCellWhenARadiusVanishes) {
  CheckpointSpec checkpoint = sampleCheckpoint(3, 1, 1);
  checkpoint.setFloats("radii", {3}, {1, 1, -3});
  expectRefusal(importSpec(checkpoint), "tensor 'radii': cell 2 has the raw value -3, which activates to 0");
}

TEST(HostileTensor, IsNamedWithItsCellWhenAQuaternionHasNoLength) {
  CheckpointSpec checkpoint = sampleCheckpoint(2, 1, 1);
  checkpoint.setFloats("quaternions", {2, 4}, {1, 0, 0, 0, 0, 0, 0, 0});
  expectRefusal(importSpec(checkpoint), "the quaternion of cell 1 has length 0");
}

}  // namespace
}  // namespace froth
