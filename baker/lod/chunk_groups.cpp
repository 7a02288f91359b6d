#include "baker/lod/chunk_groups.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include <tbb/parallel_for.h>

namespace froth {
namespace {

constexpr double kFull = 0.85, kOverfull = 2.0;  // live cells of a group, of those it should have
constexpr uint64_t kApartWeight = 4;             // of pairs of neighbours across chunks that different groups made
constexpr double kMostLocked = 0.7;              // live cells of a group with neighbours outside of it, of all
constexpr uint32_t kNoGroupYet = 0xffffffff;

struct Edge {
  uint32_t chunk;  // place in the list
  uint64_t weight;
};
using Adjacency = std::vector<std::vector<Edge>>;  // [listed]

// The chunks to group. What follows calls them by their places in the list.
struct ListedChunks {
  ListedChunks(std::span<const LevelChunk> all, std::span<const uint32_t> listedChunks, uint32_t cellCount)
      : chunks(all), listed(listedChunks), placeOf(cellCount, kNoGroupYet) {
    for (uint32_t place = 0; place < listed.size(); ++place) {
      for (const uint32_t cell : at(place).planned.cells) placeOf[cell] = place;
    }
  }

  const LevelChunk& at(uint32_t place) const { return chunks[listed[place]]; }
  uint32_t count() const { return static_cast<uint32_t>(listed.size()); }

  std::span<const LevelChunk> chunks;
  std::span<const uint32_t> listed;
  std::vector<uint32_t> placeOf;  // [cells] of its chunk; kNoGroupYet: in none of them
};

Adjacency countPairs(const ListedChunks& list) {
  Adjacency adjacency(list.count());
  tbb::parallel_for(uint32_t{0}, list.count(), [&](uint32_t place) {
    std::vector<uint32_t> others;
    for (const uint32_t cell : list.at(place).rows.walk.neighbours) {
      if (list.placeOf[cell] != kNoGroupYet && list.placeOf[cell] != place) others.push_back(list.placeOf[cell]);
    }
    std::sort(others.begin(), others.end());
    const uint32_t maker = list.at(place).place.madeBy;
    for (auto run = others.begin(); run != others.end();) {
      const auto end = std::upper_bound(run, others.end(), *run);
      const bool isApart = maker == kNoGroup || list.at(*run).place.madeBy != maker;
      adjacency[place].push_back({*run, static_cast<uint64_t>(end - run) * (isApart ? kApartWeight : 1)});
      run = end;
    }
  });
  return adjacency;
}

class Grouping {
 public:
  Grouping(const ListedChunks& list, uint64_t groupLive)
      : list_(list),
        adjacency_(countPairs(list)),
        groupLive_(static_cast<double>(groupLive)),
        groupOf_(list.count(), kNoGroupYet) {}

  void form() {
    while (const std::optional<uint32_t> seed = chooseSeed()) {
      const auto group = static_cast<uint32_t>(groups_.size());
      groups_.emplace_back();
      add(*seed, group);
      while (liveOf(group) < kFull * groupLive_) {
        const std::optional<uint32_t> next = chooseNext(group);
        if (!next) break;
        add(*next, group);
      }
      if (groups_[group].size() == 1) dissolve(group);
    }
  }

  // Groups that were made before, of indices of chunks.
  void take(std::span<const std::vector<uint32_t>> groups) {
    for (uint32_t group = 0; group < groups.size(); ++group) {
      groups_.emplace_back();
      for (const uint32_t chunk : groups[group]) {
        const auto found = std::lower_bound(list_.listed.begin(), list_.listed.end(), chunk);
        add(static_cast<uint32_t>(found - list_.listed.begin()), group);
      }
    }
  }

  // Its chunks go to the neighbouring groups with room that they have most in common with. A chunk without one stays.
  void dissolve(uint32_t group) {
    for (const uint32_t chunk : std::exchange(groups_[group], {})) add(chunk, findNeighbour(chunk).value_or(group));
  }

  // Of a wall whose chunks lie in two sheets, say, the front one: all of its cells have neighbours in the other. The
  // most locked groups go first, and unlock others.
  void dissolveLocked() {
    std::vector<std::pair<double, uint32_t>> order(groups_.size());
    tbb::parallel_for(uint32_t{0}, static_cast<uint32_t>(order.size()), [&](uint32_t group) {
      order[group] = {-lockedShare(group), group};
    });
    std::sort(order.begin(), order.end());
    for (const auto& [negated, group] : order) {
      if (-negated > kMostLocked && lockedShare(group) > kMostLocked) dissolve(group);
    }
  }

  // Of indices of chunks, ascending.
  std::vector<std::vector<uint32_t>> collect() const {
    std::vector<std::vector<uint32_t>> groups;
    for (const std::vector<uint32_t>& places : groups_) {
      if (places.empty()) continue;
      std::vector<uint32_t>& group = groups.emplace_back();
      for (const uint32_t place : places) group.push_back(list_.listed[place]);
      std::sort(group.begin(), group.end());
    }
    return groups;
  }

 private:
  void add(uint32_t chunk, uint32_t group) {
    groupOf_[chunk] = group;
    groups_[group].push_back(chunk);
  }

  double liveOf(uint32_t group) const {
    double sum = 0;
    for (const uint32_t chunk : groups_[group]) sum += list_.at(chunk).planned.liveCount;
    return sum;
  }

  // Live cells that have neighbours outside of the group, of all.
  double lockedShare(uint32_t group) const {
    const auto isOutside = [&](uint32_t cell) {
      return list_.placeOf[cell] == kNoGroupYet || groupOf_[list_.placeOf[cell]] != group;
    };
    uint64_t live = 0, locked = 0;
    for (const uint32_t place : groups_[group]) {
      const LevelChunk& chunk = list_.at(place);
      const CellGraph& walk = chunk.rows.walk;
      live += chunk.planned.liveCount;
      for (uint32_t local = 0; local < chunk.planned.liveCount; ++local) {
        const auto first = walk.neighbours.begin() + walk.offsets[local];
        const auto last = walk.neighbours.begin() + walk.offsets[local + 1];
        locked += std::any_of(first, last, isOutside) ? 1 : 0;
      }
    }
    return live > 0 ? static_cast<double>(locked) / static_cast<double>(live) : 0;
  }

  uint64_t weightTo(uint32_t chunk, uint32_t group) const {
    uint64_t sum = 0;
    for (const Edge& edge : adjacency_[chunk]) sum += groupOf_[edge.chunk] == group ? edge.weight : 0;
    return sum;
  }

  // The one with the fewest neighbours left: a corner of what is left, so that no single chunks stay behind.
  std::optional<uint32_t> chooseSeed() const {
    std::optional<uint32_t> best;
    uint64_t least = 0;
    for (uint32_t chunk = 0; chunk < adjacency_.size(); ++chunk) {
      if (groupOf_[chunk] != kNoGroupYet) continue;
      const uint64_t weight = weightTo(chunk, kNoGroupYet);
      if (!best || weight < least) best = chunk, least = weight;
    }
    return best;
  }

  // The one of whose open neighbours the largest share lies in the group.
  std::optional<uint32_t> chooseNext(uint32_t group) const {
    std::optional<uint32_t> best;
    double most = 0;
    for (const uint32_t member : groups_[group]) {
      for (const Edge& edge : adjacency_[member]) {
        if (groupOf_[edge.chunk] != kNoGroupYet) continue;
        const auto inside = static_cast<double>(weightTo(edge.chunk, group));
        const double share = inside / (inside + static_cast<double>(weightTo(edge.chunk, kNoGroupYet)));
        if (share > most || (share == most && edge.chunk < *best)) best = edge.chunk, most = share;
      }
    }
    return best;
  }

  std::optional<uint32_t> findNeighbour(uint32_t chunk) const {
    std::optional<uint32_t> best;
    uint64_t most = 0;
    for (const Edge& edge : adjacency_[chunk]) {
      const uint32_t group = groupOf_[edge.chunk];
      if (group == groupOf_[chunk] || group == kNoGroupYet) continue;
      if (liveOf(group) + list_.at(chunk).planned.liveCount > kOverfull * groupLive_) continue;
      const uint64_t weight = weightTo(chunk, group);
      if (weight > most || (weight == most && group < best)) best = group, most = weight;
    }
    return best;
  }

  const ListedChunks& list_;
  const Adjacency adjacency_;
  const double groupLive_;
  std::vector<uint32_t> groupOf_;  // [listed] kNoGroupYet: none yet
  std::vector<std::vector<uint32_t>> groups_;
};

}  // namespace

std::vector<std::vector<uint32_t>> groupChunks(std::span<const LevelChunk> chunks, std::span<const uint32_t> listed,
                                               uint32_t cellCount, uint64_t groupLive) {
  const ListedChunks list(chunks, listed, cellCount);
  Grouping grouping(list, groupLive);
  grouping.form();
  grouping.dissolveLocked();
  return grouping.collect();
}

std::vector<std::vector<uint32_t>> dissolveGroups(std::span<const LevelChunk> chunks,
                                                  std::span<const std::vector<uint32_t>> groups,
                                                  std::span<const uint32_t> dissolved, uint32_t cellCount,
                                                  uint64_t groupLive) {
  std::vector<uint32_t> listed;
  for (const std::vector<uint32_t>& group : groups) listed.insert(listed.end(), group.begin(), group.end());
  std::sort(listed.begin(), listed.end());
  const ListedChunks list(chunks, listed, cellCount);
  Grouping grouping(list, groupLive);
  grouping.take(groups);
  for (const uint32_t group : dissolved) grouping.dissolve(group);
  return grouping.collect();
}

}  // namespace froth
