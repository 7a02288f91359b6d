#include "measure/sweep/levels.h"

#include <utility>

#include "format/read/asset_reader.h"

namespace froth {
namespace {

// [bytes] of device memory: what the asset takes, and the hungriest of the views.
Result<uint64_t> bytesOf(const Bench& bench, const Draw& draw, const Progress& progress) {
  const Rounds once{1, 1, bench.rounds.seed};
  const Result<std::vector<DrawTimes>> times = bench.renderer.time({draw}, once, progress);
  if (!times) return times.error();
  return times->front().residentBytes;
}

}  // namespace

// The floor comes first: what chunks and views have taken they keep.
Result<std::vector<Knob>> prepareLevels(const Bench& bench, SweepReferences& references, const Progress& progress) {
  ReportConfig whole = defaultConfig();
  whole.streaming.detail = kAllCells;
  const Draw draw = drawOf(bench, whole);
  const Result<AssetReader> reader = AssetReader::open(draw.asset);
  if (!reader) return reader.error();
  if (reader->manifest().levels.empty()) return std::vector<Knob>();
  Draw floor = draw;
  floor.streaming.mostCells = 1;
  const Result<uint64_t> floorBytes = bytesOf(bench, floor, progress);
  if (!floorBytes) return floorBytes.error();
  Result<std::vector<RenderedImages>> images = bench.renderer.render(draw, progress);
  if (!images) return images.error();
  if (Status set = references.setWhole(std::move(*images)); !set) return set.error();
  const Result<uint64_t> wholeBytes = bytesOf(bench, draw, progress);
  if (!wholeBytes) return wholeBytes.error();
  return levelKnobs(*floorBytes, *wholeBytes);
}

}  // namespace froth
