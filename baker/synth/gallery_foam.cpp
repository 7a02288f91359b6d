// From the gallery's surfaces to cells: sites spread over every solid, a face tangent to it, detail sites
// over the cell's patch of the face, heights and colours fitted to the analytic surface under it.
#include "baker/synth/gallery_foam.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <tbb/parallel_for.h>
#include <glm/gtc/quaternion.hpp>

#include "baker/synth/appearance_fit.h"
#include "baker/synth/gallery_scene.h"
#include "foam/cech_pairs.h"
#include "foam/cell_graph.h"
#include "shaders/foam/cell.h"

namespace froth {

using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

namespace {

constexpr double kDetailSharpness = 10;
constexpr double kOpticalRadius = 40;    // density * radius: opaque within a few percent of the radius
constexpr double kContactMargin = 0.25;  // [spacings] sites this close to another solid would cut it

struct PlacedSites {
  std::vector<SurfaceSite> sites;
  std::vector<uint32_t> solids;  // [sites] index into the scene's solids
};

bool isWall(const Solid& solid) { return solid.shape->boundingRadius() == kNoHit; }

// Where a solid stands on a floor or hangs on a wall, the wall gets a mirror image q' of each of the solid's
// lowest sites q, so that their radical plane bisects the corner. Otherwise cells of the one reach past it
// into the other.
//
//   solid |
//         |q
//     ____|__q'____ wall
void addSeam(const Solid& wall, const std::vector<SurfaceSite>& sites, std::vector<SurfaceSite>& wallSites) {
  constexpr double kUpright = 0.3;     // cosine between the normals of solid and wall
  constexpr double kTolerance = 1e-3;  // [scene units]
  for (const SurfaceSite& q : sites) {
    const double height = wall.shape->distance(q.position);
    if (height <= 0 || height > q.radius) continue;
    const SurfacePoint foot = wall.shape->nearest(q.position);
    if (std::abs(glm::dot(foot.normal, q.normal)) > kUpright) continue;
    const double reach = wall.shape->intersect({q.position, -foot.normal}, 0);
    if (std::abs(reach - height) > kTolerance) continue;  // that face belongs to another solid
    const SurfacePoint mirrored = wall.shape->nearest(q.position + height * (q.normal - foot.normal));
    if (!galleryScene().isCovered(mirrored.position, mirrored.normal, wall, 0.5 * height)) {
      wallSites.push_back({mirrored.position, mirrored.normal, mirrored.tangent, q.radius});
    }
  }
}

PlacedSites placeAllSites(double spacing, uint64_t seed) {
  const std::vector<Solid>& solids = galleryScene().solids();
  std::vector<std::vector<SurfaceSite>> perSolid(solids.size());
  tbb::parallel_for(size_t{0}, solids.size(), [&](size_t s) {
    const double own = spacing * solids[s].spacingFactor;
    solids[s].shape->placeSites(own, CounterRandom(seed, Purpose::kSurface, s), perSolid[s]);
    std::erase_if(perSolid[s], [&](const SurfaceSite& site) {
      return galleryScene().isCovered(site.position, site.normal, solids[s],
                                      kContactMargin * std::min(own, site.radius));
    });
  });
  for (size_t wall = 0; wall < solids.size(); ++wall) {
    if (!isWall(solids[wall])) continue;
    for (size_t s = 0; s < solids.size(); ++s) {
      if (!isWall(solids[s])) addSeam(solids[wall], perSolid[s], perSolid[wall]);
    }
  }
  PlacedSites placed;
  for (size_t s = 0; s < solids.size(); ++s) {
    placed.sites.insert(placed.sites.end(), perSolid[s].begin(), perSolid[s].end());
    placed.solids.resize(placed.sites.size(), static_cast<uint32_t>(s));
  }
  return placed;
}

// The densest placing of at most `cellCount` sites, to within half a percent where whole rows allow it; empty
// if there is none. Bisection, between the spacings that fit and those that do not.
PlacedSites placeAtMost(uint32_t cellCount, uint64_t seed) {
  constexpr int kRounds = 14;
  constexpr double kClose = 0.995, kBeyond = 1.02;
  PlacedSites best;
  best.sites.reserve(cellCount);  // refuses here what memory cannot hold
  double spacing = 17.0 / std::sqrt(cellCount), fitting = 0, failing = 0;
  for (int round = 0; round < kRounds && best.sites.size() < kClose * cellCount; ++round) {
    PlacedSites placed = placeAllSites(spacing, seed);
    const double ratio = static_cast<double>(placed.sites.size()) / cellCount;
    (ratio <= 1 ? fitting : failing) = spacing;
    if (ratio <= 1 && placed.sites.size() > best.sites.size()) best = std::move(placed);
    const double guess = spacing * std::sqrt(ratio);
    spacing =
        fitting > 0 && failing > 0 ? std::sqrt(fitting * failing) : (ratio <= 1 ? guess / kBeyond : guess * kBeyond);
  }
  return best;
}

Foam makeCells(const PlacedSites& placed, uint32_t detailCount, uint32_t lobeCount) {
  Foam foam;
  foam.cellCount = static_cast<uint32_t>(placed.sites.size());
  foam.detailCount = detailCount;
  foam.lobeCount = lobeCount;
  for (const SurfaceSite& site : placed.sites) {
    const glm::dmat3 rows(site.normal, site.tangent, glm::cross(site.normal, site.tangent));
    const glm::dquat q = glm::normalize(glm::quat_cast(glm::transpose(rows)));
    foam.sites.emplace_back(site.position);
    foam.radii.push_back(static_cast<float>(site.radius));
    foam.densities.push_back(static_cast<float>(kOpticalRadius / site.radius));
    foam.orientations.emplace_back(q.w, q.x, q.y, q.z);
  }
  const size_t details = size_t{foam.cellCount} * detailCount;
  foam.detailSites.resize(details);
  foam.detailHeights.resize(details);
  foam.lobeAxes.resize(details * lobeCount);
  foam.lobeColours.resize(details * lobeCount);
  return foam;
}

// Places where cameras may stand: what the fit of glossy colours looks from.
std::vector<dvec3> sampleEyes() {
  constexpr int kEyes = 48;
  const CounterRandom random(0, Purpose::kEye);
  std::vector<dvec3> eyes;
  for (uint64_t i = 0; i < kEyes; ++i) {
    eyes.emplace_back(random.uniform(3 * i, 2.0, 6.4), random.uniform(3 * i + 1, 1.8, 4.4),
                      random.uniform(3 * i + 2, 1.0, 2.1));
  }
  return eyes;
}

std::vector<SeenColour> lookAtPoint(const LitPoint& point) {
  static const std::vector<dvec3> eyes = sampleEyes();
  constexpr uint64_t kElsewhere = 32;
  constexpr double kElsewhereWeight = 0.15;
  const CounterRandom random(0, Purpose::kDirection);
  std::vector<SeenColour> seen;
  const auto add = [&](const dvec3& direction, double weight) {
    if (glm::dot(direction, point.normal) < -0.05) seen.push_back({direction, displayColour(point, direction), weight});
  };
  for (const dvec3& eye : eyes) add(glm::normalize(point.position - eye), 1);
  for (uint64_t i = 0; i < kElsewhere; ++i) {
    const dvec3 direction = random.direction(i);
    add(glm::dot(direction, point.normal) < 0 ? direction : -direction, kElsewhereWeight);
  }
  return seen;
}

// Writes the lobes of one detail site. `shift` is what sharpening adds to every colour.
void writeLobes(const LitPoint& point, const dvec3& plainColour, const dvec3& shift, std::span<glm::vec3> axes,
                std::span<glm::vec3> colours) {
  if (point.reflectance == dvec3(0)) {
    std::fill(axes.begin(), axes.end(), glm::vec3(-0.01 * point.normal));
    std::fill(colours.begin(), colours.end(), glm::vec3(plainColour + shift - 0.5));
    return;
  }
  const std::vector<SeenColour> seen = lookAtPoint(point);
  const std::vector<dvec3> chosen = chooseLobeAxes(seen, static_cast<uint32_t>(axes.size()));
  const std::vector<dvec3> fitted = fitLobeColours(chosen, seen);
  for (size_t m = 0; m < axes.size(); ++m) {
    axes[m] = chosen[m];
    colours[m] = fitted[m] + shift;
  }
}

class CellFitter {
 public:
  CellFitter(Foam& foam, const std::vector<uint32_t>& solids, const CellGraph& pairs)
      : foam_(foam), solids_(solids), pairs_(pairs) {}

  void fit(uint32_t cell) {
    const Solid& solid = galleryScene().solids()[solids_[cell]];
    const FaceFrame<double> frame = faceFrame<double>(foam_.orientations[cell]);
    const dvec3 centre = foam_.sites[cell];
    const double radius = foam_.radii[cell];
    const FacePatch patch = spreadDetails(cutsOfFace(cell, frame), foam_.detailCount);

    const auto surfacePoint = [&](const dvec2& x, double& height) {
      const dvec3 onFace = centre + radius * (x.x * frame.tangent + x.y * frame.bitangent);
      height = heightAlongNormal(solid, onFace, frame.normal);
      return lightPoint(solid, onFace + height * frame.normal);
    };
    // The colour varies over the face mostly as it does seen from the middle of the room.
    const dvec3 usual = glm::normalize(centre - dvec3(0.5, 0.5, 0.48) * kRoomSize);
    std::vector<dvec4> samples;
    for (const dvec2& x : patch.samples) {
      double height;
      const LitPoint point = surfacePoint(x, height);
      samples.emplace_back(displayColour(point, usual), height / radius);
    }
    const std::vector<dvec4> values = fitDetailValues(patch, samples, kDetailSharpness);
    for (uint32_t k = 0; k < foam_.detailCount; ++k) {
      const size_t detail = size_t{cell} * foam_.detailCount + k;
      double height;
      const LitPoint point = surfacePoint(patch.details[k], height);
      const dvec3 plain = displayColour(point, usual);
      foam_.detailSites[detail] = patch.details[k];
      foam_.detailHeights[detail] = static_cast<float>(std::clamp(values[k].w, -kMaxHeight, kMaxHeight));
      const size_t firstLobe = detail * foam_.lobeCount;
      writeLobes(point, plain, dvec3(values[k]) - plain, std::span(foam_.lobeAxes).subspan(firstLobe, foam_.lobeCount),
                 std::span(foam_.lobeColours).subspan(firstLobe, foam_.lobeCount));
    }
  }

 private:
  static constexpr double kMaxHeight = 0.6;  // [radii] beyond it the ball would cut the surface

  std::vector<dvec3> cutsOfFace(uint32_t cell, const FaceFrame<double>& frame) const {
    std::vector<dvec3> cuts;
    const double radius = foam_.radii[cell];
    for (uint32_t k = pairs_.offsets[cell]; k < pairs_.offsets[cell + 1]; ++k) {
      const uint32_t other = pairs_.neighbours[k];
      const dvec3 toOther = dvec3(foam_.sites[other]) - dvec3(foam_.sites[cell]);
      const double offset = foam::radicalOffset(toOther, radius, static_cast<double>(foam_.radii[other]));
      cuts.emplace_back(glm::dot(toOther, frame.tangent), glm::dot(toOther, frame.bitangent), offset / radius);
    }
    return cuts;
  }

  Foam& foam_;
  const std::vector<uint32_t>& solids_;
  const CellGraph& pairs_;
};

}  // namespace

Result<Foam> synthesizeGallery(const GallerySize& size, uint64_t seed, const Progress& progress) {
  const PlacedSites placed = placeAtMost(size.cells, seed);
  if (placed.sites.empty()) {
    return makeError(ErrorKind::kUsage,
                     "gallery: %u cells do not cover its thin parts; ask for more (the default is 200000)", size.cells);
  }
  Foam foam = makeCells(placed, size.detailSites, size.lobes);
  const CellGraph pairs = findCechPairs(foam.sites, foam.radii);
  CellFitter fitter(foam, placed.solids, pairs);
  constexpr uint32_t kReports = 100;
  const uint32_t step = foam.cellCount / kReports + 1;
  for (uint32_t begin = 0; begin < foam.cellCount; begin += step) {
    if (!report(progress, "fitting cells", begin, foam.cellCount)) {
      return makeError(ErrorKind::kCancelled, "synthesis of the gallery was stopped");
    }
    tbb::parallel_for(begin, std::min(begin + step, foam.cellCount), [&](uint32_t cell) { fitter.fit(cell); });
  }
  return foam;
}

}  // namespace froth
