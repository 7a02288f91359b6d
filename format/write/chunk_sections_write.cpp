#include "format/write/chunk_sections_write.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <span>

#include "base/float_span.h"
#include "format/chunk_lobes.h"
#include "format/graph_rows.h"
#include "format/lattice.h"

namespace froth {
namespace {

constexpr char kRemedy[] = "snap it before the asset is built";

template <class Element>
std::vector<uint8_t> bytesOf(std::span<const Element> array) {
  const uint8_t* first = reinterpret_cast<const uint8_t*>(array.data());
  return {first, first + array.size_bytes()};
}

bool isZero(std::span<const float> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](float x) { return x == 0; });
}

// The index of a value on the lattice of a step; false if it is not on it.
bool findIndex(float value, double step, int32_t& index) {
  const double nearest = std::nearbyint(value / step);
  if (!(std::abs(nearest) <= kMaxLatticeIndex)) return false;
  index = static_cast<int32_t>(nearest);
  return static_cast<float>(step * index) == value;
}

template <class Element>
std::vector<uint8_t> narrowTo(std::span<const uint32_t> numbers, uint32_t base) {
  std::vector<uint8_t> bytes(numbers.size() * sizeof(Element));
  for (size_t i = 0; i < numbers.size(); ++i) {
    const Element element = static_cast<Element>(numbers[i] - base);
    std::memcpy(bytes.data() + i * sizeof(Element), &element, sizeof(Element));
  }
  return bytes;
}

class ChunkPacker {
 public:
  ChunkPacker(const AssetContents& asset, const AxisSearch& axes, const ChunkContents& chunk, const std::string& place)
      : asset_(asset), axes_(axes), chunk_(chunk), place_(place) {}

  Result<RawChunk> pack() {
    raw_.counts = {chunk_.cellCount,       chunk_.liveCount,         chunk_.ghostCount, 0,
                   chunk_.lobeAxes.size(), chunk_.borderCells.size()};
    for (auto step : {&ChunkPacker::addSites, &ChunkPacker::addGraph, &ChunkPacker::addCells, &ChunkPacker::addDetails,
                      &ChunkPacker::addLobes}) {
      if (Status status = (this->*step)(); !status) return status.error();
    }
    std::erase_if(raw_.sections, [](const RawSection& section) { return section.bytes.empty(); });
    return std::move(raw_);
  }

 private:
  bool isOnLattice(SectionType type) const { return sectionKind(type, asset_.quantization) != ElementKind::kFloat; }

  Error offLattice(SectionType type, size_t number, double value) const {
    return makeError(ErrorKind::kBadInput, "%s: number %zu is %.9g, off its lattice; %s",
                     sectionPlace(place_, type).c_str(), number, value, kRemedy);
  }

  void add(SectionType type, uint32_t elementSize, std::vector<uint8_t> bytes) {
    raw_.sections.push_back({type, elementSize, 0, std::move(bytes)});
  }
  void addFloats(SectionType type, std::span<const float> numbers) { add(type, sizeof(float), bytesOf(numbers)); }

  // In the smallest elements that hold them all.
  void addNumbers(SectionType type, std::span<const uint32_t> numbers) {
    if (numbers.empty()) return;
    const auto [least, most] = std::minmax_element(numbers.begin(), numbers.end());
    const bool hasBase = sectionKind(type, asset_.quantization) == ElementKind::kUnsigned;
    const uint32_t base = hasBase ? *least : 0, range = *most - base;
    if (range <= 0xff) {
      raw_.sections.push_back({type, 1, base, narrowTo<uint8_t>(numbers, base)});
    } else if (range <= 0xffff) {
      raw_.sections.push_back({type, 2, base, narrowTo<uint16_t>(numbers, base)});
    } else {
      raw_.sections.push_back({type, 4, base, narrowTo<uint32_t>(numbers, base)});
    }
  }

  void addSigned(SectionType type, std::span<const int32_t> indices) {
    std::vector<uint32_t> elements(indices.size());
    std::transform(indices.begin(), indices.end(), elements.begin(), zigzag);
    addNumbers(type, elements);
  }

  // Indices of `numbers`; stepOf(i) is the step of number i, expected(i) is taken off its index.
  template <class StepOf, class Expected>
  Status findIndices(SectionType type, std::span<const float> numbers, StepOf stepOf, Expected expected,
                     std::vector<int32_t>& indices) const {
    indices.resize(numbers.size());
    for (size_t i = 0; i < numbers.size(); ++i) {
      if (!findIndex(numbers[i], stepOf(i), indices[i])) return offLattice(type, i, numbers[i]);
      indices[i] -= expected(i);
    }
    return {};
  }

  template <class StepOf, class Expected>
  Status addIndices(SectionType type, std::span<const float> numbers, StepOf stepOf, Expected expected) {
    std::vector<int32_t> indices;
    if (Status status = findIndices(type, numbers, stepOf, expected, indices); !status) return status;
    addSigned(type, indices);
    return {};
  }

  template <class StepOf, class Expected>
  Status addColours(SectionType type, std::span<const float> numbers, StepOf stepOf, Expected expected) {
    std::vector<int32_t> indices;
    if (Status status = findIndices(type, numbers, stepOf, expected, indices); !status) return status;
    for (size_t i = 0; i < indices.size(); i += 3) {
      const auto separated = separateGreen(indices[i], indices[i + 1], indices[i + 2]);
      std::copy(separated.begin(), separated.end(), indices.begin() + static_cast<ptrdiff_t>(i));
    }
    addSigned(type, indices);
    return {};
  }

  Status addSites() {
    const std::span<const float> numbers = floatsOf(chunk_.sites);
    const size_t own = size_t{chunk_.cellCount} * 3;
    for (const auto& [type, part] : {std::pair{SectionType::kSites, numbers.first(own)},
                                     std::pair{SectionType::kGhostSites, numbers.subspan(own)}}) {
      if (!isOnLattice(type)) {
        addFloats(type, part);
        continue;
      }
      std::vector<int32_t> indices(part.size());
      for (size_t i = 0; i < part.size(); ++i) {
        if (!findIndex(part[i], asset_.quantization.positionStep, indices[i])) return offLattice(type, i, part[i]);
      }
      add(type, sizeof(int32_t), bytesOf(std::span<const int32_t>(indices)));
    }
    if (Status status = addMantissas(SectionType::kRadii, chunk_.radii, asset_.quantization.radiusBits); !status) {
      return status;
    }
    add(SectionType::kGhostRefs, sizeof(CellRef), bytesOf(std::span<const CellRef>(chunk_.ghostRefs)));
    return {};
  }

  Status addGraph() {
    Result<PackedGraph> graph = packGraph(chunk_, asset_.hasWalkGraph);
    if (!graph) return makeError(graph.error().kind, "%s: %s", place_.c_str(), graph.error().message.c_str());
    const uint32_t elementSize = graphElementSize(chunk_);
    raw_.counts.pairs = graph->deltas.size() / elementSize;
    if (raw_.counts.pairs == 0) return {};
    add(SectionType::kGraphCounts, elementSize, std::move(graph->counts));
    add(SectionType::kGraphDeltas, elementSize, std::move(graph->deltas));
    add(SectionType::kGraphAlphaBits, 1, std::move(graph->alphaBits));
    return {};
  }

  // Floats without the mantissa's last bits.
  Status addMantissas(SectionType type, std::span<const float> numbers, uint32_t bits) {
    if (!isOnLattice(type)) {
      addFloats(type, numbers);
      return {};
    }
    std::vector<uint32_t> words(numbers.size());
    for (size_t i = 0; i < numbers.size(); ++i) {
      if (numbers[i] != floorMantissa(numbers[i], bits)) return offLattice(type, i, numbers[i]);
      words[i] = std::bit_cast<uint32_t>(numbers[i] + 0.0f) >> (23 - bits);
    }
    addNumbers(type, words);
    return {};
  }

  Status addOrientations() {
    const uint32_t bits = asset_.quantization.normalBits;
    if (!isOnLattice(SectionType::kOrientations)) {
      addFloats(SectionType::kOrientations, floatsOf(chunk_.orientations));
      return {};
    }
    std::vector<uint32_t> indices;
    for (size_t i = 0; i < chunk_.orientations.size(); ++i) {
      const auto pair = findNormalIndices(chunk_.orientations[i], bits);
      if (!pair) return offLattice(SectionType::kOrientations, i * 4, chunk_.orientations[i].x);
      indices.insert(indices.end(), pair->begin(), pair->end());
    }
    addNumbers(SectionType::kOrientations, indices);
    return {};
  }

  Status addCells() {
    if (Status status = addMantissas(SectionType::kDensities, chunk_.densities, asset_.quantization.densityBits);
        !status) {
      return status;
    }
    if (Status status = addOrientations(); !status) return status;
    for (const float number : floatsOf(chunk_.cellColours)) {
      const double byte = std::nearbyint(double{number} * 255);
      const bool isByte = byte >= 0 && byte <= 255;
      cellColours_.push_back(isByte ? static_cast<uint8_t>(byte) : uint8_t{0});
      if (colourOfByte(cellColours_.back()) != number) {
        return offLattice(SectionType::kCellColours, cellColours_.size() - 1, number);
      }
    }
    std::vector<uint8_t> elements;
    for (size_t i = 0; i < cellColours_.size(); i += 3) {
      for (const uint8_t byte : separateGreen(cellColours_[i], cellColours_[i + 1], cellColours_[i + 2])) {
        elements.push_back(byte);
      }
    }
    add(SectionType::kCellColours, 1, std::move(elements));
    addSolidBalls();
    if (Status status = addCellHeights(); !status) return status;
    add(SectionType::kBorderCells, sizeof(uint32_t), bytesOf(std::span(chunk_.borderCells)));
    add(SectionType::kBorderNumbers, sizeof(uint32_t), bytesOf(std::span(chunk_.borderNumbers)));
    return {};
  }

  Status addCellHeights() {
    return addHeights(
        SectionType::kCellHeights, chunk_.cellHeights, [&](size_t) { return asset_.quantization.heightStep; },
        [](size_t) { return 0; });
  }

  void addSolidBalls() {
    const std::span<const uint32_t> balls(chunk_.solidBalls);
    if (std::all_of(balls.begin(), balls.end(), [](uint32_t ball) { return ball == kWholeBall; })) return;
    add(SectionType::kSolidBalls, 1, bytesOf(balls));
  }

  template <class StepOf, class Expected>
  Status addHeights(SectionType type, const std::vector<float>& heights, StepOf stepOf, Expected expected) {
    if (isZero(heights)) return {};
    if (isOnLattice(type)) return addIndices(type, heights, stepOf, expected);
    addFloats(type, heights);
    return {};
  }

  // None if they are all 0. They belong to a section that lies on a lattice.
  Status addScales(SectionType type, const std::vector<uint8_t>& scales, bool hasLattice) {
    if (std::all_of(scales.begin(), scales.end(), [](uint8_t scale) { return scale == 0; })) return {};
    if (!hasLattice) {
      return makeError(ErrorKind::kBadInput, "%s: numbers without lattice have no scales; leave them out",
                       sectionPlace(place_, type).c_str());
    }
    add(type, 1, scales);
    return {};
  }

  Status addDetails() {
    const Quantization& lattices = asset_.quantization;
    if (Status status = addDetailSites(); !status) return status;
    const auto unit = [&](size_t i) { return detailUnit(lattices.heightStep, i); };
    const auto cellHeight = [&](size_t i) {
      int32_t index = 0;
      if (!chunk_.cellHeights.empty()) {
        findIndex(chunk_.cellHeights[i / asset_.detailCount], lattices.heightStep, index);
      }
      return expectedHeightIndex(index, lattices.heightStep, unit(i));
    };
    if (Status status = addHeights(SectionType::kDetailHeights, chunk_.detailHeights, unit, cellHeight); !status) {
      return status;
    }
    if (Status status = addBaseColours(); !status) return status;
    const bool hasLattices = lattices.detailSiteStep > 0 && lattices.heightStep > 0;
    return addScales(SectionType::kDetailScales, chunk_.detailScales, hasLattices);
  }

  float detailUnit(float step, size_t detail) const {
    return unitOf(step, chunk_.detailScales, detail / asset_.detailCount);
  }

  // Along u each but the first of a cell as the difference to the one before: they come in ascending order.
  Status addDetailSites() {
    const SectionType type = SectionType::kDetailSites;
    const std::span<const float> sites = floatsOf(chunk_.detailSites);
    if (isZero(sites)) return {};
    if (!isOnLattice(type)) {
      addFloats(type, sites);
      return {};
    }
    std::vector<int32_t> indices;
    const auto unit = [&](size_t i) { return detailUnit(asset_.quantization.detailSiteStep, i / 2); };
    if (Status status = findIndices(
            type, sites, unit, [](size_t) { return 0; }, indices);
        !status) {
      return status;
    }
    for (size_t detail = chunk_.detailSites.size(); detail-- > 0;) {
      if (detail % asset_.detailCount != 0) indices[2 * detail] -= indices[2 * (detail - 1)];
    }
    addSigned(type, indices);
    return {};
  }

  Status addBaseColours() {
    if (Status status = addScales(SectionType::kColourScales, chunk_.colourScales, asset_.quantization.colourStep > 0);
        !status) {
      return status;
    }
    const std::span<const float> colours = floatsOf(chunk_.baseColours);
    if (isZero(colours)) return {};
    if (!isOnLattice(SectionType::kBaseColours)) {
      addFloats(SectionType::kBaseColours, colours);
      return {};
    }
    const size_t perCell = size_t{asset_.detailCount} * 3;
    const auto unit = [&](size_t i) {
      return unitOf(asset_.quantization.colourStep, chunk_.colourScales, i / perCell);
    };
    return addColours(SectionType::kBaseColours, colours, unit, [&](size_t i) {
      return cellColours_.empty() ? 0 : expectedColourIndex(cellColours_[i / perCell * 3 + i % 3], unit(i));
    });
  }

  Status addLobes() {
    if (chunk_.lobeAxes.empty()) return {};
    const size_t details = size_t{chunk_.liveCount} * asset_.detailCount;
    if (chunk_.lobeAxes.size() < details * asset_.lobeCount) add(SectionType::kLobeCounts, 1, chunk_.lobeCounts);
    if (Status status = addAxes(); !status) return status;
    const std::span<const float> colours = floatsOf(chunk_.lobeColours);
    if (!isOnLattice(SectionType::kLobeColours)) {
      addFloats(SectionType::kLobeColours, colours);
      return {};
    }
    const std::vector<float> units = lobeUnits(asset_, chunk_);
    return addColours(
        SectionType::kLobeColours, colours, [&](size_t i) { return units[i / 3]; }, [](size_t) { return 0; });
  }

  Status addAxes() {
    if (!asset_.axisCodebook.empty()) return addLabels();
    const std::span<const float> axes = floatsOf(chunk_.lobeAxes);
    const float step = asset_.quantization.lobeAxisStep;
    if (isOnLattice(SectionType::kLobeAxes)) {
      return addIndices(
          SectionType::kLobeAxes, axes, [&](size_t) { return step; }, [](size_t) { return 0; });
    }
    addFloats(SectionType::kLobeAxes, axes);
    return {};
  }

  // Labels as differences to the label before in the same detail site, modulo the codebook's size: lobes of a
  // site come in ascending order of their labels.
  Status addLabels() {
    std::vector<uint32_t> differences, residuals;
    const uint32_t entries = static_cast<uint32_t>(asset_.axisCodebook.size());
    size_t lobe = 0;
    for (size_t detail = 0; lobe < chunk_.lobeAxes.size(); ++detail) {
      uint32_t before = 0;
      for (const size_t end = lobe + lobeCountOf(chunk_, asset_.lobeCount, detail); lobe < end; ++lobe) {
        const std::optional<AxisCode> code = axes_.find(chunk_.lobeAxes[lobe]);
        if (!code) return offLattice(SectionType::kLobeLabels, lobe, chunk_.lobeAxes[lobe].x);
        differences.push_back((code->label + entries - before) % entries);
        before = code->label;
        for (const int32_t steps : code->residual) residuals.push_back(zigzag(steps));
      }
    }
    addNumbers(SectionType::kLobeLabels, differences);
    if (std::any_of(residuals.begin(), residuals.end(), [](uint32_t r) { return r != 0; })) {
      addNumbers(SectionType::kLobeAxes, residuals);
    }
    return {};
  }

  const AssetContents& asset_;
  const AxisSearch& axes_;
  const ChunkContents& chunk_;
  const std::string& place_;
  std::vector<uint8_t> cellColours_;  // as stored
  RawChunk raw_;
};

}  // namespace

Result<RawChunk> packChunk(const AssetContents& asset, const AxisSearch& axes, const ChunkContents& chunk,
                           const std::string& place) {
  return ChunkPacker(asset, axes, chunk, place).pack();
}

}  // namespace froth
