#include "baker/lod/fine_form.h"

#include <algorithm>

namespace froth {
namespace {

void appendRows(const CellGraph& from, CellGraph& to) {
  const auto base = static_cast<uint32_t>(to.neighbours.size());
  for (size_t row = 1; row < from.offsets.size(); ++row) to.offsets.push_back(base + from.offsets[row]);
  to.neighbours.insert(to.neighbours.end(), from.neighbours.begin(), from.neighbours.end());
}

}  // namespace

std::optional<uint32_t> FineForm::placeOf(uint32_t cell) const {
  const auto place = std::lower_bound(places.begin(), places.end(), std::pair(cell, 0u));
  if (place == places.end() || place->first != cell) return std::nullopt;
  return place->second;
}

FineForm makeFineForm(std::span<const LevelChunk> chunks, std::span<const uint32_t> group) {
  FineForm form;
  form.rows = {{{0}, {}}, {{0}, {}}};
  for (const uint32_t index : group) {
    const LevelChunk& chunk = chunks[index];
    const std::vector<uint32_t>& own = chunk.planned.cells;
    form.cells.insert(form.cells.end(), own.begin(), own.end());
    form.isLive.insert(form.isLive.end(), chunk.planned.liveCount, 1);
    form.isLive.resize(form.cells.size(), 0);
    form.liveCount += chunk.planned.liveCount;
    appendRows(chunk.rows.walk, form.rows.walk);
    appendRows(chunk.rows.alpha, form.rows.alpha);
  }
  for (uint32_t i = 0; i < form.count(); ++i) form.places.emplace_back(form.cells[i], i);
  std::sort(form.places.begin(), form.places.end());

  form.isLocked.assign(form.count(), 0);
  for (uint32_t i = 0; i < form.count(); ++i) {
    for (const uint32_t neighbour : neighboursOf(form.rows.walk, i)) {
      if (form.placeOf(neighbour)) continue;
      form.isLocked[i] = 1;
      form.ring.push_back(neighbour);
    }
    form.lockedLive += form.isLocked[i] && form.isLive[i];
  }
  std::sort(form.ring.begin(), form.ring.end());
  form.ring.erase(std::unique(form.ring.begin(), form.ring.end()), form.ring.end());
  return form;
}

}  // namespace froth
