#include "baker/lod/chunk_groups.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include <tbb/parallel_for.h>

namespace froth {
namespace {

constexpr double kFull = 0.85, kOverfull = 1.5;  // live cells of a group, of those it should have
constexpr uint64_t kApartWeight = 4;             // of pairs of neighbours across chunks that different groups made
constexpr uint32_t kNoGroupYet = 0xffffffff;

struct Edge {
  uint32_t chunk;  // place in the list
  uint64_t weight;
};
using Adjacency = std::vector<std::vector<Edge>>;  // [listed]

Adjacency countPairs(std::span<const LevelChunk> chunks, std::span<const uint32_t> listed, uint32_t cellCount) {
  std::vector<uint32_t> listedOf(cellCount, kNoGroupYet);
  for (uint32_t place = 0; place < listed.size(); ++place) {
    for (const uint32_t cell : chunks[listed[place]].planned.cells) listedOf[cell] = place;
  }
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

  std::vector<std::vector<uint32_t>> run() {
    while (const std::optional<uint32_t> seed = chooseSeed()) {
      const auto group = static_cast<uint32_t>(groups_.size());
      groups_.emplace_back();
      add(*seed, group);
      while (liveOf(group) < kFull * groupLive_) {
        const std::optional<uint32_t> next = chooseNext(group);
        if (!next) break;
        add(*next, group);
      }
      if (groups_[group].size() == 1) joinNeighbour(group);
    }
    return std::move(groups_);
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

  // A chunk that found no other goes to the neighbouring group with room that it has most in common with.
  void joinNeighbour(uint32_t last) {
    const uint32_t chunk = groups_[last].front();
    std::optional<uint32_t> best;
    uint64_t most = 0;
    for (const Edge& edge : adjacency_[chunk]) {
      const uint32_t group = groupOf_[edge.chunk];
      if (group == last || liveOf(group) + live_[chunk] > kOverfull * groupLive_) continue;
      const uint64_t weight = weightTo(chunk, group);
      if (weight > most || (weight == most && group < best)) best = group, most = weight;
    }
    if (!best) return;
    groups_.pop_back();
    add(chunk, *best);
  }

  const Adjacency& adjacency_;
  std::span<const uint32_t> live_;
  const double groupLive_;
  std::vector<uint32_t> groupOf_;  // [listed] kNoGroupYet: none yet
  std::vector<std::vector<uint32_t>> groups_;
};

}  // namespace

std::vector<std::vector<uint32_t>> groupChunks(std::span<const LevelChunk> chunks, std::span<const uint32_t> listed,
                                               uint32_t cellCount, uint64_t groupLive) {
  const Adjacency adjacency = countPairs(chunks, listed, cellCount);
  std::vector<uint32_t> live;
  for (const uint32_t chunk : listed) live.push_back(chunks[chunk].planned.liveCount);
  std::vector<std::vector<uint32_t>> groups = Grouping(adjacency, live, groupLive).run();
  for (std::vector<uint32_t>& group : groups) {
    for (uint32_t& chunk : group) chunk = listed[chunk];
    std::sort(group.begin(), group.end());
  }
  return groups;
}

}  // namespace froth
