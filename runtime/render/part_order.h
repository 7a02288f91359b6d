// Which instances a recording draws before which: where their boxes do not meet, all rays of a camera meet the one
// before the other, so that a tile can draw one list of cells behind the other (shaders/raster_ordered.comp).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include <glm/glm.hpp>

#include "froth/froth.h"
#include "runtime/render/placed_box.h"
#include "runtime/render/view_renderer.h"
#include "shaders/gpu/layout.h"

namespace froth {

struct PartOrder {
  std::array<uint32_t, gpu::kMostInstances> boxes{};  // [place] which; front to back
  // [place] bits of the places whose boxes meet the one of this place, or of which neither always comes first
  std::array<uint32_t, gpu::kMostInstances> overlaps{};
};

// Of up to gpu::kMostInstances boxes. direction: of parallel rays; else all rays leave the eye. Where nothing tells, in
// the given order.
//
// Convex boxes that do not meet are kept apart by a plane across a face of one of them, or along an edge of each (the
// separating axis theorem). Of these two, a ray from the eye comes first to the one on the eye's side.
PartOrder orderBoxes(std::span<const PlacedBox> boxes, const std::optional<glm::dvec3>& direction);

// Of instances' boxes, in world axes.
PartOrder orderParts(const FrothCamera& camera, std::span<const PlacedBox> boxes);

}  // namespace froth
