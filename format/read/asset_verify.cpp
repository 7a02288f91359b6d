// The checks of `froth verify` that need more than one chunk, or more time than every reader should spend.
#include <algorithm>
#include <tuple>
#include <vector>

#include "format/checks.h"
#include "format/read/asset_reader.h"
#include "format/section.h"

namespace froth {
namespace {

constexpr char kRemedy[] = "bake the scene again";

// A pair across two chunks, as one of them sees it.
struct CrossPair {
  CellRef from, to;  // own cell, cell behind the ghost
  bool isAlpha;

  CellRef least() const { return std::min(from, to); }
  CellRef most() const { return std::max(from, to); }
};

bool comesBefore(const CrossPair& a, const CrossPair& b) {
  return std::tuple(a.least(), a.most(), a.from) < std::tuple(b.least(), b.most(), b.from);
}

class Verifier {
 public:
  explicit Verifier(std::string file) : file_(std::move(file)) {}

  Status run(const AssetReader& reader) {
    localBits_ = reader.manifest().localBits;
    hasWalkGraph_ = reader.manifest().hasWalkGraph;
    const uint32_t count = static_cast<uint32_t>(reader.manifest().chunks.size());
    for (uint32_t index = 0; index < count; ++index) {
      if (Status status = addChunk(reader, index); !status) return status;
    }
    for (uint32_t index = 0; index < count; ++index) {
      if (Status status = checkGhosts(index); !status) return status;
    }
    return checkCrossPairs();
  }

 private:
  Status addChunk(const AssetReader& reader, uint32_t index) {
    Result<ChunkContents> contents = reader.readChunk(index);
    if (!contents) return contents.error();
    const Box told = reader.liveBounds(index), found = liveBoundsOf(*contents);
    if (told.min != found.min || told.max != found.max) {
      return makeError(ErrorKind::kBadInput, "%s: live_bounds are not those of its live cells; %s",
                       chunkPlace(file_, index).c_str(), kRemedy);
    }
    for (uint32_t cell = 0; cell < contents->cellCount; ++cell) {
      if (Status status = addRow(*contents, index, cell); !status) return status;
    }
    // What the other chunks' ghosts are compared with is all that is kept.
    ChunkContents& kept = chunks_.emplace_back();
    kept.origin = contents->origin;
    kept.cellCount = contents->cellCount;
    kept.liveCount = contents->liveCount;
    kept.sites = std::move(contents->sites);
    kept.radii = std::move(contents->radii);
    kept.ghostRefs = std::move(contents->ghostRefs);
    return {};
  }

  // A plane parts any two neighbours. Pairs with ghosts are kept for later.
  Status addRow(const ChunkContents& chunk, uint32_t index, uint32_t cell) {
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
        crossPairs_.push_back(
            {referenceTo(index, cell), chunk.ghostRefs[neighbour - chunk.cellCount], i - first < alphaCount});
      }
    }
    return {};
  }

  // A ghost is its cell, seen from the chunk's origin: bit for bit on a lattice, else rounded to float.
  Status checkGhosts(uint32_t index) const {
    const ChunkContents& chunk = chunks_[index];
    for (uint32_t ghost = 0; ghost < chunk.ghostRefs.size(); ++ghost) {
      const ChunkContents& other = chunks_[chunkOf(chunk.ghostRefs[ghost], localBits_)];
      const uint32_t cell = localOf(chunk.ghostRefs[ghost], localBits_), here = chunk.cellCount + ghost;
      bool isSame = chunk.radii[here] == other.radii[cell];
      for (size_t axis = 0; axis < 3; ++axis) {
        const int a = static_cast<int>(axis);
        const double site = other.origin[axis] - chunk.origin[axis] + other.sites[cell][a];
        isSame = isSame && chunk.sites[here][a] == static_cast<float>(site);
      }
      if (!isSame) {
        return makeError(ErrorKind::kBadInput, "%s: ghost %u is not where cell %u of chunk %u is, or not as large; %s",
                         chunkPlace(file_, index).c_str(), ghost, cell, chunkOf(chunk.ghostRefs[ghost], localBits_),
                         kRemedy);
      }
    }
    return {};
  }

  bool isLive(CellRef cell) const { return localOf(cell, localBits_) < chunks_[chunkOf(cell, localBits_)].liveCount; }

  // Both chunks know of a pair, and agree on alpha if both cells are live.
  Status checkCrossPairs() {
    std::sort(crossPairs_.begin(), crossPairs_.end(), comesBefore);
    for (size_t i = 0; i < crossPairs_.size(); ++i) {
      const CrossPair& pair = crossPairs_[i];
      const bool areLive = isLive(pair.from) && isLive(pair.to);
      const bool isBoth =
          i + 1 < crossPairs_.size() && crossPairs_[i + 1].from == pair.to && crossPairs_[i + 1].to == pair.from;
      if (!isBoth && (hasWalkGraph_ || areLive)) return pairError(pair, "the graph holds one direction only");
      if (!isBoth) continue;
      if (areLive && pair.isAlpha != crossPairs_[i + 1].isAlpha) {
        return pairError(pair, "the alpha-complex holds one direction only");
      }
      ++i;
    }
    return {};
  }

  CellRef referenceTo(uint32_t index, uint32_t cell) const {
    return static_cast<CellRef>((uint64_t{index} << localBits_) | cell);
  }

  Error pairError(const CrossPair& pair, const char* what) const {
    return makeError(ErrorKind::kBadInput, "%s: cell %u and cell %u of chunk %u: %s; %s",
                     chunkPlace(file_, chunkOf(pair.from, localBits_)).c_str(), localOf(pair.from, localBits_),
                     localOf(pair.to, localBits_), chunkOf(pair.to, localBits_), what, kRemedy);
  }

  std::string file_;
  uint32_t localBits_ = 32;
  bool hasWalkGraph_ = true;
  std::vector<ChunkContents> chunks_;
  std::vector<CrossPair> crossPairs_;
};

}  // namespace

Status verifyAsset(const std::filesystem::path& path) {
  Result<AssetReader> reader = AssetReader::open(path);
  if (!reader) return reader.error();
  return Verifier(path.string()).run(*reader);
}

}  // namespace froth
