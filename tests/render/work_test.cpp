// The counts of FrothWork against a count on the CPU, in double.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "shaders/foam/cell.h"
#include "shaders/foam/clip_face.h"
#include "shaders/foam/rays.h"
#include "shaders/gpu/layout.h"
#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"

namespace froth::test {
namespace {

constexpr VkExtent2D kExtent{48, 40};

// One chunk of flat faces, whose solid balls are the cells' own: every ball that a ray meets is looked at.
AssetContents makeContents() {
  Foam foam = makeRandomFoam(120, 2, 1, 8);
  foam.detailHeights.assign(foam.detailHeights.size(), 0.0f);
  AssetContents contents = bakeForTest(foam);
  EXPECT_EQ(contents.chunks.size(), 1u);
  contents.chunks[0].solidBalls.clear();
  return contents;
}

struct Interval {
  double tNear = 0, tFar = 0;
};

// What rays of a pinhole view meet in a chunk.
class Counter {
 public:
  Counter(const ChunkContents& chunk, const View& view) : chunk_(chunk), width_(view.width) {
    const auto& world = view.worldFromCamera;
    eye_ = {world[3], world[7], world[11]};
    forward_ = {world[2], world[6], world[10]};
    for (uint32_t y = 0; y < view.height; ++y) {
      for (uint32_t x = 0; x < view.width; ++x) {
        const glm::dvec3 camera((x + 0.5 - view.cx) / view.fx, (y + 0.5 - view.cy) / view.fy, 1);
        glm::dvec3 direction;
        for (int row = 0; row < 3; ++row) {
          direction[row] = world[row * 4] * camera.x + world[row * 4 + 1] * camera.y + world[row * 4 + 2] * camera.z;
        }
        rays_.push_back(glm::normalize(direction));
      }
    }
  }

  FrothWork countRaster() const {
    FrothWork work{};
    for (const glm::dvec3& ray : rays_) {
      for (uint32_t cell = 0; cell < chunk_.liveCount; ++cell) {
        Interval interval;
        if (!foam::intersectBall(centreOf(cell), radiusOf(cell), ray, interval.tNear, interval.tFar)) continue;
        ++work.ballHits;
        work.planes += chunk_.alphaCounts[cell];
        for (uint32_t i = 0; i < chunk_.alphaCounts[cell]; ++i) {
          const uint32_t other = chunk_.neighbours[chunk_.neighbourOffsets[cell] + i];
          foam::clipByPlane(clearanceOf(cell, other), glm::dot(towards(cell, other), ray),
                            foam::comesFirst(towards(cell, other)), interval.tNear, interval.tFar);
        }
        work.colours += isColoured(cell, ray, interval);
      }
    }
    return work;
  }

  FrothWork countWalk() const {
    FrothWork work{};
    for (size_t pixel = 0; pixel < rays_.size(); ++pixel) {
      const glm::dvec3& ray = rays_[pixel];
      double entry = beginOfTile(pixel);
      uint32_t cell = cellHolding(entry * ray);
      for (bool isInside = std::isfinite(entry); isInside;) {
        ++work.steps;
        uint32_t next = cell;
        double exit = INFINITY;
        for (uint32_t i = chunk_.neighbourOffsets[cell]; i < chunk_.neighbourOffsets[cell + 1]; ++i) {
          const uint32_t other = chunk_.neighbours[i];
          if (clearanceOf(cell, other) < 0) continue;  // the ray has come from there
          ++work.neighbours;
          const double q = glm::dot(towards(cell, other), ray);
          const double t = q > 0 ? clearanceOf(cell, other) / q : INFINITY;
          if (t < exit) {
            exit = t;
            next = other;
          }
        }
        exit = std::max(exit, entry);
        Interval interval;
        if (cell < chunk_.liveCount &&
            foam::intersectBall(centreOf(cell), radiusOf(cell), ray, interval.tNear, interval.tFar)) {
          ++work.ballHits;
          work.colours += isColoured(cell, ray, {std::max(interval.tNear, entry), std::min(interval.tFar, exit)});
        }
        isInside = next != cell;
        cell = next;
        entry = exit;
      }
    }
    return work;
  }

 private:
  glm::dvec3 siteOf(uint32_t cell) const {
    return glm::dvec3(chunk_.sites[cell]) + glm::dvec3(chunk_.origin[0], chunk_.origin[1], chunk_.origin[2]);
  }
  glm::dvec3 centreOf(uint32_t cell) const { return siteOf(cell) - eye_; }
  double radiusOf(uint32_t cell) const { return chunk_.radii[cell]; }
  glm::dvec3 towards(uint32_t cell, uint32_t other) const { return siteOf(other) - siteOf(cell); }
  double clearanceOf(uint32_t cell, uint32_t other) const {
    const glm::dvec3 toNeighbour = towards(cell, other);
    return foam::radicalClearance(centreOf(cell), toNeighbour,
                                  foam::radicalOffset(toNeighbour, radiusOf(cell), radiusOf(other)));
  }

  bool isColoured(uint32_t cell, const glm::dvec3& ray, Interval interval) const {
    const glm::dvec4 q(chunk_.orientations[cell]);  // (w, x, y, z); the face's normal is row 0
    const glm::dvec3 normal(1 - 2 * (q.z * q.z + q.w * q.w), 2 * (q.y * q.z - q.x * q.w), 2 * (q.y * q.w + q.x * q.z));
    if (!(interval.tFar > interval.tNear)) return false;
    const double facing = glm::dot(normal, ray);
    const double face = foam::intersectFace(centreOf(cell), normal, facing, 0.0);
    if (facing >= 0) {
      interval.tFar = std::min(interval.tFar, face);
    } else {
      interval.tNear = std::max(interval.tNear, face);
    }
    return interval.tFar > interval.tNear;
  }

  // point: relative to the eye.
  uint32_t cellHolding(const glm::dvec3& point) const {
    const auto power = [&](uint32_t cell) { return foam::powerOfOrigin(centreOf(cell) - point, radiusOf(cell)); };
    uint32_t best = 0;
    for (uint32_t cell = 1; cell < chunk_.cellCount; ++cell) {
      if (power(cell) < power(best)) best = cell;
    }
    return best;
  }

  // The nearest that a ball comes to the eye which the pixels of the tile can meet; infinite: none does.
  double beginOfTile(size_t pixel) const {
    const auto height = static_cast<uint32_t>(rays_.size()) / width_;
    const auto x = static_cast<uint32_t>(pixel % width_) / gpu::kTileSize * gpu::kTileSize;
    const auto y = static_cast<uint32_t>(pixel / width_) / gpu::kTileSize * gpu::kTileSize;
    const uint32_t right = std::min(x + gpu::kTileSize, width_) - 1, low = std::min(y + gpu::kTileSize, height) - 1;
    const glm::dvec3 corner = atUnitDepth(x, y);
    double begin = INFINITY;
    for (uint32_t cell = 0; cell < chunk_.liveCount; ++cell) {
      const glm::dvec3 centre = centreOf(cell);
      const double distance = std::max(glm::length(centre) - radiusOf(cell), 0.0);
      const bool isMet = foam::rectangleMeetsBall(centre, radiusOf(cell), corner, atUnitDepth(right, y) - corner,
                                                  atUnitDepth(x, low) - corner);
      if (isMet) begin = std::min(begin, distance);
    }
    return begin;
  }

  // The point of a pixel's ray in the plane at distance 1 before the camera.
  glm::dvec3 atUnitDepth(uint32_t x, uint32_t y) const {
    const glm::dvec3& ray = rays_[size_t{y} * width_ + x];
    return ray / glm::dot(ray, forward_);
  }

  const ChunkContents& chunk_;
  uint32_t width_;
  glm::dvec3 eye_{}, forward_{};
  std::vector<glm::dvec3> rays_;
};

// All cells are in sight, so a walk finds the planes of each in its record.
View wholeView() { return lookAt({0.1, 0.2, -6}, {0, 0, 3}, kExtent.width, kExtent.height, 0.6); }

View frontView() { return lookAt({0.1, 0.2, 0.6}, {0, 0, 3}, kExtent.width, kExtent.height, 0.6); }

// Rounding decides some touches otherwise.
void expectClose(uint64_t found, uint64_t expected, const char* what) {
  EXPECT_NEAR(static_cast<double>(found), static_cast<double>(expected), 1e-3 * static_cast<double>(expected)) << what;
  EXPECT_GT(expected, 0u) << what;
}

TEST(Work, IsWhatTheCpuCounts) {
  const AssetContents contents = makeContents();
  const View view = frontView();
  const Counter counter(contents.chunks[0], view);
  Stage stage(contents, kExtent);
  FrothRenderInfo info = infoOf(view);
  info.cutoff = -1;  // all of every ray

  const FrothWork raster = stage.draw(Method::kRaster, info, kExtent).status.work;
  const FrothWork expected = counter.countRaster();
  expectClose(raster.ballHits, expected.ballHits, "balls");
  expectClose(raster.planes, expected.planes, "planes");
  expectClose(raster.colours, expected.colours, "colours");
  EXPECT_EQ(raster.heights, 0u);
  EXPECT_EQ(raster.steps, 0u);
  const uint64_t subTiles = (kExtent.width / 8) * (kExtent.height / 8);
  EXPECT_GE(raster.entries, raster.entriesKept);
  EXPECT_LE(raster.entriesKept, subTiles * contents.chunks[0].liveCount);
  EXPECT_GE(64 * raster.entriesKept, raster.ballHits);

  FrothRenderInfo wholeInfo = infoOf(wholeView());
  wholeInfo.cutoff = -1;
  stage.draw(Method::kWalk, wholeInfo, kExtent);  // after which there is space for all planes
  const FrothWork walk = stage.draw(Method::kWalk, wholeInfo, kExtent).status.work;
  const FrothWork expectedWalk = Counter(contents.chunks[0], wholeView()).countWalk();
  expectClose(walk.steps, expectedWalk.steps, "steps");
  expectClose(walk.neighbours, expectedWalk.neighbours, "neighbours");
  expectClose(walk.ballHits, expectedWalk.ballHits, "balls");
  expectClose(walk.colours, expectedWalk.colours, "colours");
  EXPECT_EQ(walk.entries, 0u);
}

TEST(Work, IsCountedOnlyOnDemandAndChangesNoImage) {
  const AssetContents contents = bakeForTest(makeRandomFoam(120, 2, 1, 8));
  FrothContextInfo info = sharedContextInfo();
  FrothContext* plain = nullptr;
  ASSERT_EQ(frothCreateContext(&info, &plain), FROTH_OK);
  {
    Stage counted(contents, kExtent), uncounted(contents, kExtent, plain);
    for (const Method method : {Method::kRaster, Method::kWalk}) {
      const Frame with = counted.draw(method, frontView()), without = uncounted.draw(method, frontView());
      EXPECT_EQ(with.colour.values, without.colour.values);
      EXPECT_EQ(with.distance.values, without.distance.values);
      EXPECT_EQ(with.normal.values, without.normal.values);
      EXPECT_GT(with.status.work.heights, 0u);
      EXPECT_EQ(without.status.work.ballHits + without.status.work.heights + without.status.work.steps, 0u);
    }
  }
  frothDestroyContext(plain, UINT64_MAX);
}

}  // namespace
}  // namespace froth::test
