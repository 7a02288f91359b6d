#include <algorithm>
#include <cstring>
#include <exception>

#include <draco/compression/point_cloud/algorithms/dynamic_integer_points_kd_tree_decoder.h>

#include "format/draco_positions.h"
#include "format/read/frame_read.h"
#include "format/section_codec.h"

namespace froth {
namespace {

using ull = unsigned long long;

// Takes numbers from the front of untrusted bytes.
class Cursor {
 public:
  explicit Cursor(std::span<const uint8_t> bytes) : left_(bytes) {}

  template <class Pod>
  bool take(Pod& value) {
    if (left_.size() < sizeof(Pod)) return false;
    std::memcpy(&value, left_.data(), sizeof(Pod));
    left_ = left_.subspan(sizeof(Pod));
    return true;
  }
  bool takeBytes(size_t size, std::span<const uint8_t>& bytes) {
    if (left_.size() < size) return false;
    bytes = left_.first(size);
    left_ = left_.subspan(size);
    return true;
  }
  // LEB128, as Draco writes it.
  bool takeVarint(uint32_t& value) {
    value = 0;
    for (int shift = 0; shift < 32; shift += 7) {
      uint8_t byte;
      if (!take(byte) || (shift == 28 && byte > 0x0f)) return false;
      value |= uint32_t{byte & 0x7fu} << shift;
      if (byte < 0x80) return true;
    }
    return false;
  }
  std::span<const uint8_t> left() const { return left_; }

 private:
  std::span<const uint8_t> left_;
};

// Whether the bytes are laid out as Draco's decoder will take them: a header that says what we expect, 33
// streams of the rANS coder for the numbers, and three of plain bits.
bool isKdTree(std::span<const uint8_t> bytes, uint32_t count) {
  constexpr int kNumberStreams = 33, kPlainStreams = 3;
  Cursor cursor(bytes);
  uint32_t bitLength = 0, pointCount = 0;
  if (!cursor.take(bitLength) || bitLength == 0 || bitLength > kMaxPositionBits) return false;
  if (!cursor.take(pointCount) || pointCount != count) return false;
  std::span<const uint8_t> stream;
  for (int i = 0; i < kNumberStreams; ++i) {
    uint8_t probability = 0;
    uint32_t size = 0;
    if (!cursor.take(probability) || !cursor.takeVarint(size) || size == 0 || !cursor.takeBytes(size, stream)) {
      return false;
    }
  }
  for (int i = 0; i < kPlainStreams; ++i) {
    uint32_t size = 0;
    if (!cursor.take(size) || size == 0 || size % 4 != 0 || !cursor.takeBytes(size, stream)) return false;
  }
  return cursor.left().empty();
}

// Takes the points that Draco finds, and no more than there is room for.
class PointSink {
 public:
  PointSink(std::span<uint8_t> raw, const std::array<uint32_t, 3>& least) : raw_(raw), least_(least) {}

  PointSink& operator*() { return *this; }
  PointSink& operator++() { return *this; }
  void operator=(const std::vector<uint32_t>& offsets) {
    std::array<uint32_t, 3> point = least_;
    for (size_t axis = 0; axis < 3; ++axis) point[axis] += offsets[axis];
    if (raw_.size() < sizeof(point)) return;
    std::memcpy(raw_.data(), point.data(), sizeof(point));
    raw_ = raw_.subspan(sizeof(point));
  }
  bool isFull() const { return raw_.empty(); }

 private:
  std::span<uint8_t> raw_;
  std::array<uint32_t, 3> least_;
};

bool decodeKdTree(std::span<const uint8_t> bytes, PointSink& sink) {
  try {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size(), kDracoBitstream);
    draco::DynamicIntegerPointsKdTreeDecoder<kDracoLevel> decoder(3);
    return decoder.DecodePoints(&buffer, sink) && sink.isFull();
  } catch (const std::exception&) {  // out of memory
    return false;
  }
}

}  // namespace

Status readDracoPositions(std::span<const uint8_t> stored, std::span<uint8_t> raw, const std::string& place) {
  constexpr size_t kPointSize = sizeof(LatticePoint);
  if (raw.size() > kMaxDracoExpansion * stored.size()) {
    return makeError(ErrorKind::kBadInput, "%s: %llu bytes of Draco for %llu, less than a %lluth; %s", place.c_str(),
                     ull{stored.size()}, ull{raw.size()}, ull{kMaxDracoExpansion}, kSectionRemedy);
  }
  const auto fail = [&place](const char* cause) {
    return makeError(ErrorKind::kBadInput, "%s: %s; %s", place.c_str(), cause, kSectionRemedy);
  };
  Cursor cursor(stored);
  while (!raw.empty()) {
    uint32_t count = 0, size = 0;
    std::array<uint32_t, 3> least;
    std::span<const uint8_t> tree;
    if (!cursor.take(count) || !cursor.take(size) || !cursor.take(least) || !cursor.takeBytes(size, tree)) {
      return fail("Draco's runs end early");
    }
    if (count == 0 || count > raw.size() / kPointSize) return fail("a run of Draco's has a wrong count");
    if (!isKdTree(tree, count)) return fail("a run of Draco's is no kd-tree of its points");
    PointSink sink(raw.first(count * kPointSize), least);
    if (!decodeKdTree(tree, sink)) return fail("Draco refuses a run");
    raw = raw.subspan(count * kPointSize);
  }
  const std::span<const uint8_t> rest = cursor.left();
  if (std::all_of(rest.begin(), rest.end(), [](uint8_t byte) { return byte == 0; })) return {};
  return fail("bytes after Draco's runs are not zero");
}

}  // namespace froth
