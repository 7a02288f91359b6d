#include "baker/verify/cost_estimate.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <glm/glm.hpp>

#include "base/counter_random.h"
#include "foam/site_tree.h"
#include "shaders/foam/cell.h"

namespace froth {
namespace {

constexpr uint32_t kSampleRays = 512;

// The balls that are drawn, relative to the first chunk's origin; rounding to float moves them, which an estimate
// bears.
struct Balls {
  std::vector<glm::vec3> centres;
  std::vector<float> radii;
};

Balls ballsOf(const AssetContents& contents) {
  Balls balls;
  for (const ChunkContents& chunk : contents.chunks) {
    glm::dvec3 origin;
    for (size_t axis = 0; axis < 3; ++axis) {
      origin[static_cast<int>(axis)] = chunk.origin[axis] - contents.chunks[0].origin[axis];
    }
    for (uint32_t cell = 0; cell < chunk.liveCount; ++cell) {
      const uint32_t code = chunk.solidBalls.empty() ? kWholeBall : chunk.solidBalls[cell];
      const glm::vec3 place(code & 0xff, code >> 8 & 0xff, code >> 16 & 0xff);
      const float radius = chunk.radii[cell];
      balls.centres.emplace_back(origin + glm::dvec3(chunk.sites[cell] + radius / 32 * (place - 32.0f)));
      balls.radii.push_back(radius * static_cast<float>(code >> 24) / 64);
    }
  }
  return balls;
}

std::vector<glm::dvec3> eyesOf(const AssetContents& contents, const Balls& balls) {
  std::vector<glm::dvec3> eyes;
  const auto& origin = contents.chunks[0].origin;
  const auto add = [&](const StoredCamera& camera) {
    const auto& m = camera.worldFromCamera;
    eyes.emplace_back(m[3] - origin[0], m[7] - origin[1], m[11] - origin[2]);
  };
  if (contents.hasStartView) add(contents.startView);
  for (const StoredCamera& camera : contents.flightPath) add(camera);
  if (!eyes.empty()) return eyes;
  glm::dvec3 low(INFINITY), high(-INFINITY);
  for (size_t i = 0; i < balls.centres.size(); ++i) {
    low = glm::min(low, glm::dvec3(balls.centres[i]) - double{balls.radii[i]});
    high = glm::max(high, glm::dvec3(balls.centres[i]) + double{balls.radii[i]});
  }
  for (int k = 0; k < 6; ++k) {
    glm::dvec3 eye = 0.5 * (low + high);
    eye[k / 2] += (k % 2 == 0 ? 1 : -1) * glm::length(high - low);
    eyes.push_back(eye);
  }
  return eyes;
}

void countBalls(const AssetContents& contents, CostEstimate& cost) {
  const Balls balls = ballsOf(contents);
  const auto live = static_cast<uint32_t>(balls.radii.size());
  if (live == 0) return;
  const std::vector<glm::dvec3> eyes = eyesOf(contents, balls);
  std::vector<uint32_t> members(live);
  std::iota(members.begin(), members.end(), 0u);
  const SiteTree tree(balls.centres, balls.radii, std::move(members));
  const CounterRandom random(1, Purpose::kSite);
  cost.eyes = static_cast<uint32_t>(eyes.size());
  cost.rays = kSampleRays;
  for (uint32_t ray = 0; ray < kSampleRays; ++ray) {
    const glm::dvec3& eye = eyes[ray % eyes.size()];
    const glm::dvec3 towards = glm::dvec3(balls.centres[random.bits(ray) % live]) - eye;
    const double distance = glm::length(towards);
    uint32_t count = 0;
    tree.searchBallsOn(eye, distance > 0 ? towards / distance : glm::dvec3(0, 0, 1), [&](uint32_t) { ++count; });
    cost.meanBalls += static_cast<double>(count) / kSampleRays;
    cost.mostBalls = std::max(cost.mostBalls, count);
  }
}

}  // namespace

CostEstimate estimateCost(const AssetContents& contents) {
  CostEstimate cost;
  countBalls(contents, cost);
  for (const ChunkContents& chunk : contents.chunks) {
    uint64_t squares = 0;
    for (uint32_t cell = 0; cell < chunk.cellCount; ++cell) {
      const uint32_t length = chunk.neighbourOffsets[cell + 1] - chunk.neighbourOffsets[cell];
      cost.longestRow = std::max(cost.longestRow, length);
      squares += uint64_t{length} * length;
    }
    cost.squaredDegrees = std::max(cost.squaredDegrees, squares);
  }
  return cost;
}

}  // namespace froth
