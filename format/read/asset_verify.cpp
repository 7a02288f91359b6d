// The checks of `froth verify` that need more than one chunk, or more time than every reader should spend.
#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <tuple>
#include <vector>

#include "format/checks.h"
#include "format/level_checks.h"
#include "format/levels.h"
#include "format/read/asset_reader.h"
#include "format/section.h"

namespace froth {
namespace {

constexpr char kRemedy[] = "bake the scene again";

using ull = unsigned long long;

// A cell of some chunk.
struct CellPlace {
  uint32_t chunk, local;

  auto operator<=>(const CellPlace&) const = default;
};

// A pair across two chunks, as one of them sees it.
struct CrossPair {
  CellPlace from, to;  // own cell, cell behind the ghost
  bool isAlpha;

  CellPlace least() const { return std::min(from, to); }
  CellPlace most() const { return std::max(from, to); }
};

bool comesBefore(const CrossPair& a, const CrossPair& b) {
  return std::tuple(a.least(), a.most(), a.from) < std::tuple(b.least(), b.most(), b.from);
}

// What is kept of a chunk to compare it with others.
struct KeptChunk {
  struct Pair {
    uint32_t cell, ghost;
    bool isAlpha;
  };
  ChunkContents contents;        // counts, sites, radii, ghostRefs, borders
  std::vector<Pair> crossPairs;  // of its cells with its ghosts
};

class Verifier {
 public:
  explicit Verifier(const AssetReader& reader, std::string file)
      : file_(std::move(file)), reader_(reader), asset_(reader.manifest()) {}

  Status run() {
    for (uint32_t index = 0; index < asset_.chunks.size(); ++index) {
      if (Status status = addChunk(index); !status) return status;
    }
    if (asset_.levels.empty()) {
      std::vector<uint32_t> all(chunks_.size());
      std::iota(all.begin(), all.end(), 0u);
      return checkLevel(all);
    }
    if (Status status = checkBorders(); !status) return status;
    for (uint32_t level = 0; level < countLevels(asset_.levels); ++level) {
      std::vector<uint32_t> drawn;
      for (uint32_t index = 0; index < chunks_.size(); ++index) {
        if (isInLevel(asset_.levels[index], level)) drawn.push_back(index);
      }
      if (Status status = findHolders(drawn, level); !status) return status;
      if (Status status = checkLevel(drawn); !status) return status;
    }
    return checkGroups();
  }

 private:
  Status addChunk(uint32_t index) {
    Result<ChunkContents> contents = reader_.readChunk(index);
    if (!contents) return contents.error();
    const Box told = reader_.liveBounds(index), found = liveBoundsOf(*contents);
    if (told.min != found.min || told.max != found.max) {
      return makeError(ErrorKind::kBadInput, "%s: live_bounds are not those of its live cells; %s",
                       chunkPlace(file_, index).c_str(), kRemedy);
    }
    KeptChunk& kept = chunks_.emplace_back();
    for (uint32_t cell = 0; cell < contents->cellCount; ++cell) {
      if (Status status = addRow(*contents, index, cell, kept); !status) return status;
    }
    kept.contents.origin = contents->origin;
    kept.contents.cellCount = contents->cellCount;
    kept.contents.liveCount = contents->liveCount;
    kept.contents.sites = std::move(contents->sites);
    kept.contents.radii = std::move(contents->radii);
    kept.contents.ghostRefs = std::move(contents->ghostRefs);
    kept.contents.borderCells = std::move(contents->borderCells);
    kept.contents.borderNumbers = std::move(contents->borderNumbers);
    return {};
  }

  // A plane parts any two neighbours. Pairs with ghosts are kept for later.
  Status addRow(const ChunkContents& chunk, uint32_t index, uint32_t cell, KeptChunk& kept) const {
    const uint32_t first = chunk.neighbourOffsets[cell], last = chunk.neighbourOffsets[cell + 1];
    const uint32_t alphaCount = cell < chunk.liveCount ? chunk.alphaCounts[cell] : 0;
    for (uint32_t i = first; i < last; ++i) {
      const uint32_t neighbour = chunk.neighbours[i];
      if (chunk.sites[neighbour] == chunk.sites[cell]) {
        return makeError(ErrorKind::kBadInput,
                         "%s: cell %u and its neighbour %u are the same point, no plane parts them; %s",
                         chunkPlace(file_, index).c_str(), cell, neighbour, kRemedy);
      }
      if (neighbour >= chunk.cellCount) {
        kept.crossPairs.push_back({cell, neighbour - chunk.cellCount, i - first < alphaCount});
      }
    }
    return {};
  }

  const ChunkContents& chunk(uint32_t index) const { return chunks_[index].contents; }

  // Of the chunks that are whole together: ghosts are their cells, and pairs are known to both.
  Status checkLevel(const std::vector<uint32_t>& drawn) const {
    for (const uint32_t index : drawn) {
      if (Status status = checkGhosts(index); !status) return status;
    }
    return checkCrossPairs(drawn);
  }

  // The cell behind a ghost; with levels, in the level that findHolders has seen last.
  CellPlace cellBehind(uint32_t index, uint32_t ghost) const {
    const CellRef ref = chunk(index).ghostRefs[ghost];
    if (!asset_.levels.empty()) return holders_[ref];
    return {chunkOf(ref, asset_.localBits), localOf(ref, asset_.localBits)};
  }

  // Bit for bit on a lattice, else rounded to float.
  bool isSameBall(uint32_t index, uint32_t site, CellPlace cell) const {
    const ChunkContents &here = chunk(index), &there = chunk(cell.chunk);
    bool isSame = here.radii[site] == there.radii[cell.local];
    for (size_t axis = 0; axis < 3; ++axis) {
      const int a = static_cast<int>(axis);
      const double position = there.origin[axis] - here.origin[axis] + there.sites[cell.local][a];
      isSame = isSame && here.sites[site][a] == static_cast<float>(position);
    }
    return isSame;
  }

  // A ghost is its cell, seen from the chunk's origin.
  Status checkGhosts(uint32_t index) const {
    for (uint32_t ghost = 0; ghost < chunk(index).ghostRefs.size(); ++ghost) {
      const CellPlace cell = cellBehind(index, ghost);
      if (cell.chunk == kNoChunk) {
        return makeError(ErrorKind::kBadInput, "%s: ghost %u is border %u, which no chunk of its level holds; %s",
                         chunkPlace(file_, index).c_str(), ghost, chunk(index).ghostRefs[ghost], kRemedy);
      }
      if (!isSameBall(index, chunk(index).cellCount + ghost, cell)) {
        return makeError(ErrorKind::kBadInput, "%s: ghost %u is not where cell %u of chunk %u is, or not as large; %s",
                         chunkPlace(file_, index).c_str(), ghost, cell.local, cell.chunk, kRemedy);
      }
    }
    return {};
  }

  bool isLive(CellPlace cell) const { return cell.local < chunk(cell.chunk).liveCount; }

  // Both chunks know of a pair, and agree on alpha if both cells are live.
  Status checkCrossPairs(const std::vector<uint32_t>& drawn) const {
    std::vector<CrossPair> pairs;
    for (const uint32_t index : drawn) {
      for (const KeptChunk::Pair& pair : chunks_[index].crossPairs) {
        pairs.push_back({{index, pair.cell}, cellBehind(index, pair.ghost), pair.isAlpha});
      }
    }
    std::sort(pairs.begin(), pairs.end(), comesBefore);
    for (size_t i = 0; i < pairs.size(); ++i) {
      const CrossPair& pair = pairs[i];
      const bool areLive = isLive(pair.from) && isLive(pair.to);
      const bool isBoth = i + 1 < pairs.size() && pairs[i + 1].from == pair.to && pairs[i + 1].to == pair.from;
      if (!isBoth && (asset_.hasWalkGraph || areLive)) return pairError(pair, "the graph holds one direction only");
      if (!isBoth) continue;
      if (areLive && pair.isAlpha != pairs[i + 1].isAlpha) {
        return pairError(pair, "the alpha-complex holds one direction only");
      }
      ++i;
    }
    return {};
  }

  // Every border is held by a chunk, and is the same ball in all that hold it.
  Status checkBorders() {
    holders_.assign(asset_.borderCount, kNowhere);
    for (uint32_t index = 0; index < chunks_.size(); ++index) {
      const ChunkContents& own = chunk(index);
      for (size_t i = 0; i < own.borderCells.size(); ++i) {
        CellPlace& first = holders_[own.borderNumbers[i]];
        if (first.chunk == kNoChunk) first = {index, own.borderCells[i]};
        if (isSameBall(index, own.borderCells[i], first)) continue;
        return makeError(ErrorKind::kBadInput,
                         "%s: border %u, cell %u, is not where cell %u of chunk %u is, or not as large; %s",
                         chunkPlace(file_, index).c_str(), own.borderNumbers[i], own.borderCells[i], first.local,
                         first.chunk, kRemedy);
      }
    }
    const auto unheld = std::find(holders_.begin(), holders_.end(), kNowhere);
    if (unheld == holders_.end()) return {};
    return makeError(ErrorKind::kBadInput, "%s: border %llu is in no chunk; %s", file_.c_str(),
                     static_cast<ull>(unheld - holders_.begin()), kRemedy);
  }

  // Where the borders are in one level.
  Status findHolders(const std::vector<uint32_t>& drawn, uint32_t level) {
    holders_.assign(asset_.borderCount, kNowhere);
    for (const uint32_t index : drawn) {
      const ChunkContents& own = chunk(index);
      for (size_t i = 0; i < own.borderCells.size(); ++i) {
        CellPlace& holder = holders_[own.borderNumbers[i]];
        if (holder.chunk != kNoChunk) {
          return makeError(ErrorKind::kBadInput, "%s: border %u stands in chunk %u too, both are drawn at level %u; %s",
                           chunkPlace(file_, index).c_str(), own.borderNumbers[i], holder.chunk, level, kRemedy);
        }
        holder = {index, own.borderCells[i]};
      }
    }
    return {};
  }

  // Pairs of borders, sorted, between a form of a group and what is outside.
  using BorderPairs = std::vector<std::pair<uint32_t, uint32_t>>;
  BorderPairs outerPairs(const std::vector<uint32_t>& form) const {
    std::vector<uint32_t> inside;
    for (const uint32_t index : form) {
      const std::vector<uint32_t>& numbers = chunk(index).borderNumbers;
      inside.insert(inside.end(), numbers.begin(), numbers.end());
    }
    std::sort(inside.begin(), inside.end());
    BorderPairs pairs;
    for (const uint32_t index : form) {
      const ChunkContents& own = chunk(index);
      for (const KeptChunk::Pair& pair : chunks_[index].crossPairs) {
        const uint32_t ghost = own.ghostRefs[pair.ghost];
        const auto at = std::lower_bound(own.borderCells.begin(), own.borderCells.end(), pair.cell);
        const bool isBorder = at != own.borderCells.end() && *at == pair.cell;
        if (!isBorder || std::binary_search(inside.begin(), inside.end(), ghost)) continue;
        pairs.emplace_back(own.borderNumbers[static_cast<size_t>(at - own.borderCells.begin())], ghost);
      }
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
  }

  // Both forms of a group have the same pairs with cells outside, so either fits to its surroundings; and its ball
  // holds their live cells.
  Status checkGroups() const {
    std::vector<std::vector<uint32_t>> fine(asset_.groups.size()), coarse(asset_.groups.size());
    for (uint32_t index = 0; index < chunks_.size(); ++index) {
      const ChunkLevel& level = asset_.levels[index];
      if (level.in != kNoGroup) fine[level.in].push_back(index);
      if (level.madeBy != kNoGroup) coarse[level.madeBy].push_back(index);
      for (const uint32_t group : {level.in, level.madeBy}) {
        if (Status status = checkBall(index, group); !status) return status;
      }
    }
    for (uint32_t group = 0; group < asset_.groups.size(); ++group) {
      const BorderPairs finePairs = outerPairs(fine[group]), coarsePairs = outerPairs(coarse[group]);
      if (finePairs == coarsePairs) continue;
      BorderPairs differing;
      std::set_symmetric_difference(finePairs.begin(), finePairs.end(), coarsePairs.begin(), coarsePairs.end(),
                                    std::back_inserter(differing));
      return makeError(ErrorKind::kBadInput,
                       "%s: group %u: borders %u and %u are neighbours in one of its forms only, %zu such pairs; %s",
                       file_.c_str(), group, differing.front().first, differing.front().second, differing.size(),
                       kRemedy);
    }
    return {};
  }

  Status checkBall(uint32_t index, uint32_t group) const {
    if (group == kNoGroup) return {};
    const ChunkContents& own = chunk(index);
    for (uint32_t cell = 0; cell < own.liveCount; ++cell) {
      std::array<double, 3> centre = own.origin;
      for (size_t axis = 0; axis < 3; ++axis) centre[axis] += own.sites[cell][static_cast<int>(axis)];
      if (isBallWithin(centre, own.radii[cell], asset_.groups[group])) continue;
      return makeError(ErrorKind::kBadInput, "%s: the ball of live cell %u sticks out of that of group %u; %s",
                       chunkPlace(file_, index).c_str(), cell, group, kRemedy);
    }
    return {};
  }

  Error pairError(const CrossPair& pair, const char* what) const {
    return makeError(ErrorKind::kBadInput, "%s: cell %u and cell %u of chunk %u: %s; %s",
                     chunkPlace(file_, pair.from.chunk).c_str(), pair.from.local, pair.to.local, pair.to.chunk, what,
                     kRemedy);
  }

  static constexpr uint32_t kNoChunk = 0xffffffff;
  static constexpr CellPlace kNowhere = {kNoChunk, 0};

  std::string file_;
  const AssetReader& reader_;
  const AssetContents& asset_;
  std::vector<KeptChunk> chunks_;
  std::vector<CellPlace> holders_;  // [borderCount] with levels
};

}  // namespace

Status verifyAsset(const std::filesystem::path& path) {
  Result<AssetReader> reader = AssetReader::open(path);
  if (!reader) return reader.error();
  return Verifier(*reader, path.string()).run();
}

}  // namespace froth
