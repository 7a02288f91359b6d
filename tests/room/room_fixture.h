// A small foam in the room that the sample ships, its pedestal in the foam, drawn small, with validation.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "foam/foam.h"
#include "samples/mirror_room/stage.h"
#include "tests/surroundings.h"

namespace froth::test {

constexpr VkExtent2D kRoomExtent{96, 64};

// The room that the sample ships.
inline std::filesystem::path shippedRoom() { return sourceFolder() / "samples/mirror_room/meshes/room.gltf"; }

class RoomUnderTest {
 public:
  // After `seconds` of the room's time.
  RoomUnderTest(const RoomLook& look, bool hasParticles, double seconds = 0);
  ~RoomUnderTest();  // any validation message fails the test

  void draw();  // until nothing overflows
  std::vector<float> read(const HostImage& image);

  Host& host() { return *host_; }
  RoomStage& stage() { return *stage_; }
  FrothContext* context() { return stage_->scene().context(); }
  const Foam& foam() const { return foam_; }
  const Pose& pose() const { return stage_->room().camera; }
  RoomShot shot(const std::vector<Particle>& particles) { return {stage_->room(), pose(), particles, stage_->look()}; }

 private:
  std::filesystem::path folder_;
  Foam foam_;
  std::unique_ptr<Host> host_;
  std::unique_ptr<RoomStage> stage_;
};

// Direction of the ray through the middle of a pixel of kRoomExtent, unit.
glm::dvec3 pixelDirection(const Pose& pose, uint32_t x, uint32_t y);

bool hasSuitableDevice();

}  // namespace froth::test
