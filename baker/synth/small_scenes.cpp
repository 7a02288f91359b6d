#include "baker/synth/small_scenes.h"

#include <cmath>

#include <glm/gtc/quaternion.hpp>

#include "baker/synth/analytic_shapes.h"
#include "base/counter_random.h"

namespace froth {

using glm::dvec3;

namespace {

Foam emptyFoam(uint32_t cells, uint32_t details, uint32_t lobes) {
  Foam foam;
  foam.cellCount = cells;
  foam.detailCount = details;
  foam.lobeCount = lobes;
  const size_t n = cells, nk = n * details, nkm = nk * lobes;
  foam.sites.resize(n);
  foam.radii.assign(n, 0.5f);
  foam.densities.assign(n, 10.0f);
  foam.orientations.assign(n, {1, 0, 0, 0});
  foam.detailSites.assign(nk, glm::vec2(0));
  foam.detailHeights.assign(nk, 0);
  foam.lobeAxes.assign(nkm, glm::vec3(0, 0, 1));
  foam.lobeColours.assign(nkm, glm::vec3(0));
  return foam;
}

glm::vec4 orientationFacing(const dvec3& normal) {
  const glm::dmat3 around = frameAround(normal);
  const glm::dmat3 rows(normal, around[0], around[1]);
  const glm::dquat q = glm::normalize(glm::quat_cast(glm::transpose(rows)));
  return {q.w, q.x, q.y, q.z};
}

Error stopped(const SynthOptions& options) {
  return makeError(ErrorKind::kCancelled, "synthesis of '%s' was stopped", options.name.c_str());
}

// Spreads detail sites over the face and gives lobes random axes and colours, alike for all random scenes.
// Returns false if asked to stop.
bool randomizeAppearance(Foam& foam, uint64_t seed, double relief, double hottest, const Progress& progress) {
  const CounterRandom detail(seed, Purpose::kDetail), height(seed, Purpose::kHeight), axis(seed, Purpose::kAxis),
      temperature(seed, Purpose::kTemperature), colour(seed, Purpose::kColour);
  constexpr size_t kReports = 100;
  const size_t details = foam.detailSites.size(), step = details / kReports + 1;
  for (size_t i = 0; i < details; ++i) {
    if (i % step == 0 && !report(progress, "detail sites", i, details)) return false;
    const double radius = 0.8 * std::sqrt(detail.uniform(2 * i)),
                 angle = detail.uniform(2 * i + 1, 0, 2 * glm::pi<double>());
    foam.detailSites[i] = radius * glm::dvec2(std::cos(angle), std::sin(angle));
    foam.detailHeights[i] = static_cast<float>(height.uniform(i, -relief, relief));
    for (size_t lobe = i * foam.lobeCount; lobe < (i + 1) * foam.lobeCount; ++lobe) {
      foam.lobeAxes[lobe] = axis.direction(lobe) * temperature.uniform(lobe, 0.1, hottest);
      for (int channel = 0; channel < 3; ++channel) {
        foam.lobeColours[lobe][channel] =
            static_cast<float>(colour.uniform(3 * lobe + static_cast<uint64_t>(channel), -0.5, 0.5));
      }
    }
  }
  return true;
}

Status requireCount(const SynthOptions& options, uint32_t count) {
  if (options.cellCount == 0 || options.cellCount == count) return {};
  return makeError(ErrorKind::kUsage, "scene '%s' has %u cells, not %u; leave the count out", options.name.c_str(),
                   count, options.cellCount);
}

}  // namespace

Result<Foam> synthesizeOne(const SynthOptions& options) {
  if (const Status counted = requireCount(options, 1); !counted) return counted.error();
  Foam foam = emptyFoam(1, 1, 1);
  foam.sites[0] = {0, 0, 2};
  foam.orientations[0] = orientationFacing({0, 0, -1});
  foam.lobeColours[0] = {0.3f, 0.0f, -0.3f};
  return foam;
}

Result<Foam> synthesizeTwo(const SynthOptions& options) {
  if (const Status counted = requireCount(options, 2); !counted) return counted.error();
  Foam foam = emptyFoam(2, 1, 1);
  for (size_t i = 0; i < 2; ++i) {
    const float side = i == 0 ? -1.0f : 1.0f;
    foam.sites[i] = {0.3f * side, 0, 2};
    foam.orientations[i] = orientationFacing({0, 0, -1});
    foam.lobeColours[i] = {0.3f * side, 0.1f, -0.3f * side};
  }
  return foam;
}

Result<Foam> synthesizeGrid(const SynthOptions& options, const Progress& progress) {
  const auto side = options.cellCount ? static_cast<uint32_t>(std::lround(std::cbrt(options.cellCount))) : 4u;
  if (options.cellCount && uint64_t{side} * side * side != options.cellCount) {
    return makeError(ErrorKind::kUsage, "scene 'grid': %u cells are no cube; ask for %u", options.cellCount,
                     std::max(1u, side * side * side));
  }
  Foam foam = emptyFoam(side * side * side, 2, 2);
  const CounterRandom frame(options.seed, Purpose::kFrame), density(options.seed, Purpose::kDensity);
  const dvec3 origin(-0.5 * (side - 1), -0.5 * (side - 1), 2 + 0.5 * (side + 1));
  for (uint32_t i = 0; i < foam.cellCount; ++i) {
    foam.sites[i] = origin + dvec3(i % side, i / side % side, i / side / side);
    foam.radii[i] = 0.7f;
    foam.orientations[i] = orientationFacing(frame.direction(i));
    foam.densities[i] = static_cast<float>(density.uniform(i, 0.2, 20));
  }
  if (!randomizeAppearance(foam, options.seed, 0.2, 3, progress)) return stopped(options);
  return foam;
}

Result<Foam> synthesizeShell(const SynthOptions& options, const Progress& progress) {
  constexpr double kRadius = 2;
  constexpr uint32_t kDefault = 1000, kFewest = 12;
  const uint32_t count = options.cellCount ? options.cellCount : kDefault;
  if (count < kFewest) {
    return makeError(ErrorKind::kUsage, "scene 'shell': %u cells; a sphere needs at least %u", count, kFewest);
  }
  std::vector<SurfaceSite> sites;
  sites.reserve(count);  // refuses here what memory cannot hold
  const double spacing = std::sqrt(4 * glm::pi<double>() * kRadius * kRadius / count);
  Sphere(dvec3(0), kRadius).placeSites(spacing, CounterRandom(options.seed, Purpose::kSite), sites);
  Foam foam = emptyFoam(static_cast<uint32_t>(sites.size()), 4, 2);
  for (size_t i = 0; i < sites.size(); ++i) {
    foam.sites[i] = sites[i].position;
    foam.radii[i] = static_cast<float>(sites[i].radius);
    foam.densities[i] = static_cast<float>(20 / sites[i].radius);
    foam.orientations[i] = orientationFacing(-sites[i].normal);
  }
  if (!randomizeAppearance(foam, options.seed, 0.1, 2, progress)) return stopped(options);
  return foam;
}

Result<Foam> synthesizeRandom(const SynthOptions& options, const Progress& progress) {
  constexpr uint32_t kDefault = 500;
  const uint32_t count = options.cellCount ? options.cellCount : kDefault;
  Foam foam = emptyFoam(count, 8, 8);
  const CounterRandom site(options.seed, Purpose::kSite), radius(options.seed, Purpose::kRadius),
      density(options.seed, Purpose::kDensity), frame(options.seed, Purpose::kFrame);
  const double spacing = 2 / std::cbrt(count);
  for (uint64_t i = 0; i < count; ++i) {
    foam.sites[i] = dvec3(site.uniform(3 * i, -1, 1), site.uniform(3 * i + 1, -1, 1), site.uniform(3 * i + 2, 2, 4));
    foam.radii[i] = static_cast<float>(spacing * radius.uniform(i, 0.4, 1.1));
    const double draw = density.uniform(i);
    foam.densities[i] = draw < 0.1 ? 0.0f : static_cast<float>(std::exp(8 * draw - 2));
    foam.orientations[i] = orientationFacing(frame.direction(i));
  }
  if (!randomizeAppearance(foam, options.seed, 0.3, 6, progress)) return stopped(options);
  return foam;
}

}  // namespace froth
