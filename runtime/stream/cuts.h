// Cuts that draw available chunks only. What is available is the caller's word: resident, or not failed. The floor must
// be, whatever the caller says of it.
//
// Call a cut whole if every chunk that it draws is available. Of two whole cuts A and B, the union and the intersection
// are whole: a chunk drawn by the union is in a group of A, say, and made by none of A, so A draws it; a chunk drawn by
// the intersection is in a group of both and not made by one of A, say, so A draws it. Hence there is one greatest
// whole cut inside a given set, and one least between two sets: the results do not depend on the order of the steps.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/stream/group_set.h"

namespace froth {

// The greatest whole cut inside a cut. A chunk that `cut` draws and that is not available is drawn by each smaller cut
// that refines the group it is in; so that group goes, and with it all that is finer.
template <class IsAvailable>
void shrinkToWhole(const LevelGraph& graph, const IsAvailable& isAvailable, GroupSet& cut,
                   std::vector<uint32_t>& dropped) {
  const auto drop = [&](uint32_t group) {
    if (cut.drop(group)) dropped.push_back(group);
  };
  for (const uint32_t group : cut.members()) {
    if (!cut.contains(group)) continue;
    for (const uint32_t chunk : graph.fineOf(group)) {
      if (!isAvailable(chunk) && isDrawnIn(cut, graph.chunk(chunk))) drop(group);
    }
    while (!dropped.empty()) {
      const uint32_t last = dropped.back();
      dropped.pop_back();
      for (const uint32_t finer : graph.finerThan(last)) drop(finer);
      for (const uint32_t chunk : graph.coarseOf(last)) {
        if (graph.chunk(chunk).in != kNoGroup && !isAvailable(chunk)) drop(graph.chunk(chunk).in);
      }
    }
  }
  cut.compact();
}

// The least whole cut that holds `cut`; there must be one. A chunk that `cut` draws and that is not available is drawn
// by each larger cut that does not refine the group that made it; so that group comes in, and with it all that is
// coarser.
template <class IsAvailable>
void growToWhole(const LevelGraph& graph, const IsAvailable& isAvailable, GroupSet& cut) {
  for (size_t i = 0; i < cut.members().size(); ++i) {
    const uint32_t group = cut.members()[i];
    for (const uint32_t coarser : graph.coarserThan(group)) cut.add(coarser);
    for (const uint32_t chunk : graph.fineOf(group)) {
      const uint32_t maker = graph.chunk(chunk).madeBy;
      if (maker != kNoGroup && !isAvailable(chunk)) cut.add(maker);
    }
  }
}

}  // namespace froth
