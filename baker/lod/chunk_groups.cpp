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

// [cells] the place of its chunk in the list; kNoGroupYet: in none of them.
std::vector<uint32_t> findPlaces(std::span<const LevelChunk> chunks, std::span<const uint32_t> listed,
                                 uint32_t cellCount) {
  std::vector<uint32_t> listedOf(cellCount, kNoGroupYet);
  for (uint32_t place = 0; place < listed.size(); ++place) {
    for (const uint32_t cell : chunks[listed[place]].planned.cells) listedOf[cell] = place;
  }
  return listedOf;
}

Adjacency countPairs(std::span<const LevelChunk> chunks, std::span<const uint32_t> listed,
                     std::span<const uint32_t> listedOf) {
  Adjacency adjacency(listed.size());
  tbb::parallel_for(size_t{0}, listed.size(), [&](size_t place) {
    std::vector<uint32_t> others;
    for (const uint32_t cell : chunks[listed[place]].rows.walk.neighbours) {
      if (listedOf[cell] != kNoGroupYet && listedOf[cell] != place) others.push_back(listedOf[cell]);
    }
    std::sort(others.begin(), others.end());
    const uint32_t maker = chunks[listed[place]].place.madeBy;
    for (auto run = others.begin(); run != others.end();) {
      const auto end = std::upper_bound(run, others.end(), *run);
      const bool isApart = maker == kNoGroup || chunks[listed[*run]].place.madeBy != maker;
      adjacency[place].push_back({*run, static_cast<uint64_t>(end - run) * (isApart ? kApartWeight : 1)});
      run = end;
    }
  });
  return adjacency;
}

class Grouping {
 public:
  // `live`: of each chunk.
  Grouping(const Adjacency& adjacency, std::span<const uint32_t> live, uint64_t groupLive)
      : adjacency_(adjacency),
        live_(live),
        groupLive_(static_cast<double>(groupLive)),
        groupOf_(adjacency.size(), kNoGroupYet) {}

  const std::vector<std::vector<uint32_t>>& groups() const { return groups_; }
  uint32_t groupOf(uint32_t chunk) const { return groupOf_[chunk]; }

  void run() {
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

  // Its chunks go to the neighbouring groups with room that they have most in common with. A chunk without one stays.
  void dissolve(uint32_t group) {
    for (const uint32_t chunk : std::exchange(groups_[group], {})) add(chunk, findNeighbour(chunk).value_or(group));
  }

  void dropEmpty() {
    std::erase_if(groups_, [](const auto& group) { return group.empty(); });
  }

 private:
  void add(uint32_t chunk, uint32_t group) {
    groupOf_[chunk] = group;
    groups_[group].push_back(chunk);
  }

  double liveOf(uint32_t group) const {
    double sum = 0;
    for (const uint32_t chunk : groups_[group]) sum += live_[chunk];
    return sum;
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
      if (liveOf(group) + live_[chunk] > kOverfull * groupLive_) continue;
      const uint64_t weight = weightTo(chunk, group);
      if (weight > most || (weight == most && group < best)) best = group, most = weight;
    }
    return best;
  }

  const Adjacency& adjacency_;
  std::span<const uint32_t> live_;
  const double groupLive_;
  std::vector<uint32_t> groupOf_;  // [listed] kNoGroupYet: none yet
  std::vector<std::vector<uint32_t>> groups_;
};

// Live cells of a group that have neighbours outside of it, of all.
double lockedShare(std::span<const LevelChunk> chunks, std::span<const uint32_t> listed,
                   std::span<const uint32_t> listedOf, const Grouping& grouping, uint32_t group) {
  const auto isOutside = [&](uint32_t cell) {
    return listedOf[cell] == kNoGroupYet || grouping.groupOf(listedOf[cell]) != group;
  };
  uint64_t live = 0, locked = 0;
  for (const uint32_t place : grouping.groups()[group]) {
    const LevelChunk& chunk = chunks[listed[place]];
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

// Of a wall whose chunks lie in two sheets, say, the front one: all of its cells have neighbours in the other. The most
// locked groups go first, and unlock others.
void dissolveLocked(std::span<const LevelChunk> chunks, std::span<const uint32_t> listed,
                    std::span<const uint32_t> listedOf, Grouping& grouping) {
  const auto share = [&](uint32_t group) { return lockedShare(chunks, listed, listedOf, grouping, group); };
  std::vector<std::pair<double, uint32_t>> order(grouping.groups().size());
  tbb::parallel_for(size_t{0}, order.size(), [&](size_t group) {
    order[group] = {-share(static_cast<uint32_t>(group)), static_cast<uint32_t>(group)};
  });
  std::sort(order.begin(), order.end());
  for (const auto& [negated, group] : order) {
    if (-negated > kMostLocked && share(group) > kMostLocked) grouping.dissolve(group);
  }
  grouping.dropEmpty();
}

}  // namespace

std::vector<std::vector<uint32_t>> groupChunks(std::span<const LevelChunk> chunks, std::span<const uint32_t> listed,
                                               uint32_t cellCount, uint64_t groupLive) {
  const std::vector<uint32_t> listedOf = findPlaces(chunks, listed, cellCount);
  const Adjacency adjacency = countPairs(chunks, listed, listedOf);
  std::vector<uint32_t> live;
  for (const uint32_t chunk : listed) live.push_back(chunks[chunk].planned.liveCount);
  Grouping grouping(adjacency, live, groupLive);
  grouping.run();
  dissolveLocked(chunks, listed, listedOf, grouping);
  std::vector<std::vector<uint32_t>> groups = grouping.groups();
  for (std::vector<uint32_t>& group : groups) {
    for (uint32_t& chunk : group) chunk = listed[chunk];
    std::sort(group.begin(), group.end());
  }
  return groups;
}

}  // namespace froth
