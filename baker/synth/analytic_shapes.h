// Surfaces of the analytic scenes: each can be hit by rays, measured, and covered evenly with sites.
//
// A shape has a solid and an empty side. Rooms and backdrops are shapes turned inside out: empty within.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <glm/glm.hpp>

#include "base/counter_random.h"

namespace froth {

inline constexpr double kNoHit = std::numeric_limits<double>::infinity();

struct Ray {
  glm::dvec3 origin, direction;  // direction has unit length
};

struct SurfacePoint {
  glm::dvec3 position;  // world
  glm::dvec3 normal;    // unit, towards the empty side
  glm::dvec3 tangent;   // unit, orthogonal to the normal
  glm::dvec3 local;     // the position in the shape's own frame, from its centre
  uint32_t face = 0;    // Cuboid: 2 * axis + (1 on its positive side); Cylinder: 0 side, 1 top; others: 0
};

// A place for a cell. Balls of this radius around all sites of a shape cover its surface.
struct SurfaceSite {
  glm::dvec3 position, normal, tangent;
  double radius;  // [scene units]
};

class Shape {
 public:
  virtual ~Shape() = default;

  // Positive on the empty side. Exact near the surface, a lower bound of the magnitude elsewhere.
  virtual double distance(const glm::dvec3& x) const = 0;
  virtual SurfacePoint nearest(const glm::dvec3& x) const = 0;

  // First ray parameter > 0 at which the ray enters the solid, swollen by `swell` [scene units, >= 0] towards
  // its empty side; kNoHit if it never does.
  virtual double intersect(const Ray& ray, double swell) const = 0;

  // Appends sites about `spacing` apart.
  virtual void placeSites(double spacing, const CounterRandom& random, std::vector<SurfaceSite>& sites) const = 0;

  // Radius around centre() that holds the solid; kNoHit for shapes turned inside out.
  virtual double boundingRadius() const = 0;
  virtual glm::dvec3 centre() const = 0;
};

// A box with axes of its own. Sites lie in rows parallel to the edges, and both faces of an edge hold
// mirrored rows, so that their radical planes bisect the edge and it comes out sharp.
class Cuboid final : public Shape {
 public:
  enum class Empty { kOutside, kInside };
  static constexpr uint32_t kAllFaces = 63;

  // `faces`: bit 2 * axis + (1 on the positive side). A face left out gets no sites; if the box is empty
  // inside, rays leave through it.
  Cuboid(const glm::dvec3& centre, const glm::dvec3& halfExtent, Empty empty = Empty::kOutside,
         uint32_t faces = kAllFaces, const glm::dmat3& axes = glm::dmat3(1));

  double distance(const glm::dvec3& x) const override;
  SurfacePoint nearest(const glm::dvec3& x) const override;
  double intersect(const Ray& ray, double swell) const override;
  void placeSites(double spacing, const CounterRandom& random, std::vector<SurfaceSite>& sites) const override;
  double boundingRadius() const override;
  glm::dvec3 centre() const override { return centre_; }

 private:
  SurfacePoint pointOnFace(const glm::dvec3& local, uint32_t face) const;

  glm::dvec3 centre_, halfExtent_;
  double side_;  // +1: empty outside
  uint32_t faces_;
  glm::dmat3 axes_;  // columns: the box's axes in the world
};

class Sphere final : public Shape {
 public:
  Sphere(const glm::dvec3& centre, double radius) : centre_(centre), radius_(radius) {}

  double distance(const glm::dvec3& x) const override;
  SurfacePoint nearest(const glm::dvec3& x) const override;
  double intersect(const Ray& ray, double swell) const override;
  void placeSites(double spacing, const CounterRandom& random, std::vector<SurfaceSite>& sites) const override;
  double boundingRadius() const override { return radius_; }
  glm::dvec3 centre() const override { return centre_; }

 private:
  glm::dvec3 centre_;
  double radius_;
};

// The part of a sphere within `halfAngle` [radians] of the direction `axis` (unit), seen from within.
class Backdrop final : public Shape {
 public:
  Backdrop(const glm::dvec3& centre, double radius, const glm::dvec3& axis, double halfAngle);

  double distance(const glm::dvec3& x) const override;
  SurfacePoint nearest(const glm::dvec3& x) const override;
  double intersect(const Ray& ray, double swell) const override;
  void placeSites(double spacing, const CounterRandom& random, std::vector<SurfaceSite>& sites) const override;
  double boundingRadius() const override { return kNoHit; }
  glm::dvec3 centre() const override { return centre_; }

 private:
  glm::dvec3 centre_, axis_;
  double radius_, cosHalfAngle_;
};

class Torus final : public Shape {
 public:
  // `axis`: unit, through the hole. majorRadius > minorRadius > 0.
  Torus(const glm::dvec3& centre, const glm::dvec3& axis, double majorRadius, double minorRadius);

  double distance(const glm::dvec3& x) const override;
  SurfacePoint nearest(const glm::dvec3& x) const override;
  double intersect(const Ray& ray, double swell) const override;
  void placeSites(double spacing, const CounterRandom& random, std::vector<SurfaceSite>& sites) const override;
  double boundingRadius() const override { return major_ + minor_; }
  glm::dvec3 centre() const override { return centre_; }

 private:
  SurfacePoint pointAt(const glm::dvec3& local) const;

  glm::dvec3 centre_;
  glm::dmat3 axes_;  // columns; the third is the torus's axis
  double major_, minor_;
};

// An upright cylinder standing on z = base.z; its foot gets no sites.
class Cylinder final : public Shape {
 public:
  Cylinder(const glm::dvec3& base, double radius, double height) : base_(base), radius_(radius), height_(height) {}

  double distance(const glm::dvec3& x) const override;
  SurfacePoint nearest(const glm::dvec3& x) const override;
  double intersect(const Ray& ray, double swell) const override;
  void placeSites(double spacing, const CounterRandom& random, std::vector<SurfaceSite>& sites) const override;
  double boundingRadius() const override;
  glm::dvec3 centre() const override { return base_ + glm::dvec3(0, 0, 0.5 * height_); }

 private:
  glm::dvec3 base_;
  double radius_, height_;
};

// Unit vectors that make a right-handed frame with the unit vector z as its third column.
glm::dmat3 frameAround(const glm::dvec3& z);

}  // namespace froth
