#include "measure/sweep/levels.h"

#include <utility>

#include "format/read/asset_reader.h"

namespace froth {

Result<std::vector<Knob>> prepareLevels(const Bench& bench, SweepReferences& references, const Progress& progress) {
  ReportConfig whole = defaultConfig();
  whole.streaming.detail = kAllCells;
  const Draw draw = drawOf(bench, whole);
  const Result<AssetReader> reader = AssetReader::open(draw.asset);
  if (!reader) return reader.error();
  if (reader->manifest().levels.empty()) return std::vector<Knob>();
  Result<std::vector<RenderedImages>> images = bench.renderer.render(draw, progress);
  if (!images) return images.error();
  if (Status set = references.setWhole(std::move(*images)); !set) return set.error();
  const Rounds once{1, 1, bench.rounds.seed};
  const Result<std::vector<DrawTimes>> times = bench.renderer.time({draw}, once, progress);
  if (!times) return times.error();
  return levelKnobs(times->front().drawn.bytes, times->front().viewBytes);
}

}  // namespace froth
