#include "baker/synth/gallery_scene.h"

#include "baker/synth/gallery_materials.h"

namespace froth {

using glm::dmat3;
using glm::dvec2;
using glm::dvec3;

namespace {

// Faces of boxes, by the side of the axes they look to.
constexpr uint32_t kBack = 1, kFront = 2, kRight = 4, kLeft = 8, kFoot = 16,
                   kTop = 32;  // -x, +x, -y, +y, -z, +z
constexpr uint32_t kNoFoot = Cuboid::kAllFaces & ~kFoot;

class Builder {
 public:
  void add(std::shared_ptr<const Shape> shape, Material material, double spacingFactor = 1, bool castsShadows = true) {
    solids_.push_back({std::move(shape), std::move(material), spacingFactor, castsShadows});
  }

  void addBox(const dvec3& low, const dvec3& high, Material material, double spacingFactor = 1,
              bool castsShadows = true, uint32_t faces = Cuboid::kAllFaces) {
    add(std::make_shared<Cuboid>(0.5 * (low + high), 0.5 * (high - low), Cuboid::Empty::kOutside, faces),
        std::move(material), spacingFactor, castsShadows);
  }

  // A picture hung on the wall whose normal lies along `axis` (0: x, 1: y), sunk a little into it.
  void addPicture(Painting painting, const dvec3& centre, const dvec2& halfExtent, uint32_t axis) {
    constexpr double kHalfDepth = 0.024, kSunk = 0.003;
    const bool atFarEnd = centre[static_cast<int>(axis)] > 0;
    dvec3 half(halfExtent.x, halfExtent.x, halfExtent.y);
    half[static_cast<int>(axis)] = kHalfDepth;
    dvec3 middle = centre;
    middle[static_cast<int>(axis)] += (atFarEnd ? -1 : 1) * (kHalfDepth - kSunk);
    const uint32_t hidden = 1u << (2 * axis + (atFarEnd ? 1 : 0));
    add(std::make_shared<Cuboid>(middle, half, Cuboid::Empty::kOutside, Cuboid::kAllFaces & ~hidden),
        pictureMaterial(painting, halfExtent, axis), 0.62, false);
  }

  std::vector<Solid> take() { return std::move(solids_); }

 private:
  std::vector<Solid> solids_;
};

void addRoom(Builder& build) {
  const dvec3 half = 0.5 * kRoomSize;
  const auto add = [&](Material material, uint32_t faces, double spacingFactor) {
    build.add(std::make_shared<Cuboid>(half, half, Cuboid::Empty::kInside, faces), std::move(material), spacingFactor,
              false);
  };
  add(wallMaterial(), kBack | kFront | kRight | kLeft, 1);
  add(floorMaterial(), kFoot, 0.9);
  add(ceilingMaterial(), kTop, 1.5);
  // A cornice covers the seam of walls and ceiling, whose cells differ in size.
  constexpr double kCornice = 0.11, kSunk = 0.003;
  const dvec3 end = kRoomSize + kSunk, low(-kSunk, -kSunk, kRoomSize.z - kCornice);
  const Material plaster = plainMaterial(dvec3(0.70, 0.67, 0.60));
  const auto addCornice = [&](const dvec3& from, const dvec3& to, uint32_t inwards) {
    build.addBox(from, to, plaster, 1, false, inwards | kFoot);
  };
  addCornice(low, {kCornice, end.y, end.z}, kFront);
  addCornice({kRoomSize.x - kCornice, low.y, low.z}, end, kBack);
  addCornice(low, {end.x, kCornice, end.z}, kLeft);
  addCornice({low.x, kRoomSize.y - kCornice, low.z}, end, kRight);
}

// Four boards around the window's rim between x = low and x = high; `inner` beyond the rim inwards, `outer`
// outwards.
void addWindowFrame(Builder& build, double low, double high, double inner, double outer, const Material& material) {
  const dvec2 in0 = kWindowLow + inner, in1 = kWindowHigh - inner, out0 = kWindowLow - outer,
              out1 = kWindowHigh + outer;
  build.addBox({low, out0.x, out0.y}, {high, in0.x, out1.y}, material, 1, false);
  build.addBox({low, in1.x, out0.y}, {high, out1.x, out1.y}, material, 1, false);
  build.addBox({low, in0.x - 0.01, out0.y}, {high, in1.x + 0.01, in0.y}, material, 1, false);
  build.addBox({low, in0.x - 0.01, in1.y}, {high, in1.x + 0.01, out1.y}, material, 1, false);
}

void addWindow(Builder& build) {
  const Material white = plainMaterial(dvec3(0.74, 0.72, 0.68));
  const dvec3 low(-kWallDepth, kWindowLow), high(0, kWindowHigh);
  build.add(std::make_shared<Cuboid>(0.5 * (low + high), 0.5 * (high - low), Cuboid::Empty::kInside,
                                     kRight | kLeft | kFoot | kTop),
            white, 1, false);
  addWindowFrame(build, -0.004, 0.036, 0.02, 0.10, white);
  addWindowFrame(build, -kWallDepth - 0.04, -kWallDepth + 0.03, kWindowBar, 0.05, white);
  const double x0 = -kWallDepth - 0.5 * kWindowBar, x1 = x0 + kWindowBar;
  const auto addBar = [&](const dvec2& from, const dvec2& to) { build.addBox({x0, from}, {x1, to}, white, 1, false); };
  const double half = 0.5 * kWindowBar;
  for (int i = 1; i <= 3; ++i) {
    const double y = glm::mix(kWindowLow.x, kWindowHigh.x, i / 4.0);
    addBar({y - half, kWindowLow.y}, {y + half, kWindowHigh.y});
  }
  for (int i = 1; i <= 2; ++i) {
    const double z = glm::mix(kWindowLow.y, kWindowHigh.y, i / 3.0);
    addBar({kWindowLow.x, z - half}, {kWindowHigh.x, z + half});
  }
  constexpr double kHalfAngle = 0.95;  // wide enough for every ray through the window from where cameras may stand
  build.add(std::make_shared<Backdrop>(kSkyCentre, kSkyRadius, dvec3(-1, 0, 0), kHalfAngle), landscapeMaterial(), 9.0,
            false);
}

void addPictures(Builder& build) {
  const double back = kRoomSize.y, right = kRoomSize.x;
  build.addPicture(Painting::kCircles, {2.1, back, 1.80}, {0.62, 0.62}, 1);
  build.addPicture(Painting::kSunset, {4.15, back, 1.85}, {0.98, 0.66}, 1);
  build.addPicture(Painting::kMarbling, {6.2, back, 1.80}, {0.62, 0.62}, 1);
  build.addPicture(Painting::kBubbles, {right, 3.0, 1.85}, {1.15, 0.72}, 0);
  build.addPicture(Painting::kWeave, {2.7, 0, 1.80}, {0.55, 0.60}, 1);
  build.addPicture(Painting::kMarbling, {5.2, 0, 1.85}, {0.95, 0.62}, 1);
}

// The edges of a cube, as bars, turned about the vertical.
void addCubeFrame(Builder& build, const dvec3& foot, double size, double bar, double angle, const Material& material) {
  const double c = std::cos(angle), s = std::sin(angle);
  const dmat3 axes(dvec3(c, s, 0), dvec3(-s, c, 0), dvec3(0, 0, 1));
  const double reach = 0.5 * (size - bar);
  const dvec3 centre = foot + dvec3(0, 0, 0.5 * size);
  for (int axis = 0; axis < 3; ++axis) {
    for (int corner = 0; corner < 4; ++corner) {
      dvec3 offset(0), half(0.5 * bar);
      offset[(axis + 1) % 3] = corner & 1 ? reach : -reach;
      offset[(axis + 2) % 3] = corner & 2 ? reach : -reach;
      // Uprights fill the corners; the others butt against them.
      half[axis] = axis == 2 ? 0.5 * size : 0.5 * size - bar + 0.003;
      build.add(
          std::make_shared<Cuboid>(centre + axes * offset, half, Cuboid::Empty::kOutside, Cuboid::kAllFaces, axes),
          material);
    }
  }
}

void addSculptures(Builder& build) {
  build.addBox({6.35, 4.65, 0}, {6.79, 5.09, 0.12}, marbleMaterial({0.30, 0.30, 0.32}), 0.8, true, kNoFoot);
  build.addBox({6.40, 4.70, 0.11}, {6.74, 5.04, 0.98}, marbleMaterial({1.0, 0.98, 0.94}), 0.8, true, kNoFoot);
  build.add(std::make_shared<Sphere>(dvec3(6.57, 4.87, 1.258), 0.28), bandedCeramicMaterial(0.28), 0.6);

  build.add(std::make_shared<Cylinder>(dvec3(1.55, 4.95, 0), 0.36, 0.62), marbleMaterial({0.95, 0.80, 0.70}), 0.8);
  build.add(std::make_shared<Torus>(dvec3(1.55, 4.95, 1.005), glm::normalize(dvec3(0.75, -1.0, 0.0)), 0.29, 0.098),
            metalMaterial({0.62, 0.42, 0.16}, 0.22), 0.6);

  addCubeFrame(build, {6.55, 1.30, 0}, 0.95, 0.042, 0.42, lacquerMaterial({0.55, 0.035, 0.03}, 0.3));
  build.add(std::make_shared<Sphere>(dvec3(6.55, 1.30, 0.328), 0.33), lacquerMaterial({0.045, 0.21, 0.13}, 0.19), 0.6);

  build.add(std::make_shared<Sphere>(dvec3(1.75, 1.05, 0.348), 0.35), spiralBallMaterial(0.35), 0.65);

  const Material iron = plainMaterial(dvec3(0.05, 0.05, 0.055));
  build.addBox({3.15, 0.55, 0.40}, {4.75, 0.97, 0.475}, woodMaterial(), 0.8);
  build.addBox({3.32, 0.60, 0}, {3.40, 0.92, 0.405}, iron, 0.8, true, kNoFoot);
  build.addBox({4.50, 0.60, 0}, {4.58, 0.92, 0.405}, iron, 0.8, true, kNoFoot);

  for (const double y : {0.95, 5.05}) {
    build.add(std::make_shared<Cylinder>(dvec3(0.42, y, 0), 0.17, kRoomSize.z + 0.1), columnMaterial(0.17), 0.8);
  }
}

AnalyticScene buildGallery() {
  Builder build;
  addRoom(build);
  addWindow(build);
  addPictures(build);
  addSculptures(build);
  // Surfaces that lie in the boxes' own faces count as outside.
  constexpr double kClear = 1e-3;
  return AnalyticScene(build.take(), Extent{dvec3(kClear), kRoomSize - kClear},
                       Extent{dvec3(-2 * kWallDepth, kWindowLow + kClear), dvec3(2 * kClear, kWindowHigh - kClear)});
}

}  // namespace

const AnalyticScene& galleryScene() {
  static const AnalyticScene scene = buildGallery();
  return scene;
}

}  // namespace froth
