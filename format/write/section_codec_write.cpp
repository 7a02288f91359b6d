#include "format/write/section_codec_write.h"

#include <algorithm>
#include <cstring>

#include "base/morton_code.h"
#include "format/deltas.h"
#include "format/draco_positions.h"
#include "format/point_box.h"
#include "format/position_order.h"
#include "format/write/frame_write.h"

namespace froth {
namespace {

// Measured on trained foams, one core: on colours in floats level 3 packs 270 MB/s and level 9 55 MB/s
// for 1.5 % less; on graphs and lattice indices dense levels give up to 20 % less, because they spend less
// than a bit on a zero (level 15 packs 5 MB/s).
constexpr int kFastLevel = 3, kDenseLevel = 19;

int levelFor(size_t size, uint32_t elementSize) {
  constexpr size_t kDenseLimit = size_t{1} << 19;  // [bytes] of floats
  return elementSize < 4 || size <= kDenseLimit ? kDenseLevel : kFastLevel;
}

template <class Word>
std::vector<uint8_t> deltasOf(std::span<const uint8_t> raw, size_t components) {
  std::vector<uint8_t> deltas(raw.size());
  const size_t reach = components * sizeof(Word);
  for (size_t at = 0; at < raw.size(); at += sizeof(Word)) {
    Word before = 0, value;
    if (at >= reach) std::memcpy(&before, raw.data() + at - reach, sizeof(Word));
    std::memcpy(&value, raw.data() + at, sizeof(Word));
    const Word folded = foldDelta(static_cast<Word>(value - before));
    std::memcpy(deltas.data() + at, &folded, sizeof(Word));
  }
  return deltas;
}

std::vector<uint8_t> deltasOf(std::span<const uint8_t> raw, SectionShape shape) {
  if (shape.elementSize == 1) return deltasOf<uint8_t>(raw, shape.components);
  if (shape.elementSize == 2) return deltasOf<uint16_t>(raw, shape.components);
  return deltasOf<uint32_t>(raw, shape.components);
}

Result<EncodedSection> encodeAs(SectionCodec codec, std::span<const uint8_t> raw, SectionShape shape, int level) {
  EncodedSection section{codec, {}};
  Status status;
  if (codec == SectionCodec::kZstd) {
    status = appendFrame(raw, level, section.stored);
  } else if (codec == SectionCodec::kBytePlanes) {
    status = appendPlanes(raw, entrySize(shape), level, section.stored);
  } else {
    status = appendPlanes(deltasOf(raw, shape), entrySize(shape), level, section.stored);
  }
  if (!status) return status.error();
  return section;
}

Result<EncodedSection> encodeMortonDeltas(std::span<const LatticePoint> points) {
  const PointBox box = boxOf(points);
  if (box.bits > kMaxPositionBits) {
    return makeError(ErrorKind::kUnsupported, "the points span %u bits, the codec takes %u", box.bits,
                     kMaxPositionBits);
  }
  std::vector<uint64_t> deltas(points.size());
  uint64_t before = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const uint64_t code = mortonCode(box.offsetOf(points[i]));
    deltas[i] = foldDelta(code - before);
    before = code;
  }
  const std::span<const uint8_t> least{reinterpret_cast<const uint8_t*>(box.least.data()), sizeof(box.least)};
  const std::span<const uint8_t> deltaBytes{reinterpret_cast<const uint8_t*>(deltas.data()), deltas.size() * 8};
  EncodedSection section{SectionCodec::kMortonDelta, {}};
  if (Status status = appendFrame(least, kDenseLevel, section.stored); !status) return status.error();
  if (Status status = appendPlanes(deltaBytes, 8, kDenseLevel, section.stored); !status) return status.error();
  return section;
}

// The best of the codecs for numbers of any meaning, judged by a quick try on the start of the section: what
// is different between them shows at once.
Result<EncodedSection> encodeNumbers(std::span<const uint8_t> raw, SectionShape shape) {
  constexpr size_t kSampleSize = size_t{1} << 20;
  const size_t sampleSize =
      std::min(raw.size(), std::max(kSampleSize / entrySize(shape), size_t{1}) * entrySize(shape));
  SectionCodec best = SectionCodec::kZstd;
  size_t leastSize = SIZE_MAX;
  for (const SectionCodec codec : {SectionCodec::kZstd, SectionCodec::kBytePlanes, SectionCodec::kDeltaPlanes}) {
    if (codec == SectionCodec::kBytePlanes && entrySize(shape) == 1) continue;  // the same bytes as without planes
    const Result<EncodedSection> section = encodeAs(codec, raw.first(sampleSize), shape, kFastLevel);
    if (!section) return section.error();
    if (section->stored.size() >= leastSize) continue;
    best = codec;
    leastSize = section->stored.size();
  }
  return encodeAs(best, raw, shape, levelFor(raw.size(), shape.elementSize));
}

// Sees to it that the section expands by no more than a reader accepts and is never longer than the numbers.
EncodedSection finishSection(EncodedSection section, std::span<const uint8_t> raw) {
  const size_t leastSize = (raw.size() + kMaxExpansion - 1) / kMaxExpansion;
  section.stored.resize(std::max(section.stored.size(), leastSize), 0);
  if (raw.size() > section.stored.size()) return section;
  return {SectionCodec::kStored, {raw.begin(), raw.end()}};
}

}  // namespace

Result<EncodedSection> encodeSection(std::span<const uint8_t> raw, SectionShape shape) {
  Result<EncodedSection> section = encodeNumbers(raw, shape);
  if (!section) return section;
  return finishSection(std::move(*section), raw);
}

Result<EncodedSection> encodePositions(std::span<const uint8_t> raw, std::span<const uint32_t> runs) {
  std::vector<LatticePoint> points(raw.size() / sizeof(LatticePoint));
  std::memcpy(points.data(), raw.data(), raw.size());
  Result<EncodedSection> best = encodeNumbers(raw, kPositionShape);
  if (!best) return best;
  Result<EncodedSection> morton = encodeMortonDeltas(points);
  if (morton && morton->stored.size() < best->stored.size()) best = std::move(morton);
  Result<std::vector<uint8_t>> draco = writeDracoPositions(points, runs);
  const bool fits = draco && raw.size() <= kMaxDracoExpansion * draco->size();
  if (fits && draco->size() < best->stored.size()) best = EncodedSection{SectionCodec::kDraco, std::move(*draco)};
  return finishSection(std::move(*best), raw);
}

Result<PositionOrder> choosePositionOrder(std::span<const LatticePoint> points) {
  PositionOrder choice;
  choice.order.resize(points.size());
  for (uint32_t i = 0; i < choice.order.size(); ++i) choice.order[i] = i;
  if (kDracoDecodeCost > kMaxDecodeCost || points.empty()) return choice;

  const Result<EncodedSection> morton = encodeMortonDeltas(points);
  Result<std::vector<uint32_t>> order = dracoOrder(points);
  if (!morton || !order) return choice;
  std::vector<LatticePoint> ordered(points.size());
  for (size_t i = 0; i < ordered.size(); ++i) ordered[i] = points[(*order)[i]];
  const uint32_t run = static_cast<uint32_t>(points.size());
  const Result<std::vector<uint8_t>> draco = writeDracoPositions(ordered, {&run, 1});
  if (!draco || draco->size() >= morton->stored.size()) return choice;
  return PositionOrder{true, std::move(*order)};
}

}  // namespace froth
