// The command line of froth_mirror_room.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "froth/froth_walk.h"
#include "host/command_line.h"
#include "samples/mirror_room/room_frame.h"

namespace froth {

struct MirrorRoomOptions : RunOptions {
  std::string asset;
  std::filesystem::path room = FROTH_ROOM_FILE;
  RoomLook look;
  bool hasParticles = true;
  FrothRayPreparation prepareRays = FROTH_PREPARE_RADIANCE;
  std::filesystem::path json;        // empty, or where headless runs write their times
  std::optional<glm::dvec2> picked;  // headless: pixel of the last frame to tell about
};

}  // namespace froth
