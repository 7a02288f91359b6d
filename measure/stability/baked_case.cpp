#include "measure/stability/baked_case.h"

#include <utility>
#include <vector>

#include "baker/bake/bake.h"
#include "format/checks.h"
#include "format/read/asset_reader.h"
#include "format/write/asset_writer.h"

namespace froth {
namespace {

Result<AssetContents> readContents(const AssetInput& asset) {
  const Result<AssetReader> reader = AssetReader::openBytes(asset.bytes, "asset", static_cast<Layer>(asset.layers - 1));
  if (!reader) return reader.error();
  AssetContents contents = reader->manifest();
  for (uint32_t chunk = 0; chunk < contents.chunks.size(); ++chunk) {
    Result<ChunkContents> read = reader->readChunk(chunk);
    if (!read) return read.error();
    contents.chunks[chunk] = std::move(*read);
  }
  return contents;
}

// Cells by their place in foamFromAsset(): chunk after chunk.
CellGraph graphOf(const AssetContents& contents) {
  std::vector<uint32_t> firstOfChunk;
  uint32_t cells = 0;
  for (const ChunkContents& chunk : contents.chunks) {
    firstOfChunk.push_back(cells);
    cells += chunk.cellCount;
  }
  CellGraph graph;
  graph.offsets = {0};
  for (size_t index = 0; index < contents.chunks.size(); ++index) {
    const ChunkContents& chunk = contents.chunks[index];
    for (uint32_t cell = 0; cell < chunk.cellCount; ++cell) {
      for (uint32_t i = chunk.neighbourOffsets[cell]; i < chunk.neighbourOffsets[cell + 1]; ++i) {
        const uint32_t other = chunk.neighbours[i];
        if (other < chunk.cellCount) {
          graph.neighbours.push_back(firstOfChunk[index] + other);
        } else {
          const CellRef home = chunk.ghostRefs[other - chunk.cellCount];
          graph.neighbours.push_back(firstOfChunk[chunkOf(home, contents.localBits)] +
                                     localOf(home, contents.localBits));
        }
      }
      graph.offsets.push_back(static_cast<uint32_t>(graph.neighbours.size()));
    }
  }
  return graph;
}

}  // namespace

std::vector<PlacedFoam> placeFoams(const StiffCase& stiff, const ReferenceRenderer& renderer, const glm::dvec3& base) {
  std::vector<PlacedFoam> placed;
  for (const CasePlace& place : stiff.places) {
    PlacedFoam foam{&renderer, {}, glm::normalize(glm::dquat(place.rotation)), place.scale};
    foam.position = place.position + foam.rotation * (foam.scale * base) - base;
    placed.push_back(foam);
  }
  return placed;
}

Status bakeCase(const StiffCase& stiff, const Foam& foam, const std::string& preset, BakedCase& baked,
                const Progress& progress) {
  BakeOptions options;
  options.preset = preset;
  options.knobs = *presetKnobs(preset);
  if (stiff.chunkCells > 0) options.chunkCells = stiff.chunkCells;
  options.nearRatio = 0;
  options.measure = false;
  options.source = "stability";
  const Result<BakeResult> result = bakeFoam(foam, options, progress);
  if (!result) return result.error();
  Result<std::vector<uint8_t>> bytes = encodeAsset(result->contents);
  if (!bytes) return bytes.error();
  baked.asset.bytes = std::move(*bytes);
  baked.asset.layers = stiff.layers;
  Result<AssetContents> contents = readContents(baked.asset);
  if (!contents) return contents.error();

  const auto& origin = contents->chunks.front().origin;
  baked.base = {origin[0], origin[1], origin[2]};
  for (ChunkContents& chunk : contents->chunks) {
    for (int axis = 0; axis < 3; ++axis) chunk.origin[axis] -= baked.base[axis];
  }
  Result<Foam> decoded = foamFromAsset(*contents);
  if (!decoded) return decoded.error();
  baked.foam = std::move(*decoded);
  baked.walkGraph = graphOf(*contents);
  baked.reference = std::make_unique<ReferenceRenderer>(baked.foam);
  baked.placed = placeFoams(stiff, *baked.reference, baked.base);
  return {};
}

Result<RenderedImages> drawExactly(const BakedCase& baked, const View& view, const ReferenceOptions& options) {
  return baked.placed.empty() ? baked.reference->render(view, options) : renderMerged(baked.placed, view, options);
}

}  // namespace froth
