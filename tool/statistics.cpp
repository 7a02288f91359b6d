#include "tool/statistics.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/text.h"
#include "format/levels.h"

namespace froth {
namespace {

struct CellCounts {
  uint64_t cells = 0, live = 0, ghosts = 0;
};

CellCounts countCells(const AssetContents& contents) {
  CellCounts counts;
  for (size_t i = 0; i < contents.chunks.size(); ++i) {
    if (!contents.levels.empty() && !isInLevel(contents.levels[i], 0)) continue;
    const ChunkContents& chunk = contents.chunks[i];
    counts.cells += chunk.cellCount;
    counts.live += chunk.liveCount;
    counts.ghosts += chunk.ghostCount;
  }
  return counts;
}

// Both ends of a pair count it.
double meanDegree(uint64_t pairs, uint64_t cells) {
  return cells > 0 ? 2.0 * static_cast<double>(pairs) / static_cast<double>(cells) : 0.0;
}

std::string describeDetails(const AssetContents& contents) {
  if (contents.lobeCount == 0) return fmt::format("{} per cell, no view dependence", contents.detailCount);
  return fmt::format("{} per cell, up to {} lobes each", contents.detailCount, contents.lobeCount);
}

std::string describeLattices(const Quantization& lattices) {
  const auto step = [](double value) {
    return value > 0 ? fmt::format("2^{:.0f}", std::log2(value)) : std::string("float");
  };
  return fmt::format(
      "positions {}, radii {} bits, densities {} bits, normals {}, detail sites {}, heights {}, colours {}, "
      "lobe axes {}",
      step(lattices.positionStep), lattices.radiusBits, lattices.densityBits,
      lattices.normalBits > 0 ? fmt::format("2 x {} bits", lattices.normalBits) : "quaternions",
      step(lattices.detailSiteStep), step(lattices.heightStep), step(lattices.colourStep), step(lattices.lobeAxisStep));
}

std::string boxText(const Box& box) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})", box.min[0], box.min[1], box.min[2],
                     box.max[0], box.max[1], box.max[2]);
}

Box boundsOf(const std::vector<Box>& boxes) {
  Box bounds = boxes.front();
  for (const Box& box : boxes) {
    for (size_t axis = 0; axis < 3; ++axis) {
      bounds.min[axis] = std::min(bounds.min[axis], box.min[axis]);
      bounds.max[axis] = std::max(bounds.max[axis], box.max[axis]);
    }
  }
  return bounds;
}

std::string describeEyes(const EyeRegion& eyes) {
  if (eyes.boxes.empty()) return "not said";
  const bool hasCameras = eyes.boxes.front().min == eyes.boxes.front().max;
  std::string text = hasCameras ? fmt::format("of {} cameras, in {}", eyes.boxes.size(), boxText(boundsOf(eyes.boxes)))
                                : fmt::format("in {}", boxText(boundsOf(eyes.boxes)));
  if (eyes.radius > 0) text = fmt::format("within {:.6g} of those {}", eyes.radius, text);
  if (eyes.meanPsnr == 0) return text;
  return text + fmt::format("; from other eyes there {:.2f} dB in the worst view, {:.2f} dB over all", eyes.worstPsnr,
                            eyes.meanPsnr);
}

nlohmann::ordered_json eyesAsJson(const EyeRegion& eyes) {
  if (eyes.boxes.empty()) return nullptr;
  nlohmann::ordered_json boxes = nlohmann::ordered_json::array();
  for (const Box& box : eyes.boxes) boxes.push_back({{"min", box.min}, {"max", box.max}});
  const auto measured = [&](double psnr) { return eyes.meanPsnr > 0 ? nlohmann::ordered_json(psnr) : nullptr; };
  return {{"boxes", boxes},
          {"radius", eyes.radius},
          {"worstPsnr", measured(eyes.worstPsnr)},
          {"meanPsnr", measured(eyes.meanPsnr)}};
}

void printErrors(const AssetContents& contents) {
  for (const AttributeError& error : contents.errors) {
    fmt::print("error             {}: rms {:.3g}, max {:.3g} ({})\n", printable(error.name), error.rms, error.max,
               printable(error.unit));
  }
  if (contents.psnr > 0) fmt::print("PSNR              {:.2f} dB on sample views\n", contents.psnr);
}

nlohmann::ordered_json errorsAsJson(const AssetContents& contents) {
  nlohmann::ordered_json errors = nlohmann::ordered_json::object();
  for (const AttributeError& error : contents.errors) {
    errors[error.name] = {{"unit", error.unit}, {"rms", error.rms}, {"max", error.max}};
  }
  return errors;
}

}  // namespace

void printStatistics(const AssetContents& contents) {
  const CellCounts counts = countCells(contents);
  const BakeStatistics& bake = contents.statistics;
  fmt::print("preset            {}, from {}\n", printable(contents.preset), printable(contents.source));
  fmt::print("cells             {} in {} chunks, {} of them live, {} Steiner; {} ghosts\n", counts.cells,
             contents.chunks.size(), counts.live, bake.steinerCells, counts.ghosts);
  fmt::print("input             {} cells; {} hidden, of these {} duplicates; {} empty; {} dead; {} unseen\n",
             bake.inputCells, bake.hiddenDropped, bake.duplicatesMerged, bake.emptyCells, bake.deadCells,
             bake.unseenCulled);
  fmt::print("detail sites      {}\n", describeDetails(contents));
  fmt::print("walk graph        {}\n",
             contents.hasWalkGraph
                 ? fmt::format("{} pairs, mean degree {:.2f}", bake.walkPairs, meanDegree(bake.walkPairs, counts.cells))
                 : "none");
  fmt::print("alpha-complex     {} pairs, mean degree {:.2f}\n", bake.alphaPairs,
             meanDegree(bake.alphaPairs, counts.live));
  fmt::print("near limits       ratio {}, depth {}\n", contents.nearRatio, contents.nearDepth);
  fmt::print("cameras           {}, {} key frames of a flight\n",
             contents.hasStartView ? "a start view" : "no start view", contents.flightPath.size());
  fmt::print("eyes              {}\n", describeEyes(contents.eyes));
  fmt::print("lattices          {}\n", describeLattices(contents.quantization));
  printErrors(contents);
}

nlohmann::ordered_json statisticsAsJson(const AssetContents& contents) {
  const CellCounts counts = countCells(contents);
  const BakeStatistics& bake = contents.statistics;
  return {{"preset", contents.preset},
          {"source", contents.source},
          {"cells", counts.cells},
          {"liveCells", counts.live},
          {"ghosts", counts.ghosts},
          {"steinerCells", bake.steinerCells},
          {"unseenCulled", bake.unseenCulled},
          {"chunks", contents.chunks.size()},
          {"detailCount", contents.detailCount},
          {"lobeCount", contents.lobeCount},
          {"hasWalkGraph", contents.hasWalkGraph},
          {"inputCells", bake.inputCells},
          {"hiddenDropped", bake.hiddenDropped},
          {"duplicatesMerged", bake.duplicatesMerged},
          {"emptyCells", bake.emptyCells},
          {"deadCells", bake.deadCells},
          {"walkPairs", bake.walkPairs},
          {"alphaPairs", bake.alphaPairs},
          {"walkDegree", meanDegree(bake.walkPairs, counts.cells)},
          {"alphaDegree", meanDegree(bake.alphaPairs, counts.live)},
          {"nearRatio", contents.nearRatio},
          {"nearDepth", contents.nearDepth},
          {"detailSharpness", contents.detailSharpness},
          {"hasStartView", contents.hasStartView},
          {"flightPath", contents.flightPath.size()},
          {"positionStep", contents.quantization.positionStep},
          {"radiusBits", contents.quantization.radiusBits},
          {"densityBits", contents.quantization.densityBits},
          {"normalBits", contents.quantization.normalBits},
          {"detailSiteStep", contents.quantization.detailSiteStep},
          {"heightStep", contents.quantization.heightStep},
          {"colourStep", contents.quantization.colourStep},
          {"lobeAxisStep", contents.quantization.lobeAxisStep},
          {"errors", errorsAsJson(contents)},
          {"eyes", eyesAsJson(contents.eyes)},
          {"psnr", contents.psnr > 0 ? nlohmann::ordered_json(contents.psnr) : nlohmann::ordered_json(nullptr)}};
}

}  // namespace froth
