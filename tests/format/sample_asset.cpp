#include "sample_asset.h"

#include <algorithm>
#include <random>

#include "format/checks.h"
#include "format/graph_rows.h"
#include "format/lattice.h"

namespace froth {
namespace {

constexpr Quantization kSampleQuantization = {.positionStep = 0x1p-12,
                                              .radiusBits = 9,
                                              .densityBits = 4,
                                              .normalBits = 9,
                                              .detailSiteStep = 0x1p-5f,
                                              .heightStep = 0x1p-9f,
                                              .colourStep = 0x1p-8f,
                                              .lobeAxisStep = 0x1p-4f};

// std::mt19937's sequence is fixed by the standard, that of the distributions is not.
class Random {
 public:
  float operator()() { return static_cast<float>(engine_() >> 8) * 0x1p-24f; }  // [0, 1)
  uint32_t below(uint32_t end) { return static_cast<uint32_t>(engine_() % end); }
  template <class Vector>
  void fill(std::vector<Vector>& array, size_t size, float step = 0) {
    array.resize(size);
    float* numbers = reinterpret_cast<float*>(array.data());
    for (size_t i = 0; i < size * (sizeof(Vector) / sizeof(float)); ++i) {
      numbers[i] = snapToStep((*this)() - 0.5f, step);
    }
  }

 private:
  std::mt19937 engine_{7};
};

class ChunkMaker {
 public:
  ChunkMaker(const AssetContents& asset, const SampleOptions& options, Random& random)
      : asset_(asset), options_(options), random_(random) {}

  ChunkContents make(uint32_t index) {
    chunk_.origin = {1.5 * index, -0.25 * index, 1e6};
    chunk_.cellCount = options_.cellsPerChunk;
    chunk_.liveCount = options_.cellsPerChunk - options_.cellsPerChunk / 3;
    details_ = size_t{chunk_.liveCount} * options_.detailCount;
    fillCells();
    fillDetails();
    if (options_.lobeCount > 0) fillLobes();
    return std::move(chunk_);
  }

 private:
  const Quantization& lattices() const { return asset_.quantization; }

  void fillCells() {
    random_.fill(chunk_.sites, chunk_.cellCount, static_cast<float>(lattices().positionStep));
    random_.fill(chunk_.radii, chunk_.cellCount);
    for (float& radius : chunk_.radii) radius = floorMantissa(radius + 1, lattices().radiusBits);
    random_.fill(chunk_.densities, chunk_.liveCount);
    for (float& density : chunk_.densities) density = floorMantissa(density + 2, lattices().densityBits);
    random_.fill(chunk_.orientations, chunk_.liveCount);
    for (glm::vec4& orientation : chunk_.orientations) {
      orientation = glm::normalize(orientation);
      if (options_.isQuantized) {
        orientation = orientationOfNormal(
            normalIndices({orientation.y, orientation.z, orientation.w}, lattices().normalBits), lattices().normalBits);
      }
    }
    if (!options_.hasLayers) return;
    chunk_.cellColours.resize(chunk_.liveCount);
    for (glm::vec3& colour : chunk_.cellColours) {
      for (int i = 0; i < 3; ++i) colour[i] = colourOfByte(static_cast<uint8_t>(random_.below(256)));
    }
    if (options_.hasHeights) random_.fill(chunk_.cellHeights, chunk_.liveCount, lattices().heightStep);
    for (uint32_t i = 0; i < chunk_.liveCount; ++i) chunk_.solidBalls.push_back(makeSolidBall());
    if (!options_.isQuantized) return;
    for (uint32_t i = 0; i < chunk_.liveCount; ++i) {
      chunk_.detailScales.push_back(static_cast<uint8_t>(i == 0 ? 2 : random_.below(3)));
      chunk_.colourScales.push_back(static_cast<uint8_t>(i == 0 ? 3 : random_.below(4)));
    }
  }

  void fillDetails() {
    random_.fill(chunk_.detailSites, details_, lattices().detailSiteStep);
    if (options_.hasHeights) random_.fill(chunk_.detailHeights, details_, lattices().heightStep);
    for (size_t i = 0; i < details_ && !chunk_.detailScales.empty(); ++i) {
      const float scale = unitOf(1, chunk_.detailScales, i / options_.detailCount);
      for (int axis = 0; axis < 2; ++axis) {
        chunk_.detailSites[i][axis] = snapToStep(chunk_.detailSites[i][axis], scale * lattices().detailSiteStep);
      }
      if (options_.hasHeights) {
        chunk_.detailHeights[i] = snapToStep(chunk_.detailHeights[i], scale * lattices().heightStep);
      }
    }
    if (options_.hasLayers) {
      chunk_.baseColours.resize(details_);
      for (size_t i = 0; i < details_; ++i) chunk_.baseColours[i] = makeColour(i);
    }
  }

  glm::vec3 makeColour(size_t detail) {
    const float unit = unitOf(lattices().colourStep, chunk_.colourScales, detail / options_.detailCount);
    glm::vec3 colour;
    for (int i = 0; i < 3; ++i) colour[i] = snapToStep(random_() - 0.5f, unit);
    return colour;
  }

  uint32_t makeSolidBall() {
    uint32_t bytes = 0;
    for (uint32_t shift = 0; shift < 32; shift += 8) bytes |= random_.below(kMaxSolidByte + 1) << shift;
    return bytes;
  }

  glm::vec3 makeAxis() {
    glm::vec3 axis;
    for (int i = 0; i < 3; ++i) axis[i] = snapToStep(8 * (random_() - 0.5f), lattices().lobeAxisStep);
    if (asset_.axisCodebook.empty()) return axis;
    const glm::vec3 entry = asset_.axisCodebook[random_.below(static_cast<uint32_t>(asset_.axisCodebook.size()))];
    const bool isBeside = lattices().lobeAxisStep > 0 && random_.below(4) == 0;
    return isBeside ? entry + glm::vec3(0, lattices().lobeAxisStep, 0) : entry;
  }

  void fillLobes() {
    for (size_t detail = 0; detail < details_; ++detail) {
      const uint32_t count =
          detail > 0 && options_.hasLayers ? random_.below(options_.lobeCount + 1) : options_.lobeCount;
      if (options_.hasLayers) chunk_.lobeCounts.push_back(static_cast<uint8_t>(count));
      for (uint32_t lobe = 0; lobe < count; ++lobe) {
        chunk_.lobeAxes.push_back(makeAxis());
        chunk_.lobeColours.push_back(makeColour(detail));
      }
    }
    if (chunk_.lobeAxes.size() == details_ * options_.lobeCount) chunk_.lobeCounts.clear();
  }

  const AssetContents& asset_;
  const SampleOptions& options_;
  Random& random_;
  size_t details_ = 0;
  ChunkContents chunk_;
};

CellRef referenceTo(const AssetContents& asset, uint32_t chunk, uint32_t cell) {
  return static_cast<CellRef>((uint64_t{chunk} << asset.localBits) | cell);
}

// All cells of all other chunks.
void addGhosts(AssetContents& asset, uint32_t index) {
  ChunkContents& chunk = asset.chunks[index];
  for (uint32_t other = 0; other < asset.chunks.size(); ++other) {
    if (other == index) continue;
    const ChunkContents& source = asset.chunks[other];
    for (uint32_t cell = 0; cell < source.cellCount; ++cell, ++chunk.ghostCount) {
      chunk.ghostRefs.push_back(referenceTo(asset, other, cell));
      glm::vec3 site;
      for (size_t axis = 0; axis < 3; ++axis) {
        const int a = static_cast<int>(axis);
        site[a] = static_cast<float>(source.origin[axis] - chunk.origin[axis] + source.sites[cell][a]);
      }
      chunk.sites.push_back(site);
      chunk.radii.push_back(source.radii[cell]);
    }
  }
}

// A cell's number among all cells of the asset tells which pairs are alpha neighbours.
void fillGraph(AssetContents& asset, uint32_t index) {
  ChunkContents& chunk = asset.chunks[index];
  const uint32_t perChunk = chunk.cellCount, siteCount = chunk.cellCount + chunk.ghostCount;
  const auto numberOf = [&](uint32_t site) {
    if (site < chunk.cellCount) return index * perChunk + site;
    const CellRef ref = chunk.ghostRefs[site - chunk.cellCount];
    return chunkOf(ref, asset.localBits) * perChunk + localOf(ref, asset.localBits);
  };
  chunk.neighbourOffsets.assign(1, 0);
  for (uint32_t cell = 0; cell < chunk.cellCount; ++cell) {
    const bool isLive = cell < chunk.liveCount;
    const auto isAlpha = [&](uint32_t site) { return isLive && (numberOf(cell) + numberOf(site)) % 2 == 1; };
    for (const bool wanted : {true, false}) {
      for (uint32_t site = 0; site < siteCount; ++site) {
        if (site != cell && isAlpha(site) == wanted && (wanted || asset.hasWalkGraph)) chunk.neighbours.push_back(site);
      }
    }
    chunk.neighbourOffsets.push_back(static_cast<uint32_t>(chunk.neighbours.size()));
    uint32_t alphaCount = 0;
    for (uint32_t site = 0; site < siteCount; ++site) alphaCount += site != cell && isAlpha(site) ? 1 : 0;
    if (isLive) chunk.alphaCounts.push_back(alphaCount);
  }
  sortGraphRows(chunk, 0, chunk.cellCount);
}

}  // namespace

AssetContents makeSampleAsset(const SampleOptions& options) {
  AssetContents asset;
  asset.detailCount = options.detailCount;
  asset.lobeCount = options.lobeCount;
  asset.localBits = options.localBits;
  asset.hasWalkGraph = options.hasWalkGraph;
  asset.detailSharpness = 9.5f;
  asset.nearRatio = 3.0f;
  asset.nearDepth = 0.25f;
  asset.source = "sample";
  asset.statistics = {100, 7, 2, 3, 4, 5, 6, 50, 25};
  asset.errors = {{"sites", "scene units", 0.25, 0.5}, {"radii", "relative", 0.125, 1}};
  asset.psnr = 42.5;
  if (options.isQuantized) asset.quantization = kSampleQuantization;
  asset.hasStartView = true;
  asset.startView.worldFromCamera = {1, 0, 0, 0.1, 0, 1, 0, 0.2, 0, 0, 1, -3};
  asset.flightPath.assign(2, asset.startView);
  asset.flightPath[1].tanHalfFovY = 0.75;
  asset.eyes = {.boxes = {{{-1, -2, -3}, {1, 2, 3}}, {{4, 5, 6}, {4, 5, 6}}},
                .radius = 0.75,
                .worstPsnr = 38.25,
                .meanPsnr = 40.5};
  Random random;
  random.fill(asset.axisCodebook, options.codebookSize, 0x1p-10f);
  for (uint32_t index = 0; index < options.chunkCount; ++index) {
    asset.chunks.push_back(ChunkMaker(asset, options, random).make(index));
  }
  for (uint32_t index = 0; index < options.chunkCount; ++index) {
    addGhosts(asset, index);
    fillGraph(asset, index);
  }
  return asset;
}

}  // namespace froth
