#include "format/read/section_codec_read.h"

#include <array>
#include <cstring>
#include <vector>

#include "base/morton_code.h"
#include "format/container.h"
#include "format/deltas.h"
#include "format/draco_positions.h"
#include "format/read/frame_read.h"

namespace froth {
namespace {

using ull = unsigned long long;

template <class Word>
void undoDeltas(std::span<uint8_t> raw, size_t components) {
  const size_t reach = components * sizeof(Word);
  for (size_t at = 0; at < raw.size(); at += sizeof(Word)) {
    Word before = 0, folded;
    if (at >= reach) std::memcpy(&before, raw.data() + at - reach, sizeof(Word));
    std::memcpy(&folded, raw.data() + at, sizeof(Word));
    const Word value = static_cast<Word>(before + unfoldDelta(folded));
    std::memcpy(raw.data() + at, &value, sizeof(Word));
  }
}

void undoDeltas(std::span<uint8_t> raw, SectionShape shape) {
  if (shape.elementSize == 1) return undoDeltas<uint8_t>(raw, shape.components);
  if (shape.elementSize == 2) return undoDeltas<uint16_t>(raw, shape.components);
  undoDeltas<uint32_t>(raw, shape.components);
}

// A frame of the least coordinates of all points (3 x int32), then frames of the byte planes of the folded differences
// between the points' Morton codes (uint64).
Status readMortonDeltas(FrameReader& frame, std::span<uint8_t> raw) {
  const size_t count = raw.size() / sizeof(std::array<uint32_t, 3>);
  std::array<uint32_t, 3> least;
  std::vector<uint64_t> codes(count);
  const std::span<uint8_t> codeBytes{reinterpret_cast<uint8_t*>(codes.data()), count * sizeof(uint64_t)};
  if (Status status = frame.start(sizeof(least)); !status) return status;
  if (Status status = frame.read({reinterpret_cast<uint8_t*>(least.data()), sizeof(least)}); !status) return status;
  if (Status status = frame.end(); !status) return status;
  if (Status status = frame.readPlanes(codeBytes, sizeof(uint64_t)); !status) return status;

  uint64_t code = 0;
  for (size_t i = 0; i < count; ++i) {
    code += unfoldDelta(codes[i]);
    std::array<uint32_t, 3> point = mortonPoint(code);
    for (size_t axis = 0; axis < 3; ++axis) point[axis] += least[axis];
    std::memcpy(raw.data() + i * sizeof(point), point.data(), sizeof(point));
  }
  return frame.finish();
}

Status readZstd(SectionCodec codec, std::span<const uint8_t> stored, std::span<uint8_t> raw, const std::string& place,
                SectionShape shape) {
  FrameReader frame(stored, place);
  if (codec == SectionCodec::kMortonDelta) return readMortonDeltas(frame, raw);
  const auto readWhole = [&]() -> Status {
    if (Status status = frame.start(raw.size()); !status) return status;
    if (Status status = frame.read(raw); !status) return status;
    return frame.end();
  };
  const bool isPlanes = codec != SectionCodec::kZstd;
  if (Status status = isPlanes ? frame.readPlanes(raw, entrySize(shape)) : readWhole(); !status) return status;
  if (codec == SectionCodec::kDeltaPlanes) undoDeltas(raw, shape);
  return frame.finish();
}

Status checkShape(SectionCodec codec, std::span<const uint8_t> stored, std::span<uint8_t> raw, const std::string& place,
                  SectionShape shape) {
  if (codec > SectionCodec{kLastSectionCodec}) {
    return makeError(ErrorKind::kUnsupported, "%s: codec %u is unknown; update this program", place.c_str(),
                     static_cast<unsigned>(codec));
  }
  if (raw.size() % (uint64_t{shape.elementSize} * shape.components) != 0) {
    return makeError(ErrorKind::kBadInput, "%s: %llu bytes are no whole entries of %u x %u bytes; %s", place.c_str(),
                     ull{raw.size()}, shape.components, shape.elementSize, kSectionRemedy);
  }
  const bool isForPositions = codec == SectionCodec::kMortonDelta || codec == SectionCodec::kDraco;
  if (isForPositions && shape != kPositionShape) {
    return makeError(ErrorKind::kBadInput, "%s: codec %u is for positions only; %s", place.c_str(),
                     static_cast<unsigned>(codec), kSectionRemedy);
  }
  if (codec == SectionCodec::kStored && stored.size() != raw.size()) {
    return makeError(ErrorKind::kBadInput, "%s: %llu bytes stored as they are, for %llu; %s", place.c_str(),
                     ull{stored.size()}, ull{raw.size()}, kSectionRemedy);
  }
  return {};
}

}  // namespace

Status decodeSection(const SectionRecord& record, std::span<const uint8_t> stored, std::span<uint8_t> raw,
                     const std::string& place, SectionShape shape) {
  const SectionCodec codec{record.codec};
  if (!hashMatches(stored, record.hash)) {
    return makeError(ErrorKind::kBadInput, "%s: hash %016llx instead of %016llx; %s", place.c_str(),
                     ull{hashBytes(stored)}, ull{record.hash}, kSectionRemedy);
  }
  if (Status status = checkShape(codec, stored, raw, place, shape); !status) return status;
  if (raw.empty()) return {};
  if (codec == SectionCodec::kStored) {
    std::memcpy(raw.data(), stored.data(), raw.size());
    return {};
  }
  if (codec == SectionCodec::kDraco) return readDracoPositions(stored, raw, place);
  return readZstd(codec, stored, raw, place, shape);
}

}  // namespace froth
