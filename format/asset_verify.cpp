// The checks of `froth verify` that need the whole graph.
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <span>
#include <vector>

#include "format/asset_reader.h"
#include "format/checks.h"
#include "format/section.h"

namespace froth {
namespace {

constexpr char kRemedy[] = "bake the scene again";

// A float rounds by at most half of FLT_EPSILON, relative.
constexpr double kRounding = FLT_EPSILON / 2;

// A quaternion normalised in float: its length carries some 4 roundings and each component one or two of its
// own, so |q|^2 is off by at most about 2 * (4 + 2) of them; twice that is allowed.
constexpr double kUnitTolerance = 24 * kRounding;

// What of a chunk the graph's checks need. Rows keep their parts (alpha, others), each sorted by reference.
struct GraphChunk {
  ChunkContents contents;                 // without what only shading needs
  std::vector<CellRef> sortedNeighbours;  // rows as in contents.neighbours

  std::span<const CellRef> row(const std::vector<CellRef>& array, uint32_t cell) const {
    const uint32_t first = contents.neighbourOffsets[cell];
    return {array.data() + first, contents.neighbourOffsets[cell + 1] - first};
  }
  bool isLive(uint32_t cell) const { return cell < contents.liveCount; }
  uint32_t alphaCount(uint32_t cell) const { return isLive(cell) ? contents.alphaCounts[cell] : 0; }
  std::span<const CellRef> sortedAlpha(uint32_t cell) const {
    return row(sortedNeighbours, cell).first(alphaCount(cell));
  }
  std::span<const CellRef> sortedOthers(uint32_t cell) const {
    return row(sortedNeighbours, cell).subspan(alphaCount(cell));
  }
};

bool contains(std::span<const CellRef> sorted, CellRef cell) {
  return std::binary_search(sorted.begin(), sorted.end(), cell);
}

void dropShading(ChunkContents& chunk) {
  chunk.densities = {};
  chunk.orientations = {};
  chunk.detailSites = {};
  chunk.detailHeights = {};
  chunk.lobeAxes = {};
  chunk.lobeColours = {};
}

void sortRows(GraphChunk& chunk) {
  chunk.sortedNeighbours = chunk.contents.neighbours;
  for (uint32_t cell = 0; cell < chunk.contents.cellCount; ++cell) {
    const auto row = chunk.sortedNeighbours.begin();
    const auto first = row + chunk.contents.neighbourOffsets[cell];
    const auto middle = first + chunk.alphaCount(cell);
    std::sort(first, middle);
    std::sort(middle, row + chunk.contents.neighbourOffsets[cell + 1]);
  }
}

// The distance of the radical plane from a cell's site, and what float arithmetic may have made of it.
struct PlaneDistance {
  double distance = 0;
  double tolerance = 0;
};

class Verifier {
 public:
  explicit Verifier(std::string file) : file_(std::move(file)) {}

  Status run(const AssetReader& reader) {
    localBits_ = reader.manifest().localBits;
    hasWalkGraph_ = reader.manifest().hasWalkGraph;
    const uint32_t count = static_cast<uint32_t>(reader.manifest().chunks.size());
    for (uint32_t index = 0; index < count; ++index)
      if (Status status = addChunk(reader, index); !status) return status;
    for (uint32_t index = 0; index < count; ++index)
      for (uint32_t cell = 0; cell < chunks_[index].contents.cellCount; ++cell) {
        if (Status status = checkRow(index, cell); !status) return status;
        if (Status status = checkSymmetry(index, cell); !status) return status;
        if (Status status = checkOrder(index, cell); !status) return status;
      }
    return {};
  }

 private:
  Status addChunk(const AssetReader& reader, uint32_t index) {
    Result<ChunkContents> contents = reader.readChunk(index);
    if (!contents) return contents.error();
    for (uint32_t cell = 0; cell < contents->liveCount; ++cell) {
      const glm::dvec4 q(contents->orientations[cell]);
      if (std::abs(glm::dot(q, q) - 1) <= kUnitTolerance) continue;
      return makeError(ErrorKind::kBadInput, "%s: cell %u: quaternion of length %.9g, not 1; %s",
                       placeOf(index, SectionType::kOrientations).c_str(), cell, std::sqrt(glm::dot(q, q)),
                       kRemedy);
    }
    const Box told = reader.liveBounds(index), found = liveBoundsOf(*contents);
    if (told.min != found.min || told.max != found.max)
      return makeError(ErrorKind::kBadInput, "%s: chunk %u: live_bounds are not those of its live cells; %s",
                       file_.c_str(), index, kRemedy);
    GraphChunk chunk;
    chunk.contents = std::move(*contents);
    dropShading(chunk.contents);
    sortRows(chunk);
    chunks_.push_back(std::move(chunk));
    return {};
  }

  // No loop, no double entry, and without a walk graph nothing but alpha neighbours.
  Status checkRow(uint32_t index, uint32_t cell) const {
    const GraphChunk& chunk = chunks_[index];
    const std::span<const CellRef> alpha = chunk.sortedAlpha(cell), others = chunk.sortedOthers(cell);
    const CellRef self = referenceTo(index, cell);
    if (contains(alpha, self) || contains(others, self)) return rowError(index, cell, "is its own neighbour");
    const bool isDoubled =
        std::adjacent_find(alpha.begin(), alpha.end()) != alpha.end() ||
        std::adjacent_find(others.begin(), others.end()) != others.end() ||
        std::any_of(alpha.begin(), alpha.end(), [&](CellRef c) { return contains(others, c); });
    if (isDoubled) return rowError(index, cell, "has a neighbour twice");
    if (!hasWalkGraph_ && !others.empty())
      return rowError(index, cell, "has more than alpha neighbours, and the asset no walk graph");
    return {};
  }

  // Who is a neighbour has one; live alpha neighbours likewise.
  Status checkSymmetry(uint32_t index, uint32_t cell) const {
    const GraphChunk& chunk = chunks_[index];
    const CellRef self = referenceTo(index, cell);
    for (const bool isAlpha : {true, false})
      for (const CellRef neighbour : isAlpha ? chunk.sortedAlpha(cell) : chunk.sortedOthers(cell)) {
        const GraphChunk& other = chunks_[chunkOf(neighbour, localBits_)];
        const uint32_t local = localOf(neighbour, localBits_);
        const bool isAlphaBack = contains(other.sortedAlpha(local), self);
        if (chunk.isLive(cell) && other.isLive(local) && isAlpha != isAlphaBack)
          return pairError(index, cell, neighbour, "the alpha-complex holds one direction only");
        if (hasWalkGraph_ && !isAlphaBack && !contains(other.sortedOthers(local), self))
          return pairError(index, cell, neighbour, "the graph holds one direction only");
      }
    return {};
  }

  // Both parts of a live cell's row: nearest radical plane first.
  Status checkOrder(uint32_t index, uint32_t cell) const {
    const GraphChunk& chunk = chunks_[index];
    if (!chunk.isLive(cell)) return {};
    const std::span<const CellRef> row = chunk.row(chunk.contents.neighbours, cell);
    PlaneDistance previous;
    for (size_t i = 0; i < row.size(); ++i) {
      const PlaneDistance next = planeDistance(index, cell, row[i]);
      if (!std::isfinite(next.distance))
        return pairError(index, cell, row[i], "both sites are the same point, no plane parts them");
      const bool startsPart = i == 0 || i == chunk.alphaCount(cell);
      if (!startsPart && next.distance < previous.distance - previous.tolerance - next.tolerance)
        return pairError(index, cell, row[i], "its plane is nearer than that of the neighbour before it");
      previous = next;
    }
    return {};
  }

  // radicalOffset / |toNeighbour| (shaders/foam/cell.h). A baker may have made it in float: then the squared
  // distance carries 5 roundings and the difference of squared radii 3, their sum one more, the distance 3.5
  // and the quotient one: less than 11 in all, relative to the sum of both terms' sizes.
  PlaneDistance planeDistance(uint32_t index, uint32_t cell, CellRef neighbour) const {
    const ChunkContents& a = chunks_[index].contents;
    const ChunkContents& b = chunks_[chunkOf(neighbour, localBits_)].contents;
    const uint32_t local = localOf(neighbour, localBits_);
    glm::dvec3 toNeighbour = glm::dvec3(b.sites[local]) - glm::dvec3(a.sites[cell]);
    for (int axis = 0; axis < 3; ++axis)
      toNeighbour[axis] += b.origin[static_cast<size_t>(axis)] - a.origin[static_cast<size_t>(axis)];
    const double radius = a.radii[cell], otherRadius = b.radii[local];
    const double squares = (radius - otherRadius) * (radius + otherRadius), length = glm::length(toNeighbour);
    return {0.5 * (length + squares / length), 11 * kRounding * 0.5 * (length + std::abs(squares) / length)};
  }

  CellRef referenceTo(uint32_t index, uint32_t cell) const {
    return static_cast<CellRef>((uint64_t{index} << localBits_) | cell);
  }

  std::string placeOf(uint32_t index, SectionType type) const {
    return sectionPlace(file_, index, static_cast<uint32_t>(type));
  }

  Error rowError(uint32_t index, uint32_t cell, const char* what) const {
    return makeError(ErrorKind::kBadInput, "%s: cell %u %s; %s",
                     placeOf(index, SectionType::kNeighbours).c_str(), cell, what, kRemedy);
  }

  Error pairError(uint32_t index, uint32_t cell, CellRef neighbour, const char* what) const {
    return makeError(ErrorKind::kBadInput, "%s: cell %u and cell %u of chunk %u: %s; %s",
                     placeOf(index, SectionType::kNeighbours).c_str(), cell, localOf(neighbour, localBits_),
                     chunkOf(neighbour, localBits_), what, kRemedy);
  }

  std::string file_;
  uint32_t localBits_ = 32;
  bool hasWalkGraph_ = true;
  std::vector<GraphChunk> chunks_;
};

}  // namespace

Status verifyAsset(const std::filesystem::path& path) {
  Result<AssetReader> reader = AssetReader::open(path);
  if (!reader) return reader.error();
  return Verifier(path.string()).run(*reader);
}

}  // namespace froth
