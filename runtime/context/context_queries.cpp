// The calls of queries: numbers checked, defaults resolved, instances gathered.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory_resource>

#include "format/to_vector.h"
#include "runtime/context/context.h"
#include "runtime/context/info_checks.h"
#include "runtime/context/walk_limits.h"
#include "runtime/query/ray_caster.h"
#include "runtime/query/sphere_overlap.h"

namespace froth {
namespace {

constexpr float kDefaultOpacity = 0.5f;

// What one query gathers, on its stack: a dozen instances or some hundred cells. What is more is on the heap.
struct Scratch {
  std::array<std::byte, 16384> bytes;
  std::pmr::monotonic_buffer_resource memory{bytes.data(), bytes.size()};
};

bool isFinite(const double (&vector)[3]) {
  return std::isfinite(vector[0]) && std::isfinite(vector[1]) && std::isfinite(vector[2]);
}

void fromVector(const glm::dvec3& vector, double (&result)[3]) {
  for (int axis = 0; axis < 3; ++axis) result[axis] = vector[axis];
}

// The field of a ray that is out of its range; null: none.
const char* findFault(const FrothRay& ray) {
  if (!isFinite(ray.origin)) return "origin: not finite";
  if (!isFinite(ray.direction)) return "direction: not finite";
  if (toVector(ray.direction) == glm::dvec3(0)) return "direction: zero";
  if (!(ray.tMin >= 0) || !std::isfinite(ray.tMin)) return "tMin: must be finite and not negative";
  if (!(ray.tMax >= 0)) return "tMax: must not be negative; 0 is no end";
  return nullptr;
}

PlacedFoam place(const QueryFoam& foam, FrothInstance handle, const RenderInstance& placement) {
  PlacedFoam placed;
  placed.foam = &foam;
  placed.instance = handle;
  placed.position = {placement.position[0], placement.position[1], placement.position[2]};
  const auto& q = placement.rotation;
  placed.rotation = glm::mat3_cast(glm::normalize(glm::dquat(q[3], q[0], q[1], q[2])));
  placed.scale = placement.scale;
  return placed;
}

}  // namespace

std::pmr::vector<PlacedFoam> Context::gatherFoams(uint32_t& bits, std::pmr::memory_resource* memory) const {
  size_t count = 0;
  instances_.forEach([&](const Instance&) { ++count; });
  std::pmr::vector<PlacedFoam> foams(memory);
  foams.reserve(count);
  instances_.forEachNamed([&](FrothInstance handle, const Instance& instance) {
    const Asset& asset = *assets_.find(instance.asset);
    if (!asset.keepsForQueries()) return;
    if (!asset.queryFoam()) {
      bits |= FROTH_QUERY_NOT_READY;
    } else if (!asset.queryFoam()->hasWalkGraph()) {
      bits |= FROTH_QUERY_NO_WALK_GRAPH;
    } else if (asset.queryFoam()->hasLiveCells()) {
      foams.push_back(place(*asset.queryFoam(), handle, instance.placement));
    }
  });
  return foams;
}

FrothResult Context::castRays(FrothCastInfo info, std::span<const FrothRay> rays, FrothRayHit* hits) const {
  constexpr const char* kCall = "frothCastRays";
  if (info.quantile == 0) info.quantile = kDefaultQuantile;
  if (info.cutoff == 0) info.cutoff = kDefaultCutoff;
  resolveWalkLimits(info.maxSteps, info.maxNeighbours);
  if (!(info.quantile > 0 && info.quantile < 1)) {
    return messages.fail(FROTH_ERROR_ARGUMENT, kCall, "quantile: %g; must lie between 0 and 1", double{info.quantile});
  }
  if (!(info.cutoff < 1)) {
    return messages.fail(FROTH_ERROR_ARGUMENT, kCall, "cutoff: %g; must be below 1", double{info.cutoff});
  }
  for (size_t i = 0; i < rays.size(); ++i) {
    if (const char* fault = findFault(rays[i])) {
      return messages.fail(FROTH_ERROR_ARGUMENT, kCall, "rays[%zu].%s", i, fault);
    }
  }
  uint32_t bits = 0;
  Scratch scratch;
  const std::pmr::vector<PlacedFoam> foams = gatherFoams(bits, &scratch.memory);
  const double logCutoff = info.cutoff > 0 ? std::log(double{info.cutoff}) : -std::numeric_limits<double>::infinity();
  const WalkLimits limits{info.maxSteps, info.maxNeighbours};
  RayCaster caster(foams, {std::log(double{info.quantile}), logCutoff, limits, info.closestOnly != 0}, &scratch.memory);
  uint32_t allBits = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    hits[i] = caster.cast(rays[i]);
    hits[i].bits |= bits;
    allBits |= hits[i].bits;
  }
  return allBits == 0 ? FROTH_OK : FROTH_INCOMPLETE;
}

FrothResult Context::locate(FrothInstance handle, const double (&point)[3], FrothLocation& location) const {
  constexpr const char* kCall = "frothLocate";
  const Instance* instance = instances_.find(handle);
  if (!instance) {
    return messages.fail(FROTH_ERROR_HANDLE, kCall, "instance {%u, %u}: destroyed or never created", handle.index,
                         handle.generation);
  }
  if (!isFinite(point)) {
    return messages.fail(FROTH_ERROR_ARGUMENT, kCall, "point: not finite");
  }
  const Asset& asset = *assets_.find(instance->asset);
  if (!asset.keepsForQueries()) {
    return messages.fail(FROTH_ERROR_STATE, kCall, "%s: opened without queries; set FrothAssetInfo::keepForQueries",
                         asset.name().c_str());
  }
  if (!asset.queryFoam()) {
    return messages.fail(FROTH_ERROR_STATE, kCall, "%s: not loaded yet, or FAILED", asset.name().c_str());
  }
  if (!asset.queryFoam()->hasWalkGraph() || !asset.queryFoam()->hasCells()) {
    return messages.fail(FROTH_ERROR_UNSUPPORTED, kCall, "%s: no walk graph; bake the scene with one",
                         asset.name().c_str());
  }
  const PlacedFoam placed = place(*asset.queryFoam(), handle, instance->placement);
  const glm::dvec3 local = placed.assetFromWorld(toVector(point));
  const CellAddress cell = placed.foam->locate(local);
  location.chunk = cell.chunk;
  location.cell = cell.cell;
  location.isLive = cell.cell < placed.foam->chunk(cell.chunk).liveCount;
  location.power = placed.scale * placed.scale * placed.foam->powerOf(cell, local);
  return FROTH_OK;
}

FrothResult Context::overlapSphere(FrothSphere sphere, FrothContact& contact) const {
  constexpr const char* kCall = "frothOverlapSphere";
  if (sphere.opacity == 0) sphere.opacity = kDefaultOpacity;
  if (!isFinite(sphere.centre) || !(sphere.radius >= 0) || !std::isfinite(sphere.radius)) {
    return messages.fail(FROTH_ERROR_ARGUMENT, kCall, "centre, radius: not finite, or a negative radius");
  }
  if (!(sphere.opacity > 0 && sphere.opacity < 1)) {
    return messages.fail(FROTH_ERROR_ARGUMENT, kCall, "opacity: %g; must lie between 0 and 1", double{sphere.opacity});
  }
  const glm::dvec3 centre = toVector(sphere.centre);
  const double opticalDepth = -std::log1p(-double{sphere.opacity});
  double reach = sphere.radius;
  Scratch scratch;
  for (const PlacedFoam& placed : gatherFoams(contact.bits, &scratch.memory)) {
    SphereOverlap overlap(*placed.foam, placed.assetFromWorld(centre), opticalDepth, &scratch.memory);
    const auto found = overlap.findNearest(std::max(reach, 0.0) / placed.scale);
    if (!found || found->distance * placed.scale > reach) continue;
    reach = found->distance * placed.scale;
    contact.isTouching = 1;
    contact.depth = sphere.radius - reach;
    contact.instance = placed.instance;
    contact.chunk = found->cell.chunk;
    contact.cell = found->cell.cell;
    fromVector(placed.worldFromAsset(found->position), contact.position);
    const glm::dvec3 normal = placed.rotation * found->normal;
    for (int axis = 0; axis < 3; ++axis) contact.normal[axis] = static_cast<float>(normal[axis]);
  }
  return contact.bits == 0 ? FROTH_OK : FROTH_INCOMPLETE;
}

}  // namespace froth
