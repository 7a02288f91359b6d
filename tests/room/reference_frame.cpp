#include "tests/room/reference_frame.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "froth/froth_query.h"
#include "shaders/foam/colour.h"

namespace froth::test {
namespace {

constexpr uint32_t kSpread = 128;  // rays of surrounding light per place

glm::dmat3 axesAlong(const glm::dvec3& z) {
  const glm::dvec3 other = std::abs(z.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(other, z));
  return {x, glm::cross(z, x), z};
}

double fresnel(double cosine) { return 0.04 + 0.96 * std::pow(1 - std::clamp(cosine, 0.0, 1.0), 5.0); }

glm::dvec3 vec3Of(const float* values) { return {values[0], values[1], values[2]}; }

}  // namespace

ReferenceFrame::ReferenceFrame(RoomUnderTest& room, const std::vector<Particle>& particles)
    : room_(room.stage().room()),
      pose_(room.pose()),
      look_(room.stage().look()),
      frame_(frameOf(room.shot(particles), SunCamera(room_), 1, kRoomExtent, true)),
      context_(room.context()),
      meshes_(room_),
      renderer_(room.foam()),
      particles_(particles) {
  const FrothInstanceInfo& placement = room.stage().placement();
  foamPosition_ = {placement.position[0], placement.position[1], placement.position[2]};
  foamScale_ = placement.scale;
  const float* q = placement.rotation;
  assetFromWorld_ = glm::transpose(glm::mat3_cast(glm::dquat(q[3], q[0], q[1], q[2])));
}

std::optional<ReferenceFrame::Surface> ReferenceFrame::surfaceAlong(const glm::dvec3& origin,
                                                                    const glm::dvec3& direction) const {
  const std::optional<MeshHit> hit = meshes_.cast(origin, direction, 1e-6, INFINITY);
  if (!hit) return {};
  const glm::dvec3 normal = glm::dot(hit->normal, direction) > 0 ? -hit->normal : hit->normal;
  return Surface{origin + hit->distance * direction, normal, hit->distance, &room_.materials[hit->material]};
}

// A view of one pixel, in the asset's frame.
ReferenceFrame::FoamSeen ReferenceFrame::foamAlong(const glm::dvec3& eye, const glm::dvec3& direction,
                                                   double tEnd) const {
  View view;
  view.width = view.height = 1;
  view.fx = view.fy = 1;
  view.cx = view.cy = 0.5;
  const glm::dvec3 place = assetFromWorld_ * (eye - foamPosition_) / foamScale_;
  const glm::dmat3 axes = axesAlong(assetFromWorld_ * direction);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      view.worldFromCamera[static_cast<size_t>(4 * row + column)] = axes[column][row];
    }
    view.worldFromCamera[static_cast<size_t>(4 * row + 3)] = place[row];
  }
  const Image end{1, 1, 1, {static_cast<float>(tEnd / foamScale_)}};
  ReferenceOptions options;
  options.nearRatio = 0;
  options.cutoff = 1e-3;
  options.sceneDistance = &end;
  const Result<RenderedImages> images = renderer_.render(view, options);
  EXPECT_TRUE(images) << images.error().message;
  FoamSeen seen;
  seen.coded = vec3Of(images->colour.pixel(0, 0));
  seen.alpha = *images->alpha.pixel(0, 0);
  seen.distance = *images->distance.pixel(0, 0) * foamScale_;
  seen.normal = glm::transpose(assetFromWorld_) * vec3Of(images->normal.pixel(0, 0));
  return seen;
}

ReferenceFrame::Light ReferenceFrame::foamAndMotes(const glm::dvec3& eye, const glm::dvec3& direction, double tStart,
                                                   double tEnd) const {
  struct Mote {
    double t, cover;
    glm::dvec3 colour;
  };
  std::vector<Mote> motes;
  for (const Particle& particle : particles_) {
    const glm::dvec3 offset = particle.centre - eye;
    const double t = glm::dot(offset, direction);
    const glm::dvec3 across = offset - t * direction;
    const double fade = 1 - glm::dot(across, across) / (particle.radius * particle.radius);
    if (fade > 0 && t > tStart && t < tEnd) {
      motes.push_back({t, particle.colour.w * fade * fade, glm::dvec3(particle.colour)});
    }
  }
  std::sort(motes.begin(), motes.end(), [](const Mote& a, const Mote& b) { return a.t < b.t; });
  motes.push_back({tEnd, 0, glm::dvec3(0)});

  glm::dvec3 foam(0), glow(0);
  double past = 1;  // share of light that comes past the motes so far
  FoamSeen before, seen;
  for (const Mote& mote : motes) {
    seen = foamAlong(eye, direction, mote.t);
    const double through = 1 - before.alpha, alpha = 1 - (1 - seen.alpha) / through;
    foam += past * through * foam::linearPremultiplied<double>((seen.coded - before.coded) / through, alpha);
    glow += past * (1 - seen.alpha) * mote.cover * mote.colour;
    past *= 1 - mote.cover;
    before = seen;
  }
  if (seen.distance >= 0) foam *= caughtShadow(eye + seen.distance * direction, glm::normalize(seen.normal));
  return {foam + glow, 1 - past * (1 - seen.alpha)};
}

double ReferenceFrame::throughFoam(const glm::dvec3& origin, const glm::dvec3& direction, double tMax) const {
  FrothRay ray{};
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin[axis] = origin[axis];
    ray.direction[axis] = direction[axis];
  }
  ray.tMax = tMax;
  FrothRayHit hit{};
  EXPECT_EQ(frothCastRays(context_, nullptr, &ray, &hit, 1), FROTH_OK);
  return hit.transmittance;
}

glm::dvec3 ReferenceFrame::spreadDirection(const glm::dvec3& normal, uint32_t i, uint32_t count) {
  const double squaredRadius = (i + 0.5) / count, angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
  const double side = normal.z >= 0 ? 1 : -1, a = -1 / (side + normal.z), b = normal.x * normal.y * a;
  const glm::dvec3 tangent(1 + side * normal.x * normal.x * a, side * b, -side * normal.x);
  const glm::dvec3 bitangent(b, side + normal.y * normal.y * a, -normal.y);
  const double radius = std::sqrt(squaredRadius);
  return radius * std::cos(angle) * tangent + radius * std::sin(angle) * bitangent +
         std::sqrt(1 - squaredRadius) * normal;
}

double ReferenceFrame::sunAt(const glm::dvec3& position, const glm::dvec3& normal) const {
  if (glm::dot(normal, room_.toSun) <= 0) return 0;
  if (meshes_.cast(position + 1e-5 * normal, room_.toSun, 0, INFINITY)) return 0;
  return throughFoam(position, room_.toSun, 0);
}

double ReferenceFrame::surroundAt(const glm::dvec3& position, const glm::dvec3& normal) const {
  double sum = 0;
  for (uint32_t i = 0; i < kSpread; ++i) {
    sum += throughFoam(position, spreadDirection(normal, i, kSpread), look_.occlusionReach);
  }
  return sum / kSpread;
}

glm::dvec3 ReferenceFrame::surroundings(const glm::dvec3& direction) const {
  return glm::mix(glm::dvec3(frame_.ground), glm::dvec3(frame_.sky), 0.5 + 0.5 * direction.y);
}

glm::dvec3 ReferenceFrame::caughtShadow(const glm::dvec3& position, const glm::dvec3& normal) const {
  const glm::dvec3 surround = surroundings(normal);
  const double facing = glm::dot(normal, room_.toSun);
  const glm::dvec3 sun = glm::dvec3(room_.sun) * std::max(facing, 0.0);
  const double lit = meshes_.cast(position, room_.toSun, 1e-5, INFINITY) ? 0 : 1;
  return glm::mix(glm::dvec3(1), (surround + lit * sun) / (surround + sun), look_.shadowCatching);
}

glm::dvec3 ReferenceFrame::litSurface(const Surface& surface, const glm::dvec3& along) const {
  const double sunShare = sunAt(surface.position, surface.normal);
  const glm::dvec3 sun = sunShare * std::max(glm::dot(surface.normal, room_.toSun), 0.0) * glm::dvec3(room_.sun);
  const glm::dvec3 light = sun + surroundAt(surface.position, surface.normal) * surroundings(surface.normal);
  glm::dvec3 lit = glm::dvec3(surface.material->colour) * light;
  if (surface.material->kind == MaterialKind::kGlossy) {
    const glm::dvec3 middle = glm::normalize(room_.toSun - along);
    const double shininess = 2 / std::pow(surface.material->roughness, 4.0);
    lit += 0.04 * 0.125 * (shininess + 8) * std::pow(std::max(glm::dot(middle, surface.normal), 0.0), shininess) * sun;
  }
  return lit;
}

glm::dvec3 ReferenceFrame::lightInMirror(const glm::dvec3& eye, const Surface& mirror, const glm::dvec3& along) const {
  const glm::dvec3 reflected = glm::reflect(along, room_.mirror.normal);
  const std::optional<Surface> beyond = surfaceAlong(mirror.position, reflected);
  glm::dvec3 light = surroundings(reflected);
  if (beyond) {
    light = litSurface(*beyond, reflected);
    if (beyond->material->kind == MaterialKind::kGlossy) {
      light += fresnel(-glm::dot(reflected, beyond->normal)) * surroundings(glm::reflect(reflected, beyond->normal));
    }
  }
  const double tEnd = mirror.distance + (beyond ? beyond->distance : INFINITY);
  const Light foam = foamAndMotes(room_.mirror.reflect(eye), reflected, mirror.distance, tEnd);
  return glm::dvec3(mirror.material->colour) * (foam.colour + (1 - foam.alpha) * light);
}

glm::dvec3 ReferenceFrame::lightAlong(const glm::dvec3& eye, const glm::dvec3& along) const {
  const std::optional<Surface> surface = surfaceAlong(eye, along);
  glm::dvec3 light;
  if (!surface) {
    light = surroundings(along);
  } else if (surface->material->kind == MaterialKind::kMirror) {
    light = lightInMirror(eye, *surface, along);
  } else {
    light = litSurface(*surface, along);
    if (surface->material->kind == MaterialKind::kGlossy) {
      const glm::dvec3 reflected = glm::reflect(along, surface->normal);
      const Light foam = foamAndMotes(surface->position, reflected, 0, INFINITY);
      light += fresnel(-glm::dot(along, surface->normal)) * (foam.colour + (1 - foam.alpha) * surroundings(reflected));
    }
  }
  const Light foam = foamAndMotes(eye, along, 0, surface ? surface->distance : INFINITY);
  return foam.colour + (1 - foam.alpha) * light;
}

std::vector<float> ReferenceFrame::render() const {
  std::vector<float> texels;
  for (uint32_t y = 0; y < kRoomExtent.height; ++y) {
    for (uint32_t x = 0; x < kRoomExtent.width; ++x) {
      const glm::dvec3 light = lightAlong(pose_.eye, pixelDirection(pose_, x, y));
      for (int channel = 0; channel < 3; ++channel) texels.push_back(static_cast<float>(light[channel]));
      texels.push_back(1);
    }
  }
  return texels;
}

}  // namespace froth::test
