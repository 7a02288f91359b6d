// The ball on the foam, by CPU queries alone: a null context.
#include "samples/mirror_room/stage.h"
#include "tests/query/query_fixture.h"
#include "tests/render/random_foam.h"
#include "tests/room/room_fixture.h"

namespace froth::test {
namespace {

class BallOnFoam : public QueryTest {
 protected:
  void SetUp() override {
    Result<Room> room = readRoom(shippedRoom());
    ASSERT_TRUE(room) << room.error().message;
    room_ = std::move(*room);
  }

  void placeFoam() {
    const FrothAsset asset = openReady(bakeScene(makeRandomFoam(800, 2, 1, 5), "default", 1u << 20));
    FrothInstanceInfo placement = placementOf(statusOf(asset), room_);
    placement.structSize = sizeof(placement);
    placement.asset = asset;
    FrothInstance instance{};
    ASSERT_EQ(frothCreateInstance(context_, &placement, &instance), FROTH_OK) << lastText();
  }

  // Lets the ball fall for some seconds.
  Ball drop(double seconds) {
    Ball ball(room_);
    const RoomGeometry meshes(room_, room_.ball);
    const Status stepped = ball.step(context_, meshes, seconds);
    EXPECT_TRUE(stepped) << stepped.error().message;
    return ball;
  }

  Room room_;
};

TEST_F(BallOnFoam, BouncesAndIsNeverDeepInside) {
  placeFoam();
  const glm::dvec3 start = room_.nodes[room_.ball].position;
  const Ball early = drop(0.2);
  EXPECT_EQ(early.contacts(), 0u);
  EXPECT_NEAR(early.position().y, start.y - 0.5 * 9.81 * 0.2 * 0.2, 0.01);
  bool rose = false;
  Ball ball(room_);
  const RoomGeometry meshes(room_, room_.ball);
  for (int frame = 0; frame < 480; ++frame) {
    ASSERT_TRUE(ball.step(context_, meshes, 1.0 / 60));
    rose |= ball.contacts() > 0 && ball.velocity().y > 0.3;
    ASSERT_GT(ball.position().y, 0.9 * ball.radius()) << "fell through the floor";
  }
  EXPECT_GT(ball.contacts(), 0u);
  EXPECT_TRUE(rose) << "it never bounced";
  EXPECT_LT(ball.deepest(), 0.25 * ball.radius());
  std::printf("ball: %u contacts, deepest %.4f m, after 8 s %.3f m/s at (%.2f, %.2f, %.2f)\n", ball.contacts(),
              ball.deepest(), glm::length(ball.velocity()), ball.position().x, ball.position().y, ball.position().z);
  EXPECT_LT(glm::length(ball.velocity()), 0.5);
}

TEST_F(BallOnFoam, FallsOntoThePedestalWhereThereIsNoFoam) {
  createContext();
  const Ball ball = drop(6);
  EXPECT_EQ(ball.contacts(), 0u);
  EXPECT_NEAR(ball.position().y, room_.foam.position.y + ball.radius(), 0.01);
}

}  // namespace
}  // namespace froth::test
