#include "runtime/asset/cell_packer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "base/float_span.h"
#include "format/chunk_lobes.h"
#include "runtime/asset/axis_labels.h"
#include "runtime/asset/bit_writer.h"
#include "runtime/asset/cell_numbers.h"

namespace froth {
namespace {

constexpr uint32_t kFloatBits = 32;

// In the order of a cell's bits.
enum Width { kPlace, kHeight, kBaseGreen, kBaseChroma, kLobes, kAxis, kLobeGreen, kLobeChroma, kWidthCount };

struct CellShape {
  std::array<uint32_t, kWidthCount> widths{};
  int32_t lowestHeight = 0;
  std::array<int32_t, 3> lowestBase{};
  size_t firstLobe = 0, endLobe = 0;
  std::vector<AxisCode> ownAxes;
};

// Where the last cell that has an axis of its own keeps it.
struct OwnPlace {
  uint32_t cell, index;
};
constexpr uint32_t kNoCell = UINT32_MAX;

bool isShort(const CellNumbers& numbers) {
  const auto fits = [](int32_t code) { return static_cast<int16_t>(code) == code; };
  return !numbers.isRaw() && std::ranges::all_of(numbers.codes, fits);
}

class CellPacker {
 public:
  CellPacker(const ChunkContents& chunk, ChunkCodes&& codes, const AssetContents& asset)
      : chunk_(chunk),
        detailCount_(asset.detailCount),
        lobeCount_(asset.lobeCount),
        normals_(std::move(codes.normals)) {
    const Quantization& steps = asset.quantization;
    places_ =
        toNumbers(std::move(codes.detailSites), steps.detailSiteStep, floatsOf(chunk.detailSites), chunk.detailScales);
    heights_ = toNumbers(std::move(codes.detailHeights), steps.heightStep, chunk.detailHeights, chunk.detailScales);
    bases_ = toColourNumbers(std::move(codes.baseColours), steps.colourStep, floatsOf(chunk.baseColours));
    axes_ = toNumbers(std::move(codes.lobeAxes), codes.axisStep, floatsOf(chunk.lobeAxes));
    colours_ = toColourNumbers(std::move(codes.lobeColours), steps.colourStep, floatsOf(chunk.lobeColours));
    labels_ = labelAxes(axes_);
    ownPlaces_.resize(labels_.axisCount, {kNoCell, 0});
    code_.normalBits = normals_.empty() ? 0 : steps.normalBits;
  }

  Result<PackedCells> pack() {
    measureCells();
    describeCode();
    PackedCells packed{code_, {}, {}, isShort(axes_) && isShort(colours_)};
    for (const AxisCode& axis : labels_.table) putAxis(axis);
    for (uint32_t cell = 0; cell < chunk_.liveCount; ++cell) {
      const uint64_t start = bits_.startByte();
      if (start > UINT32_MAX) {
        return makeError(ErrorKind::kMemory,
                         "the cells of one chunk need more than 4 GiB on the GPU; bake the scene in smaller chunks");
      }
      packed.starts.push_back(static_cast<uint32_t>(start));
      putCell(cell);
    }
    packed.words = bits_.finish();
    return packed;
  }

 private:
  uint32_t lobesOf(size_t detail) const { return lobeCountOf(chunk_, lobeCount_, detail); }

  void measureCells() {
    size_t lobe = 0;
    for (uint32_t cell = 0; cell < chunk_.liveCount; ++cell) {
      CellShape shape;
      shape.firstLobe = lobe;
      measureDetails(cell, shape);
      shape.endLobe = shape.firstLobe + cellLobes(cell);
      lobe = shape.endLobe;
      measureLobes(cell, shape);
      shapes_.push_back(std::move(shape));
    }
  }

  size_t cellLobes(uint32_t cell) const {
    size_t sum = 0;
    for (size_t detail = size_t{cell} * detailCount_; detail < size_t{cell + 1} * detailCount_; ++detail) {
      sum += lobesOf(detail);
    }
    return sum;
  }

  void measureDetails(uint32_t cell, CellShape& shape) const {
    CodeRange places, heights, lobes;
    std::array<CodeRange, 3> bases;
    for (size_t detail = size_t{cell} * detailCount_; detail < size_t{cell + 1} * detailCount_; ++detail) {
      for (size_t c = 0; c < 2; ++c) places.add(places_.codes[2 * detail + c]);
      if (!heights_.codes.empty()) heights.add(heights_.codes[detail]);
      for (size_t c = 0; c < 3 && !bases_.codes.empty(); ++c) bases[c].add(bases_.codes[3 * detail + c]);
      lobes.add(static_cast<int32_t>(lobesOf(detail)));
    }
    shape.widths[kPlace] = places_.isRaw() ? kFloatBits : places.signedWidth();
    shape.widths[kHeight] = heights_.isRaw() ? kFloatBits : heights.width();
    shape.widths[kBaseGreen] = bases_.isRaw() ? kFloatBits : bases[0].width();
    shape.widths[kBaseChroma] = bases_.isRaw() ? kFloatBits : std::max(bases[1].width(), bases[2].width());
    shape.widths[kLobes] = static_cast<uint32_t>(std::bit_width(static_cast<uint32_t>(lobes.high)));
    if (!heights_.isRaw() && !heights_.codes.empty()) shape.lowestHeight = heights.low;
    if (bases_.isRaw() || bases_.codes.empty()) return;
    for (size_t c = 0; c < 3; ++c) shape.lowestBase[c] = bases[c].low;
  }

  void measureLobes(uint32_t cell, CellShape& shape) {
    CodeRange axes, green, chroma;
    for (size_t lobe = shape.firstLobe; lobe < shape.endLobe; ++lobe) {
      green.add(colours_.codes[3 * lobe]);
      for (size_t c = 1; c < 3; ++c) chroma.add(colours_.codes[3 * lobe + c]);
      for (size_t c = 0; c < 3; ++c) axes.add(axes_.codes[3 * lobe + c]);
      if (!labels_.table.empty()) numberAxis(cell, lobe, shape);
    }
    shape.widths[kLobeGreen] = colours_.isRaw() ? kFloatBits : green.signedWidth();
    shape.widths[kLobeChroma] = colours_.isRaw() ? kFloatBits : chroma.signedWidth();
    if (!labels_.table.empty()) {
      shape.widths[kAxis] = static_cast<uint32_t>(std::bit_width(labels_.table.size() + shape.ownAxes.size() - 1));
    } else {
      shape.widths[kAxis] = axes_.isRaw() ? kFloatBits : axes.signedWidth();
    }
  }

  // The lobe's label becomes what its cell writes for it: behind the table stand the cell's own axes, as they come.
  void numberAxis(uint32_t cell, size_t lobe, CellShape& shape) {
    uint32_t& label = labels_.labels[lobe];
    if (label < labels_.table.size()) return;
    OwnPlace& place = ownPlaces_[label];
    if (place.cell != cell) {
      place = {cell, static_cast<uint32_t>(shape.ownAxes.size())};
      shape.ownAxes.push_back({axes_.codes[3 * lobe], axes_.codes[3 * lobe + 1], axes_.codes[3 * lobe + 2]});
    }
    label = static_cast<uint32_t>(labels_.table.size()) + place.index;
  }

  void describeCode() {
    CodeRange heights, bases, densities;
    uint32_t widest = 0, ownAxes = 0, scale = 0, densityBits = 0;
    for (const CellShape& shape : shapes_) {
      widest = std::max(widest, *std::max_element(shape.widths.begin(), shape.widths.end()));
      heights.add(shape.lowestHeight);
      for (const int32_t lowest : shape.lowestBase) bases.add(lowest);
      ownAxes = std::max(ownAxes, static_cast<uint32_t>(shape.ownAxes.size()));
    }
    for (const uint8_t cellScale : chunk_.colourScales) scale = std::max<uint32_t>(scale, cellScale);
    for (const float density : chunk_.densities) densityBits |= std::bit_cast<uint32_t>(density);
    code_.densityShift = densityBits == 0 ? 0 : static_cast<uint32_t>(std::countr_zero(densityBits));
    for (const float density : chunk_.densities) densities.add(densityCode(density));
    code_.densityLowest = chunk_.liveCount > 0 ? static_cast<uint32_t>(densities.low) : 0;
    code_.densityBits = densities.width();
    code_.scaleBits = static_cast<uint32_t>(std::bit_width(scale));
    code_.widthBits = static_cast<uint32_t>(std::bit_width(widest));
    code_.heightBits = heights.signedWidth();
    code_.baseBits = bases.signedWidth();
    code_.ownAxisBits = static_cast<uint32_t>(std::bit_width(ownAxes));
    code_.axisBits = labels_.componentBits;
    code_.axisCount = static_cast<uint32_t>(labels_.table.size());
    code_.placeStep = places_.step;
    code_.heightStep = heights_.step;
    code_.baseStep = bases_.step;
    code_.axisStep = axes_.step;
    code_.colourStep = colours_.step;
  }

  int32_t densityCode(float density) const {
    return static_cast<int32_t>(std::bit_cast<uint32_t>(density) >> code_.densityShift);
  }

  void putSigned(int32_t value, uint32_t width) { bits_.put(static_cast<uint32_t>(value), width); }
  // A number of a kind, above the lowest one of its cell.
  void putNumber(const CellNumbers& numbers, size_t i, int32_t lowest, uint32_t width) {
    putSigned(numbers.isRaw() ? numbers.codes[i] : numbers.codes[i] - lowest, width);
  }
  void putAxis(const AxisCode& axis) {
    for (const int32_t component : axis) putSigned(component, code_.axisBits);
  }

  void putCell(uint32_t cell) {
    const CellShape& shape = shapes_[cell];
    bits_.put(static_cast<uint32_t>(densityCode(chunk_.densities[cell])) - code_.densityLowest, code_.densityBits);
    putOrientation(cell);
    bits_.put(chunk_.colourScales.empty() ? 0 : chunk_.colourScales[cell], code_.scaleBits);
    for (const uint32_t width : shape.widths) bits_.put(width, code_.widthBits);
    putSigned(shape.lowestHeight, code_.heightBits);
    for (const int32_t lowest : shape.lowestBase) putSigned(lowest, code_.baseBits);
    bits_.put(static_cast<uint32_t>(shape.ownAxes.size()), code_.ownAxisBits);
    for (const AxisCode& axis : shape.ownAxes) putAxis(axis);
    putDetails(cell, shape);
    for (size_t lobe = shape.firstLobe; lobe < shape.endLobe; ++lobe) putLobe(shape, lobe);
  }

  void putOrientation(uint32_t cell) {
    const glm::vec4& orientation = chunk_.orientations[cell];
    if (normals_.empty()) {
      for (int c = 0; c < 4; ++c) bits_.put(std::bit_cast<uint32_t>(orientation[c]), kFloatBits);
      return;
    }
    bits_.put(orientation.w > orientation.x, 1);
    for (const uint32_t index : normals_[cell]) bits_.put(index, code_.normalBits);
  }

  void putDetails(uint32_t cell, const CellShape& shape) {
    const size_t first = size_t{cell} * detailCount_;
    const auto& widths = shape.widths;
    for (size_t detail = first; detail < first + detailCount_; ++detail) bits_.put(lobesOf(detail), widths[kLobes]);
    for (size_t detail = first; detail < first + detailCount_; ++detail) {
      for (size_t c = 0; c < 2; ++c) putNumber(places_, 2 * detail + c, 0, widths[kPlace]);
      if (!heights_.codes.empty()) putNumber(heights_, detail, shape.lowestHeight, widths[kHeight]);
      for (size_t c = 0; c < 3 && !bases_.codes.empty(); ++c) {
        putNumber(bases_, 3 * detail + c, shape.lowestBase[c], widths[c == 0 ? kBaseGreen : kBaseChroma]);
      }
    }
  }

  void putLobe(const CellShape& shape, size_t lobe) {
    const auto& widths = shape.widths;
    if (labels_.table.empty()) {
      for (size_t c = 0; c < 3; ++c) putNumber(axes_, 3 * lobe + c, 0, widths[kAxis]);
    } else {
      bits_.put(labels_.labels[lobe], widths[kAxis]);
    }
    for (size_t c = 0; c < 3; ++c) {
      const uint32_t width = widths[c == 0 ? kLobeGreen : kLobeChroma];
      putNumber(colours_, 3 * lobe + c, 0, width);
    }
  }

  const ChunkContents& chunk_;
  uint32_t detailCount_, lobeCount_;
  CellNumbers places_, heights_, bases_, axes_, colours_;
  AxisLabels labels_;
  std::vector<OwnPlace> ownPlaces_;               // [labels_.axisCount]
  std::vector<std::array<uint32_t, 2>> normals_;  // empty: orientations are floats
  std::vector<CellShape> shapes_;
  gpu::CellCode code_{};
  BitWriter bits_;
};

}  // namespace

Result<PackedCells> packCells(const ChunkContents& chunk, ChunkCodes codes, const AssetContents& asset) {
  return CellPacker(chunk, std::move(codes), asset).pack();
}

}  // namespace froth
