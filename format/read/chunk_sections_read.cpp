#include "format/read/chunk_sections_read.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/float_span.h"
#include "format/chunk_lobes.h"
#include "format/graph_rows.h"
#include "format/lattice.h"

namespace froth {
namespace {

constexpr char kRemedy[] = "the file is damaged, copy it or bake the scene again";

// The raw bytes of a section as numbers.
class Elements {
 public:
  Elements() = default;
  Elements(std::vector<uint8_t> bytes, uint32_t size, uint32_t base)
      : bytes_(std::move(bytes)), size_(size), base_(base) {}

  size_t size() const { return size_ == 0 ? 0 : bytes_.size() / size_; }
  // May wrap around if the base is absurd.
  uint32_t operator[](size_t i) const {
    if (size_ == 1) return base_ + bytes_[i];
    if (size_ == 2) return base_ + elementAt<uint16_t>(i);
    return base_ + elementAt<uint32_t>(i);
  }
  std::span<const uint8_t> bytes() const { return bytes_; }

 private:
  template <class Element>
  Element elementAt(size_t i) const {
    Element element;
    std::memcpy(&element, bytes_.data() + i * sizeof(Element), sizeof(Element));
    return element;
  }

  std::vector<uint8_t> bytes_;
  uint32_t size_ = 0, base_ = 0;
};

class ChunkReader {
 public:
  ChunkReader(const Manifest& manifest, uint32_t chunk, const SectionDecoder& decode, const std::string& place)
      : asset_(manifest.contents), manifest_(manifest), index_(chunk), decode_(decode), place_(place) {
    chunk_ = asset_.chunks[chunk];
  }

  Result<CodedChunk> read(Layer last) {
    for (auto step : {&ChunkReader::readSites, &ChunkReader::readGraph, &ChunkReader::readCells}) {
      if (Status status = (this->*step)(); !status) return status.error();
    }
    if (last == Layer::kGeometry) {
      coarsen();
      return take();
    }
    if (Status status = readDetails(); !status) return status.error();
    if (last == Layer::kDetails) return take();
    if (Status status = readLobes(); !status) return status.error();
    return take();
  }

 private:
  CodedChunk take() { return {std::move(chunk_), std::move(codes_)}; }

  const SectionRecord* find(SectionType type) const { return manifest_.findSection(index_, type); }
  bool isOnLattice(SectionType type) const { return sectionKind(type, asset_.quantization) != ElementKind::kFloat; }

  Error outOfRange(SectionType type, size_t number) const {
    return makeError(ErrorKind::kBadInput, "%s: number %zu is out of range; %s", sectionPlace(place_, type).c_str(),
                     number, kRemedy);
  }

  // No elements if there is no such section.
  Status load(SectionType type, Elements& elements) const {
    const SectionRecord* record = find(type);
    if (!record) return {};
    std::vector<uint8_t> bytes(static_cast<size_t>(record->rawSize));
    if (Status status = decode_(*record, bytes); !status) return status;
    elements = Elements(std::move(bytes), record->elementSize, record->base);
    return {};
  }

  // The section's bytes are the array's. It must be a multiple of Element, which the manifest's check has
  // seen to.
  template <class Element>
  Status loadAsIs(SectionType type, std::vector<Element>& array, size_t first = 0) const {
    const SectionRecord* record = find(type);
    if (!record) return {};
    const size_t count = static_cast<size_t>(record->rawSize / sizeof(Element));
    array.resize(first + count);
    return decode_(*record, {reinterpret_cast<uint8_t*>(array.data() + first), count * sizeof(Element)});
  }

  // Numbers on a lattice: stepOf(i) is the step of number i, expected(i) was taken off its index.
  template <class Vector, class StepOf, class Expected>
  Status loadIndices(SectionType type, std::vector<Vector>& array, std::vector<int32_t>& codes, StepOf stepOf,
                     Expected expected) const {
    Elements elements;
    if (Status status = load(type, elements); !status) return status;
    array.resize(elements.size() / (sizeof(Vector) / sizeof(float)));
    codes.resize(elements.size());
    float* numbers = reinterpret_cast<float*>(array.data());
    for (size_t i = 0; i < elements.size(); ++i) {
      const int64_t index = int64_t{unzigzag(elements[i])} + expected(i);
      if (std::abs(index) > kMaxLatticeIndex) return outOfRange(type, i);
      codes[i] = static_cast<int32_t>(index);
      numbers[i] = stepOf(i) * static_cast<float>(index);
    }
    return {};
  }

  // Colours on a lattice, in steps of stepOf(i) for entry i; expected(i) was taken off the indices of that entry.
  template <class StepOf, class Expected>
  Status loadColours(SectionType type, std::vector<glm::vec3>& array, std::vector<int32_t>& codes, StepOf stepOf,
                     Expected expected) const {
    Elements elements;
    if (Status status = load(type, elements); !status) return status;
    array.resize(elements.size() / 3);
    codes.reserve(elements.size());
    for (size_t i = 0; i < array.size(); ++i) {
      const auto element = [&](size_t c) { return int64_t{unzigzag(elements[3 * i + c])}; };
      const std::array<int64_t, 3> indices = joinGreen(element(0), element(1), element(2));
      const std::array<int32_t, 3> known = expected(i);
      for (int c = 0; c < 3; ++c) {
        const int64_t index = indices[static_cast<size_t>(c)] + known[static_cast<size_t>(c)];
        if (std::abs(index) > kMaxLatticeIndex) return outOfRange(type, 3 * i);
        codes.push_back(static_cast<int32_t>(index));
        array[i][c] = stepOf(i) * static_cast<float>(index);
      }
    }
    return {};
  }

  template <class Vector>
  Status loadFloats(SectionType type, std::vector<Vector>& array, std::vector<int32_t>& codes, float step) const {
    if (!isOnLattice(type)) return loadAsIs(type, array);
    return loadIndices(
        type, array, codes, [&](size_t) { return step; }, [](size_t) { return 0; });
  }

  Status loadSites(SectionType type, size_t first) {
    if (!isOnLattice(type)) return loadAsIs(type, chunk_.sites, first);
    Elements elements;
    if (Status status = load(type, elements); !status) return status;
    chunk_.sites.resize(first + elements.size() / 3);
    float* numbers = reinterpret_cast<float*>(chunk_.sites.data() + first);
    const double step = asset_.quantization.positionStep;
    for (size_t i = 0; i < elements.size(); ++i) {
      const int32_t index = static_cast<int32_t>(elements[i]);
      if (index < -kMaxLatticeIndex || index > kMaxLatticeIndex) return outOfRange(type, i);
      numbers[i] = static_cast<float>(step * index);
    }
    return {};
  }

  // Floats without the mantissa's last bits. What is not finite, checkChunk finds.
  Status loadMantissas(SectionType type, std::vector<float>& array, uint32_t bits) const {
    if (!isOnLattice(type)) return loadAsIs(type, array);
    Elements elements;
    if (Status status = load(type, elements); !status) return status;
    array.resize(elements.size());
    for (size_t i = 0; i < elements.size(); ++i) {
      if (elements[i] >> (8 + bits) != 0) return outOfRange(type, i);
      array[i] = std::bit_cast<float>(elements[i] << (23 - bits));
    }
    return {};
  }

  Status readSites() {
    if (Status status = loadSites(SectionType::kSites, 0); !status) return status;
    if (Status status = loadSites(SectionType::kGhostSites, chunk_.cellCount); !status) return status;
    if (Status status = loadAsIs(SectionType::kGhostRefs, chunk_.ghostRefs); !status) return status;
    if (Status status = loadAsIs(SectionType::kBorderCells, chunk_.borderCells); !status) return status;
    if (Status status = loadAsIs(SectionType::kBorderNumbers, chunk_.borderNumbers); !status) return status;
    return loadMantissas(SectionType::kRadii, chunk_.radii, asset_.quantization.radiusBits);
  }

  Status readGraph() {
    if (manifest_.chunks[index_].counts.pairs == 0) {
      chunk_.neighbourOffsets.assign(size_t{chunk_.cellCount} + 1, 0);
      chunk_.alphaCounts.assign(chunk_.liveCount, 0);
      return {};
    }
    Elements counts, deltas, bits;
    if (Status status = load(SectionType::kGraphCounts, counts); !status) return status;
    if (Status status = load(SectionType::kGraphDeltas, deltas); !status) return status;
    if (Status status = load(SectionType::kGraphAlphaBits, bits); !status) return status;
    return unpackGraph({counts.bytes(), deltas.bytes(), bits.bytes()}, asset_.hasWalkGraph, chunk_, place_);
  }

  Status readOrientations() {
    const uint32_t bits = asset_.quantization.normalBits;
    if (!isOnLattice(SectionType::kOrientations)) return loadAsIs(SectionType::kOrientations, chunk_.orientations);
    Elements elements;
    if (Status status = load(SectionType::kOrientations, elements); !status) return status;
    chunk_.orientations.resize(elements.size() / 2);
    codes_.normals.reserve(elements.size() / 2);
    const uint32_t most = (1u << bits) - 2;
    for (size_t i = 0; i < chunk_.orientations.size(); ++i) {
      const std::array<uint32_t, 2> indices{elements[2 * i], elements[2 * i + 1]};
      if (indices[0] > most || indices[1] > most) return outOfRange(SectionType::kOrientations, 2 * i);
      chunk_.orientations[i] = orientationOfNormal(indices, bits);
      codes_.normals.push_back(indices);
    }
    return {};
  }

  Status readCells() {
    if (Status status = loadMantissas(SectionType::kDensities, chunk_.densities, asset_.quantization.densityBits);
        !status) {
      return status;
    }
    if (Status status = readOrientations(); !status) return status;
    if (Status status = loadAsIs(SectionType::kCellColours, cellColours_); !status) return status;
    for (std::array<uint8_t, 3>& colour : cellColours_) {
      colour = joinGreen(colour[0], colour[1], colour[2]);
      chunk_.cellColours.emplace_back(colourOfByte(colour[0]), colourOfByte(colour[1]), colourOfByte(colour[2]));
    }
    if (Status status = loadAsIs(SectionType::kSolidBalls, chunk_.solidBalls); !status) return status;
    return loadFloats(SectionType::kCellHeights, chunk_.cellHeights, cellHeights_, asset_.quantization.heightStep);
  }

  // Layer 0 alone: one detail site in the middle of the face, of the cell's colour and height.
  void coarsen() {
    chunk_.detailSites.assign(chunk_.liveCount, glm::vec2(0));
    chunk_.detailHeights = chunk_.cellHeights;
    codes_.detailHeights = std::move(cellHeights_);
    for (const glm::vec3& colour : chunk_.cellColours) chunk_.baseColours.push_back(colour - 0.5f);
  }

  Status readDetails() {
    const uint32_t count = asset_.detailCount;
    if (Status status = loadScales(SectionType::kDetailScales, chunk_.detailScales); !status) return status;
    if (Status status = readDetailSites(); !status) return status;
    chunk_.detailSites.resize(size_t{chunk_.liveCount} * count, glm::vec2(0));  // absent: all zero
    if (Status status = readDetailHeights(); !status) return status;
    return readBaseColours();
  }

  Status loadScales(SectionType type, std::vector<uint8_t>& scales) const {
    if (Status status = loadAsIs(type, scales); !status) return status;
    for (size_t cell = 0; cell < scales.size(); ++cell) {
      if (scales[cell] > kMaxScale) return outOfRange(type, cell);
    }
    return {};
  }

  // Along u each but the first of a cell as the difference to the one before.
  Status readDetailSites() {
    if (!isOnLattice(SectionType::kDetailSites)) return loadAsIs(SectionType::kDetailSites, chunk_.detailSites);
    Elements elements;
    if (Status status = load(SectionType::kDetailSites, elements); !status) return status;
    chunk_.detailSites.resize(elements.size() / 2);
    codes_.detailSites.reserve(elements.size());
    int64_t u = 0;
    for (size_t i = 0; i < chunk_.detailSites.size(); ++i) {
      if (i % asset_.detailCount == 0) u = 0;
      u += unzigzag(elements[2 * i]);
      const int64_t v = unzigzag(elements[2 * i + 1]);
      if (std::abs(u) > kMaxLatticeIndex || std::abs(v) > kMaxLatticeIndex) {
        return outOfRange(SectionType::kDetailSites, 2 * i);
      }
      codes_.detailSites.insert(codes_.detailSites.end(), {static_cast<int32_t>(u), static_cast<int32_t>(v)});
      chunk_.detailSites[i] =
          detailUnit(asset_.quantization.detailSiteStep, i) * glm::vec2(static_cast<float>(u), static_cast<float>(v));
    }
    return {};
  }

  float detailUnit(float step, size_t detail) const {
    return unitOf(step, chunk_.detailScales, detail / asset_.detailCount);
  }

  Status readDetailHeights() {
    if (!isOnLattice(SectionType::kDetailHeights)) return loadAsIs(SectionType::kDetailHeights, chunk_.detailHeights);
    const float step = asset_.quantization.heightStep;
    return loadIndices(
        SectionType::kDetailHeights, chunk_.detailHeights, codes_.detailHeights,
        [&](size_t i) { return detailUnit(step, i); },
        [&](size_t i) {
          if (cellHeights_.empty()) return 0;
          return expectedHeightIndex(cellHeights_[i / asset_.detailCount], step, detailUnit(step, i));
        });
  }

  float colourUnit(size_t detail) const {
    return unitOf(asset_.quantization.colourStep, chunk_.colourScales, detail / asset_.detailCount);
  }

  Status readBaseColours() {
    if (Status status = loadScales(SectionType::kColourScales, chunk_.colourScales); !status) return status;
    if (!isOnLattice(SectionType::kBaseColours)) return loadAsIs(SectionType::kBaseColours, chunk_.baseColours);
    return loadColours(
        SectionType::kBaseColours, chunk_.baseColours, codes_.baseColours, [&](size_t i) { return colourUnit(i); },
        [&](size_t i) {
          std::array<int32_t, 3> expected{};
          if (cellColours_.empty()) return expected;
          for (size_t c = 0; c < 3; ++c) {
            expected[c] = expectedColourIndex(cellColours_[i / asset_.detailCount][c], colourUnit(i));
          }
          return expected;
        });
  }

  Status readLobes() {
    const uint64_t lobes = manifest_.chunks[index_].counts.lobes;
    const size_t details = size_t{chunk_.liveCount} * asset_.detailCount;
    if (Status status = loadAsIs(SectionType::kLobeCounts, chunk_.lobeCounts); !status) return status;
    if (lobes == 0 && asset_.lobeCount > 0) chunk_.lobeCounts.assign(details, 0);
    if (Status status = checkLobeCounts(lobes); !status) return status;
    if (Status status =
            loadFloats(SectionType::kLobeAxes, chunk_.lobeAxes, codes_.lobeAxes, asset_.quantization.lobeAxisStep);
        !status) {
      return status;
    }
    codes_.axisStep = asset_.quantization.lobeAxisStep;
    if (!asset_.axisCodebook.empty()) {
      if (Status status = readLabels(); !status) return status;
    }
    if (!isOnLattice(SectionType::kLobeColours)) return loadAsIs(SectionType::kLobeColours, chunk_.lobeColours);
    const std::vector<float> units = lobeUnits(asset_, chunk_);
    return loadColours(
        SectionType::kLobeColours, chunk_.lobeColours, codes_.lobeColours, [&](size_t i) { return units[i]; },
        [](size_t) { return std::array<int32_t, 3>{}; });
  }

  Status checkLobeCounts(uint64_t lobes) const {
    if (chunk_.lobeCounts.empty()) return {};
    uint64_t sum = 0;
    for (const uint8_t count : chunk_.lobeCounts) sum += count;
    if (sum == lobes) return {};
    return makeError(ErrorKind::kBadInput, "%s: %llu lobes, the manifest says %llu; %s",
                     sectionPlace(place_, SectionType::kLobeCounts).c_str(), static_cast<unsigned long long>(sum),
                     static_cast<unsigned long long>(lobes), kRemedy);
  }

  // Axes as entries of the codebook, to which the axes that were read are the differences.
  Status readLabels() {
    Elements labels;
    if (Status status = load(SectionType::kLobeLabels, labels); !status) return status;
    const float differenceStep = asset_.quantization.lobeAxisStep, entryStep = manifest_.codebookStep;
    bool areCoded = entryStep > 0 && codes_.lobeAxes.size() == floatsOf(chunk_.lobeAxes).size();
    codes_.axisStep = differenceStep > 0 ? std::min(differenceStep, entryStep) : entryStep;
    chunk_.lobeAxes.resize(labels.size(), glm::vec3(0));  // absent: no differences
    codes_.lobeAxes.resize(3 * labels.size(), 0);
    const uint64_t entries = asset_.axisCodebook.size();
    size_t lobe = 0;
    for (size_t detail = 0; lobe < labels.size(); ++detail) {
      uint64_t label = 0;
      for (const size_t end = lobe + lobeCountOf(chunk_, asset_.lobeCount, detail); lobe < end; ++lobe) {
        if (labels[lobe] >= entries) return outOfRange(SectionType::kLobeLabels, lobe);
        label = (label + labels[lobe]) % entries;
        chunk_.lobeAxes[lobe] = asset_.axisCodebook[label] + chunk_.lobeAxes[lobe];
        areCoded = areCoded && codeAxis(lobe);
      }
    }
    if (!areCoded) codes_.lobeAxes.clear();
    return {};
  }

  // Both an entry and the difference to it are multiples of the step; false: their sum has no index.
  bool codeAxis(size_t lobe) {
    for (size_t c = 0; c < 3; ++c) {
      const float index = chunk_.lobeAxes[lobe][static_cast<int>(c)] / codes_.axisStep;
      if (!(std::abs(index) <= kMaxLatticeIndex)) return false;
      codes_.lobeAxes[3 * lobe + c] = static_cast<int32_t>(index);
    }
    return true;
  }

  const AssetContents& asset_;
  const Manifest& manifest_;
  uint32_t index_;
  const SectionDecoder& decode_;
  const std::string& place_;
  std::vector<std::array<uint8_t, 3>> cellColours_;  // red, green, blue
  std::vector<int32_t> cellHeights_;                 // in steps; empty: absent or floats
  ChunkContents chunk_;
  ChunkCodes codes_;
};

}  // namespace

Result<CodedChunk> unpackChunk(const Manifest& manifest, uint32_t chunk, Layer last, const SectionDecoder& decode,
                               const std::string& place) {
  return ChunkReader(manifest, chunk, decode, place).read(last);
}

}  // namespace froth
