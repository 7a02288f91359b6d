// Glowing motes that drift around the middle of the room.
#pragma once

#include <vector>

#include "samples/mirror_room/room_file.h"

namespace froth {

struct Particle {
  glm::dvec3 centre;
  double radius;
  glm::vec4 colour;  // linear light, w: opacity in the middle
};

// Where they are after so many seconds.
std::vector<Particle> particlesAt(const Room& room, double seconds);

}  // namespace froth
