// Sets of balls on which graphs are tested: easy, stiff and degenerate ones, made from a seed.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace froth {

struct BallSet {
  std::string name;
  std::vector<glm::vec3> sites;
  std::vector<float> radii;

  uint32_t size() const { return static_cast<uint32_t>(sites.size()); }
  void add(glm::vec3 site, float radius) {
    sites.push_back(site);
    radii.push_back(radius);
  }
};

class BallSetMaker {
 public:
  explicit BallSetMaker(uint64_t seed) : random_(seed) {}

  double uniform(double low, double high) { return low + (high - low) * unit(); }
  glm::dvec3 pointInCube(double low, double high) {
    const double x = uniform(low, high), y = uniform(low, high);
    return {x, y, uniform(low, high)};
  }

  // A foam as trained ones are: radii around the spacing, most balls overlap a dozen others.
  BallSet foamLike(uint32_t count, double offset = 0) {
    BallSet balls{offset == 0 ? "foam-like" : "far from the origin", {}, {}};
    const double spacing = 10 / std::cbrt(count);
    for (uint32_t i = 0; i < count; ++i) {
      const glm::vec3 site(pointInCube(0, 10) + offset);
      balls.add(site, static_cast<float>(spacing * uniform(0.4, 0.9)));
    }
    return balls;
  }

  // Radii over four decades; small balls sit near the surfaces of large ones, some just inside.
  BallSet stiff(uint32_t count) {
    BallSet balls{"stiff", {}, {}};
    for (uint32_t i = 0; i < count; ++i) {
      const double radius = 3 * std::pow(10, -4 * std::pow(unit(), 0.5));
      glm::dvec3 site = pointInCube(0, 10);
      if (i >= 4 && i % 3 != 0) {
        const uint32_t host = i % 4 == 0 ? i - 1 : i % 4;
        const glm::dvec3 direction = glm::normalize(pointInCube(-1, 1) + glm::dvec3(1e-3));
        site = glm::dvec3(balls.sites[host]) + direction * (balls.radii[host] + radius * uniform(-1.1, 1));
      }
      balls.add(glm::vec3(site), static_cast<float>(radius));
    }
    return balls;
  }

  BallSet grid(uint32_t side, float radius) {
    BallSet balls{"grid", {}, {}};
    for (uint32_t k = 0; k < side * side * side; ++k) {
      balls.add({k % side, k / side % side, k / side / side}, radius);
    }
    return balls;
  }

  BallSet coplanar(uint32_t count) {
    BallSet balls{"coplanar", {}, {}};
    for (uint32_t i = 0; i < count; ++i) {
      const glm::vec3 site(uniform(0, 10), uniform(0, 10), 2);
      balls.add(site, static_cast<float>(uniform(0.2, 1.2)));
    }
    return balls;
  }

  BallSet collinear(uint32_t count) {
    BallSet balls{"collinear", {}, {}};
    for (uint32_t i = 0; i < count; ++i) {
      const float place = static_cast<float>(uniform(0, 10));
      balls.add({place, place, 0.5f * place}, static_cast<float>(uniform(0.1, 0.8)));
    }
    return balls;
  }

  // Every third ball all but repeats an earlier one: a few units in the last place apart.
  BallSet withNearDuplicates(uint32_t count) {
    BallSet balls = foamLike(count);
    balls.name = "near duplicates";
    for (uint32_t i = 2; i < count; i += 3) {
      balls.sites[i] = balls.sites[i / 2] + glm::vec3(pointInCube(-5e-6, 5e-6));
      balls.radii[i] = balls.radii[i / 2];
    }
    return balls;
  }

  // Every third ball repeats an earlier site, with its own radius.
  BallSet withDuplicates(uint32_t count) {
    BallSet balls = foamLike(count);
    balls.name = "duplicates";
    for (uint32_t i = 2; i < count; i += 3) balls.sites[i] = balls.sites[i / 2];
    return balls;
  }

 private:
  // Not std's distributions: their numbers differ between standard libraries.
  double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

  std::mt19937_64 random_;
};

inline std::vector<BallSet> makeBallSets(uint64_t seed) {
  BallSetMaker make(seed);
  std::vector<BallSet> sets = {make.foamLike(150),      make.foamLike(150, 1e5),    make.stiff(150),
                               make.grid(4, 0.9f),      make.coplanar(60),          make.collinear(20),
                               make.withDuplicates(90), make.withNearDuplicates(90)};
  for (uint32_t count = 1; count <= 4; ++count) {
    sets.push_back(make.foamLike(count));
    sets.back().name = "few";
  }
  return sets;
}

}  // namespace froth
