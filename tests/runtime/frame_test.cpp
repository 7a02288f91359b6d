#include "one_cell_chunks.h"
#include "runtime_fixture.h"

namespace froth {
namespace {

using ::testing::HasSubstr;

class Frames : public RuntimeTest {
 protected:
  FrothResult updateWith(uint64_t serial, uint64_t completedSerial) {
    auto frame = makeStruct<FrothFrame>();
    frame.serial = serial;
    frame.completedSerial = completedSerial;
    return frothUpdate(context_, &frame, nullptr);
  }
};

TEST_F(Frames, HaveSerialsThatGrow) {
  createContext();
  EXPECT_EQ(updateWith(0, 0), FROTH_ERROR_STATE);
  EXPECT_EQ(updateWith(5, 0), FROTH_OK);
  EXPECT_EQ(updateWith(5, 0), FROTH_ERROR_STATE);
  EXPECT_THAT(lastText(), HasSubstr("5 after 5"));
  EXPECT_EQ(updateWith(9, 9), FROTH_ERROR_STATE);
  EXPECT_EQ(updateWith(9, 5), FROTH_OK);
  EXPECT_EQ(updateWith(10, 4), FROTH_ERROR_STATE) << "what was complete cannot become incomplete";
}

TEST_F(Frames, AreAtMostAsManyInFlightAsTheContextWasMadeFor) {
  FrothContextInfo info = nullContextInfo();
  info.framesInFlight = 3;
  createContext(info);
  EXPECT_EQ(updateWith(1, 0), FROTH_OK);
  EXPECT_EQ(updateWith(2, 0), FROTH_OK);
  EXPECT_EQ(updateWith(3, 0), FROTH_OK);
  EXPECT_EQ(updateWith(4, 0), FROTH_ERROR_STATE);
  EXPECT_THAT(lastText(), HasSubstr("made for 3"));
  EXPECT_EQ(updateWith(4, 1), FROTH_OK);
}

TEST_F(Frames, InFlightAreEightAtMost) {
  FrothContextInfo info = nullContextInfo();
  info.framesInFlight = 9;
  EXPECT_EQ(frothCreateContext(&info, &context_), FROTH_ERROR_ARGUMENT);
}

TEST_F(Frames, CanBeDroppedOnceWhileInFlight) {
  createContext();
  EXPECT_EQ(frothDropFrame(context_, 1), FROTH_ERROR_STATE);
  ASSERT_EQ(updateWith(1, 0), FROTH_OK);
  ASSERT_EQ(updateWith(2, 0), FROTH_OK);
  EXPECT_EQ(frothDropFrame(context_, 2), FROTH_OK);
  EXPECT_EQ(frothDropFrame(context_, 2), FROTH_ERROR_STATE);
  EXPECT_EQ(updateWith(3, 0), FROTH_OK) << "a dropped frame is not in flight";
  ASSERT_EQ(updateWith(4, 3), FROTH_OK);
  EXPECT_EQ(frothDropFrame(context_, 1), FROTH_ERROR_STATE);
}

TEST_F(Frames, BeginWithAnUpdate) {
  createContext();
  EXPECT_EQ(frothRecordUpload(context_, nullptr), FROTH_ERROR_STATE);
  const FrothView view = createView({4, 4});
  const auto info = makeStruct<FrothRenderInfo>();
  EXPECT_EQ(frothRecordRaster(context_, view, nullptr, &info), FROTH_ERROR_STATE);
  EXPECT_THAT(lastText(), HasSubstr("call frothUpdate first"));
}

TEST_F(Frames, CountTheAssetsThatAreOpening) {
  createContext();
  openBytes(*encodeAsset(makeOneCellChunks(300)));  // more chunks than one frame decodes
  auto frame = makeStruct<FrothFrame>();
  frame.serial = 1;
  auto status = makeStruct<FrothFrameStatus>();
  ASSERT_EQ(frothUpdate(context_, &frame, &status), FROTH_OK);
  EXPECT_EQ(status.assetsOpening, 1u);
  frame.serial = 2;
  ASSERT_EQ(frothUpdate(context_, &frame, &status), FROTH_OK);
  EXPECT_EQ(status.assetsOpening, 0u);
  EXPECT_EQ(status.deviceBytes, 0u);
}

}  // namespace
}  // namespace froth
