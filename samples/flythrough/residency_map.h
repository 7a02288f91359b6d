// Where the chunks of an asset are, seen from above: which are drawn, kept, and coming.
#pragma once

#include <span>

#include <glm/glm.hpp>

#include "froth/froth_stream.h"
#include "host/camera_path.h"

namespace froth {

struct MapCamera {
  Pose pose;
  glm::dvec3 up{0, -1, 0};  // away from the ground
};

// Within an ImGui window; of at least one chunk. Discs are drawn, rings are kept, thin rings are coming; their colours
// are those of levels.
void layOutMap(std::span<const FrothChunk> chunks, const MapCamera& camera);

}  // namespace froth
