#include "baker/steiner/empty_balls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>

#include <tbb/parallel_for.h>

#include "baker/counter_random.h"
#include "shaders/foam/cell.h"

namespace froth {
namespace {

constexpr size_t kRaysPerBlock = 64;
constexpr uint32_t kMaxStretches = 256;  // of one ray; grazing rays see no more

// Sizes. A cell's neighbours grow with the square of how much larger it is than what lies around it, and a step costs its
// neighbours. So a ball may touch cells up to kTouchingRatio times smaller; farther out it is kGrading of its distance, which
// leaves room for smaller ones between, and every ball has neighbours of about its own size.
constexpr double kTouchingRatio = 16;
constexpr double kGrading = 0.3;
constexpr double kLeastRatio = 1.5;  // to the nearest cell's radius; smaller ones add more steps than they save

// The gap that keeps a Steiner ball out of the alpha-complex. With f = r / c < 1 the radical plane passes a ball of radius R
// at distance c by at least c^2 (1 - f^2) / (2 (R + c)). The alpha-complex takes a plane for a cut within R 2^-35 (its
// slacks, doubled), so c >= 2^-13 R suffices at 1 - f^2 >= 2^-6, with room to spare.
constexpr double kFilling = 1 - 0x1p-7;
constexpr double kLeastClearance = 0x1p-13;  // of the largest radius

constexpr double kSpacing = 0.9;  // distance of two sites over the sum of their radii
constexpr double kOpaque = 6.9;   // optical depth at which a walk ends

class EmptyBallFinder {
 public:
  EmptyBallFinder(const BallTree& tree, std::span<const glm::vec3> sites, std::span<const float> radii,
                  std::span<const float> densities, const SteinerOptions& options)
      : tree_(tree), sites_(sites), radii_(radii), densities_(densities), options_(options),
        extent_(glm::length(tree.high() - tree.low())),
        leastClearance_(kLeastClearance * *std::max_element(radii.begin(), radii.end())) {
    for (const glm::vec3& site : sites) {
      low_ = glm::min(low_, site);
      high_ = glm::max(high_, site);
    }
  }

  void alongRay(const WalkRay& ray, uint64_t stream, std::vector<EmptyBall>& found) const {
    const CounterRandom random(options_.seed, Purpose::kSite);
    const glm::dvec3 origin(ray.origin), direction(ray.direction);
    const double end = extent_ + distanceToScene(origin);
    double t = 0, opticalDepth = 0;
    for (uint32_t i = 0; i < kMaxStretches && t < end && opticalDepth < kOpaque; ++i) {
      const glm::dvec3 point = origin + t * direction;
      const BallTree::Nearest nearest = tree_.nearestSurface(point);
      const double radius = radii_[nearest.ball];
      if (nearest.value > 0) {
        if (nearest.value > kShortest * radius)
          addBall(point + random.uniform(stream * kMaxStretches + i) * nearest.value * direction, found);
        t += std::max(nearest.value, kShortest * radius);
      } else {
        const double chord = throughBall(point, direction, nearest.ball);
        const glm::vec3 centre = sites_[nearest.ball] - ray.origin;
        const bool isMet = !foam::isNearCell(centre, radii_[nearest.ball], ray.forward, ray.nearRatio, ray.nearDepth);
        if (isMet) opticalDepth += kSolidShare * densities_[nearest.ball] * chord;
        t += chord + kThinnest * radius;
      }
    }
  }

 private:
  static constexpr double kShortest = 0.25;   // of the nearest ball's radius: shorter stretches are passed over
  static constexpr double kThinnest = 0.01;   // of a radius: a step past the far side of a ball
  static constexpr double kSolidShare = 0.5;  // of a ball lies behind its face

  double distanceToScene(const glm::dvec3& point) const {
    return glm::length(glm::max(glm::max(tree_.low() - point, point - tree_.high()), glm::dvec3(0)));
  }

  // How far it is to the far side of a ball.
  double throughBall(const glm::dvec3& point, const glm::dvec3& direction, uint32_t ball) const {
    double tNear, tFar;
    const bool isHit = foam::intersectBall(glm::dvec3(sites_[ball]) - point, double{radii_[ball]}, direction, tNear, tFar);
    return isHit ? tFar : 0.0;
  }

  void addBall(const glm::dvec3& point, std::vector<EmptyBall>& found) const {
    const glm::vec3 site(snapToStep(point.x, options_.positionStep), snapToStep(point.y, options_.positionStep),
                         snapToStep(point.z, options_.positionStep));
    if (site != glm::clamp(site, low_, high_)) return;
    const BallTree::Nearest nearest = tree_.nearestSurface(site);
    const double clearance = nearest.value, neighbour = radii_[nearest.ball];
    if (!(clearance >= leastClearance_)) return;
    const double wanted = std::min(kFilling * clearance, std::max(kTouchingRatio * neighbour, kGrading * clearance));
    const float radius = floorMantissa(static_cast<float>(wanted), options_.radiusBits);
    if (radius >= kLeastRatio * neighbour) found.push_back({site, radius});
  }

  const BallTree& tree_;
  std::span<const glm::vec3> sites_;
  std::span<const float> radii_, densities_;
  const SteinerOptions& options_;
  double extent_, leastClearance_;
  glm::vec3 low_{INFINITY}, high_{-INFINITY};  // of the sites: the asset's position lattice reaches no farther
};

// Kept balls on one hashed grid per power of two of their radius.
class KeptBalls {
 public:
  bool isCrowded(const EmptyBall& ball) const {
    for (const auto& [exponent, grid] : grids_) {
      const double edge = std::ldexp(2.0, exponent), reach = kSpacing * (ball.radius + 0.5 * edge);
      const glm::i64vec3 first(glm::floor((glm::dvec3(ball.site) - reach) / edge));
      const glm::i64vec3 last(glm::floor((glm::dvec3(ball.site) + reach) / edge));
      for (int64_t z = first.z; z <= last.z; ++z)
        for (int64_t y = first.y; y <= last.y; ++y)
          for (int64_t x = first.x; x <= last.x; ++x)
            if (isCrowdedIn(grid, {x, y, z}, ball)) return true;
    }
    return false;
  }

  void add(const EmptyBall& ball) {
    const int exponent = static_cast<int>(std::ceil(std::log2(ball.radius)));
    const glm::i64vec3 place(glm::floor(glm::dvec3(ball.site) / std::ldexp(2.0, exponent)));
    grids_[exponent][place].push_back(ball);
  }

 private:
  struct Hash {
    size_t operator()(const glm::i64vec3& place) const {
      return mixBits(mixBits(mixBits(place.x) + place.y) + place.z);
    }
  };
  using Grid = std::unordered_map<glm::i64vec3, std::vector<EmptyBall>, Hash>;

  static bool isCrowdedIn(const Grid& grid, const glm::i64vec3& place, const EmptyBall& ball) {
    const auto found = grid.find(place);
    if (found == grid.end()) return false;
    return std::any_of(found->second.begin(), found->second.end(), [&](const EmptyBall& other) {
      const double distance = glm::length(glm::dvec3(other.site) - glm::dvec3(ball.site));
      return distance < kSpacing * (double{other.radius} + ball.radius);
    });
  }

  std::map<int, Grid> grids_;  // by exponent e: radii in (2^(e-1), 2^e], edge 2^(e+1)
};

}  // namespace

std::vector<EmptyBall> findEmptyBalls(const BallTree& tree, std::span<const glm::vec3> sites, std::span<const float> radii,
                                      std::span<const float> densities, std::span<const WalkRay> rays,
                                      const SteinerOptions& options) {
  const EmptyBallFinder finder(tree, sites, radii, densities, options);
  std::vector<std::vector<EmptyBall>> blocks((rays.size() + kRaysPerBlock - 1) / kRaysPerBlock);
  tbb::parallel_for(size_t{0}, blocks.size(), [&](size_t block) {
    for (size_t i = block * kRaysPerBlock; i < std::min((block + 1) * kRaysPerBlock, rays.size()); ++i)
      finder.alongRay(rays[i], i, blocks[block]);
  });
  std::vector<EmptyBall> all;
  for (const std::vector<EmptyBall>& block : blocks) all.insert(all.end(), block.begin(), block.end());
  return all;
}

std::vector<EmptyBall> thinEmptyBalls(std::vector<EmptyBall> balls) {
  std::stable_sort(balls.begin(), balls.end(),
                   [](const EmptyBall& a, const EmptyBall& b) { return a.radius > b.radius; });
  KeptBalls kept;
  std::erase_if(balls, [&](const EmptyBall& ball) {
    if (kept.isCrowded(ball)) return true;
    kept.add(ball);
    return false;
  });
  return balls;
}

}  // namespace froth
