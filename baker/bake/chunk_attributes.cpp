#include "baker/bake/chunk_attributes.h"

#include <algorithm>
#include <array>

#include <tbb/parallel_for.h>

#include "baker/cells/snap_cells.h"
#include "foam/detail_colour.h"
#include "format/lattice.h"

namespace froth {
namespace {

double relativeError(float stored, float input) { return input > 0 ? stored / double{input} - 1 : stored; }

// |to - from| for unit vectors, exact for small angles.
double angleBetween(const glm::dvec3& from, const glm::dvec3& to) {
  return 2 * std::asin(std::fmin(0.5 * glm::length(to - from), 1.0));
}

// Directions from which a face is seen, in its frame (n, t, b): straight on, and three at 45 degrees.
const std::array<glm::vec3, 4> kFaceDirections = {glm::vec3(-1, 0, 0), glm::vec3(-0.70710678f, 0.70710678f, 0),
                                                  glm::vec3(-0.70710678f, -0.35355339f, 0.61237244f),
                                                  glm::vec3(-0.70710678f, -0.35355339f, -0.61237244f)};

// Mean over detail sites and directions, to a byte per channel.
glm::vec3 meanColour(const Foam& foam, uint32_t cell) {
  const FaceFrame<float> frame = faceFrame<float>(foam.orientations[cell]);
  glm::vec3 sum(0);
  for (const glm::vec3& local : kFaceDirections) {
    const glm::vec3 direction = local.x * frame.normal + local.y * frame.tangent + local.z * frame.bitangent;
    for (uint32_t k = 0; k < foam.detailCount; ++k) {
      sum += detailColour(foam, uint64_t{cell} * foam.detailCount + k, direction);
    }
  }
  const glm::vec3 mean = sum / static_cast<float>(kFaceDirections.size() * foam.detailCount);
  return glm::round(glm::clamp(mean, 0.0f, 1.0f) * 255.0f) / 255.0f;
}

bool hasVaryingLobes(const Foam& foam, uint64_t detail) {
  const LobeRange lobes = lobesOf(foam, detail);
  for (uint64_t lobe = lobes.first + 1; lobe < lobes.first + lobes.count; ++lobe) {
    if (foam.lobeColours[lobe] != foam.lobeColours[lobes.first]) return true;
  }
  return false;
}

void countLobes(const Foam& faces, ChunkContents& chunk) {
  for (size_t detail = 0; detail + 1 < faces.lobeOffsets.size(); ++detail) {
    chunk.lobeCounts.push_back(static_cast<uint8_t>(lobesOf(faces, detail).count));
  }
}

// The one colour of each detail site, as its base.
void fillPlainColours(const Foam& faces, ChunkContents& chunk) {
  const uint64_t details = uint64_t{faces.cellCount} * faces.detailCount;
  for (uint64_t detail = 0; detail < details; ++detail) {
    const LobeRange lobes = lobesOf(faces, detail);
    glm::vec3 base = faces.baseColours.empty() ? glm::vec3(0) : faces.baseColours[detail];
    if (lobes.count > 0) base += faces.lobeColours[lobes.first];
    chunk.baseColours.push_back(base);
  }
}

}  // namespace

void fillFaces(const Foam& faces, const BakeCells& cells, std::span<const uint32_t> live, const Quantization& lattices,
               ChunkContents& chunk, AttributeErrors& errors) {
  const uint32_t details = faces.detailCount;
  bool isFlat = true;
  for (size_t i = 0; i < live.size(); ++i) {
    const uint32_t cell = live[i];
    const float detailUnit = unitOf(lattices.detailSiteStep, chunk.detailScales, i);
    const float heightUnit = unitOf(lattices.heightStep, chunk.detailScales, i);
    errors.sites.add(glm::distance(glm::dvec3(cells.sites[cell]), glm::dvec3(faces.sites[i])));
    errors.radii.add(relativeError(cells.radii[cell], faces.radii[i]));
    errors.densities.add(relativeError(cells.densities[cell], faces.densities[i]));
    const SnappedFace face = snapFace(faces.orientations[i], lattices);
    errors.normals.add(angleBetween(face.from.normal, face.to.normal));
    chunk.densities.push_back(cells.densities[cell]);
    chunk.orientations.push_back(face.orientation);

    double heightSum = 0;
    for (size_t k = i * details; k < (i + 1) * details; ++k) {
      const glm::dvec2 place(faces.detailSites[k]), snapped(snapDetailSite(face, faces.detailSites[k], detailUnit));
      errors.detailSites.add(glm::distance(place.x * face.from.tangent + place.y * face.from.bitangent,
                                           snapped.x * face.to.tangent + snapped.y * face.to.bitangent));
      chunk.detailSites.emplace_back(snapped);
      const float height = snapToStep(faces.detailHeights[k], heightUnit);
      errors.detailHeights.add(double{height} - faces.detailHeights[k]);
      chunk.detailHeights.push_back(height);
      isFlat = isFlat && height == 0;
      heightSum += height;
    }
    chunk.cellHeights.push_back(snapToStep(static_cast<float>(heightSum / details), lattices.heightStep));
  }
  if (isFlat) chunk.detailHeights = chunk.cellHeights = {};
}

void fillColours(const Foam& faces, bool keepsLobes, ChunkContents& chunk) {
  chunk.cellColours.resize(faces.cellCount);
  tbb::parallel_for(0u, faces.cellCount, [&](uint32_t cell) { chunk.cellColours[cell] = meanColour(faces, cell); });
  if (!keepsLobes) return fillPlainColours(faces, chunk);
  chunk.baseColours = faces.baseColours;
  countLobes(faces, chunk);
  chunk.lobeAxes = faces.lobeAxes;
  chunk.lobeColours = faces.lobeColours;
}

bool isViewDependent(const Foam& foam) {
  const uint64_t allDetails = uint64_t{foam.cellCount} * foam.detailCount;
  for (uint64_t detail = 0; detail < allDetails; ++detail) {
    if (hasVaryingLobes(foam, detail)) return true;
  }
  return false;
}

}  // namespace froth
