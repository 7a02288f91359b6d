// A scene of analytic solids: what they are made of, where rays meet them, what a point of them looks like.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "baker/synth/analytic_shapes.h"

namespace froth {

// What a surface is at one point. Colours are linear.
struct Texel {
  glm::dvec3 albedo{0.5};       // [0..1]
  glm::dvec3 reflectance{0.0};  // share of light mirrored head-on [0..1]; zero: no gloss at all
  double roughness = 0.2;       // half-width of the blurred reflection [radians]
  glm::dvec3 emission{0.0};     // added as it is
};

struct Material {
  std::function<Texel(const SurfacePoint&)> texture;
  // Height of the true surface above the shape, towards the empty side [scene units]; absent: smooth.
  std::function<double(const SurfacePoint&)> relief;
  double reliefBound = 0;  // |relief| never exceeds it [scene units]
};

struct Solid {
  std::shared_ptr<const Shape> shape;
  Material material;
  double spacingFactor = 1;  // sites are this much further apart than the scene's spacing
  bool castsShadows = true;  // blocks the light of the window
};

// A point of the scene, lit: all that its colour from any direction depends on.
struct LitPoint {
  glm::dvec3 position, normal;  // of the embossed surface
  glm::dvec3 radiance;          // diffuse and emitted, linear
  glm::dvec3 reflectance;
  double roughness;
};

struct SceneHit {
  double distance;  // along the ray
  const Solid* solid;
  glm::dvec3 position;  // on the embossed surface
};

// An axis-aligned box of the world.
struct Extent {
  glm::dvec3 low, high;
  bool contains(const glm::dvec3& x) const {
    return glm::all(glm::greaterThan(x, low)) && glm::all(glm::lessThan(x, high));
  }
};

// Solids around and inside a room with one opening in its walls. Rays pass through the surfaces of inside-out
// shapes within the opening; solids may be sunk into the walls, where nobody sees them.
class AnalyticScene {
 public:
  AnalyticScene(std::vector<Solid> solids, const Extent& room, const Extent& opening);

  const std::vector<Solid>& solids() const { return solids_; }

  std::optional<SceneHit> intersect(const Ray& ray) const;

  // How much of `to` can be seen from `from` past the solids that cast shadows: 1 lit, 0 dark, between them
  // where the segment passes closer than `softness` times the distance gone. Relief does not count.
  double softVisibility(const glm::dvec3& from, const glm::dvec3& to, double softness) const;

  // Whether a place on the surface of `solid`, where its normal is given, is hidden: in a wall, or, for
  // walls, in the opening; in another solid, or within `margin` of it if `solid` is a wall or comes later (of
  // coplanar surfaces the earlier remains) and the two do not face each other, as a ball and the floor under
  // it do.
  bool isCovered(const glm::dvec3& x, const glm::dvec3& normal, const Solid& solid, double margin) const;

  // Clearance at x from the nearest solid, looked for up to `reach`.
  double clearance(const glm::dvec3& x, double reach) const;

 private:
  struct Bounds {
    glm::dvec3 centre;
    double radius;  // kNoHit: the shape is inside out, and everywhere
  };

  std::vector<Solid> solids_;
  std::vector<Bounds> bounds_;  // [solids]
  Extent room_, opening_;
};

// The embossed surface seen along the normal of a shape's point: height above `origin` of the surface on the
// line origin + height * normal [scene units].
double heightAlongNormal(const Solid& solid, const glm::dvec3& origin, const glm::dvec3& normal);

// Unit normal of the embossed surface at the shape's point nearest to x.
glm::dvec3 embossedNormal(const Solid& solid, const SurfacePoint& point);

}  // namespace froth
