// What the room's file must hold.
#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>
#include <unistd.h>

#include "samples/mirror_room/room_geometry.h"
#include "tests/room/room_fixture.h"
#include "tests/surroundings.h"

namespace froth::test {
namespace {

using testing::HasSubstr;

std::string readText(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class RoomFile : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  // The shipped room with one text for another.
  std::string messageWith(const std::string& from, const std::string& to) {
    std::string text = readText(shippedRoom());
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    std::ofstream(path_, std::ios::binary) << text.replace(at, from.size(), to);
    const Result<Room> room = readRoom(path_);
    return room ? "" : room.error().message;
  }

  std::filesystem::path path_ = std::filesystem::temp_directory_path() / ("room_" + std::to_string(getpid()) + ".gltf");
};

TEST_F(RoomFile, OfTheSampleHasAllThatTheRoomNeeds) {
  const Result<Room> room = readRoom(shippedRoom());
  ASSERT_TRUE(room) << room.error().message;
  EXPECT_NEAR(glm::length(room->mirror.normal), 1, 1e-6);
  EXPECT_LT(room->mirror.normal.y, 1e-6);
  EXPECT_NEAR(glm::length(room->toSun), 1, 1e-6);
  EXPECT_GT(room->toSun.y, 0.5);
  EXPECT_EQ(room->nodes[room->ball].name, "ball");
  // The camera looks at the foam: along its own z axis.
  const glm::dvec3 toFoam = glm::normalize(room->foam.position - room->camera.eye);
  EXPECT_GT(glm::dot(room->camera.worldFromCamera * glm::dvec3(0, 0, 1), toFoam), 0.8);
  EXPECT_LT((room->camera.worldFromCamera * glm::dvec3(0, 1, 0)).y, -0.8) << "y is down in the camera";
  // From above one meets the floor, which faces up.
  const std::optional<MeshHit> floor = RoomGeometry(*room).cast({2, 5, 2}, {0, -1, 0}, 0, 10);
  ASSERT_TRUE(floor);
  EXPECT_NEAR(floor->distance, 5, 1e-9);
  EXPECT_NEAR(floor->normal.y, 1, 1e-6);
}

TEST_F(RoomFile, TellsWhatIsWrong) {
  EXPECT_THAT(messageWith("\"name\":\"foam\"", "\"name\":\"foil\""), HasSubstr("the node 'foam' is missing"));
  EXPECT_THAT(messageWith("\"name\":\"centre\"", "\"name\":\"center\""), HasSubstr("the node 'centre' is missing"));
  EXPECT_THAT(messageWith("\"name\":\"ball\"", "\"name\":\"bell\""), HasSubstr("the mesh node 'ball' is missing"));
  EXPECT_THAT(messageWith("\"type\":\"directional\"", "\"type\":\"point\""), HasSubstr("is not directional"));
  EXPECT_THAT(messageWith("\"metallicFactor\":1", "\"metallicFactor\":0"), HasSubstr("a mirror"));
  EXPECT_THAT(messageWith("5123", "5125"), HasSubstr("16-bit indices"));
  EXPECT_THAT(messageWith("{\"asset\"", "{asset"), HasSubstr(path_.string()));
}

TEST_F(RoomFile, IsWhatTheScriptWrites) {
  const std::string folder = (sourceFolder() / "samples/mirror_room/meshes/").string();
  for (const std::string name : {"room", "gallery"}) {
    const std::string command =
        "/usr/bin/env python3 '" + folder + "make_room.py' " + name + " '" + path_.string() + "'";
    ASSERT_EQ(std::system(command.c_str()), 0);
    EXPECT_EQ(readText(path_), readText(folder + name + ".gltf"));
    const Result<Room> room = readRoom(path_);
    EXPECT_TRUE(room) << room.error().message;
  }
}

}  // namespace
}  // namespace froth::test
