// Models that nobody should trust get one message each: file, record, field, what was found, what to do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "tests/capture/colmap_sample.h"

namespace froth {
namespace {

using test::SampleModel;
using ::testing::AllOf;
using ::testing::HasSubstr;

// In either form; `parts` all stand in the message.
void expectBad(const SampleModel& model, const std::vector<std::string>& parts) {
  for (const test::ModelBytes& bytes : {test::binaryModel(model), test::textModel(model)}) {
    const Result<Capture> capture = parseModel(bytes);
    ASSERT_FALSE(capture) << parts[0];
    EXPECT_EQ(capture.error().kind, ErrorKind::kBadInput);
    EXPECT_THAT(capture.error().message, HasSubstr("; "));
    for (const std::string& part : parts) EXPECT_THAT(capture.error().message, HasSubstr(part));
  }
}

TEST(ColmapFaults, BinariesCutAtEachLengthAreRefused) {
  const test::ModelBytes whole = test::binaryModel({});
  std::string test::ModelBytes::*const files[] = {&test::ModelBytes::cameras, &test::ModelBytes::images,
                                                  &test::ModelBytes::points};
  const char* names[] = {"the cameras: ", "the images: ", "the points: "};
  for (size_t file = 0; file < 3; ++file) {
    for (size_t length = 0; length < (whole.*files[file]).size(); ++length) {
      test::ModelBytes cut = whole;
      (cut.*files[file]).resize(length);
      const Result<Capture> capture = parseModel(cut);
      ASSERT_FALSE(capture) << names[file] << length;
      ASSERT_THAT(capture.error().message, AllOf(HasSubstr(names[file]), HasSubstr("copy the whole file again")));
    }
    test::ModelBytes longer = whole;
    (longer.*files[file]) += '\0';
    const Result<Capture> capture = parseModel(longer);
    ASSERT_FALSE(capture) << names[file];
    EXPECT_THAT(capture.error().message, HasSubstr("1 bytes follow it"));
  }
}

TEST(ColmapFaults, CountsBeyondTheFileTakeNoMemory) {
  const auto spoil = [](std::string& bytes, size_t offset, uint64_t count = uint64_t{1} << 60) {
    std::memcpy(&bytes[offset], &count, sizeof count);
  };
  const test::ModelBytes whole = test::binaryModel({});
  for (std::string test::ModelBytes::*file :
       {&test::ModelBytes::cameras, &test::ModelBytes::images, &test::ModelBytes::points}) {
    test::ModelBytes spoilt = whole;
    spoil(spoilt.*file, 0);
    const Result<Capture> capture = parseModel(spoilt);
    ASSERT_FALSE(capture);
    EXPECT_THAT(capture.error().message, HasSubstr("header: field 'count': found 1152921504606846976"));
    // As many as there are bytes: none is that small.
    spoil(spoilt.*file, 0, (whole.*file).size() - 8);
    const Result<Capture> dense = parseModel(spoilt);
    ASSERT_FALSE(dense);
    EXPECT_THAT(dense.error().message, HasSubstr("header: field 'count'"));
  }
  test::ModelBytes observations = whole;
  spoil(observations.images, 8 + 4 + 32 + 24 + 4 + 8);  // behind the first image's name
  const Result<Capture> capture = parseModel(observations);
  ASSERT_FALSE(capture);
  EXPECT_THAT(capture.error().message, HasSubstr("image 0: field 'num_points2D': found 1152921504606846976"));
  test::ModelBytes track = whole;
  spoil(track.points, 8 + 8 + 24 + 3 + 8);
  EXPECT_FALSE(parseModel(track));
}

TEST(ColmapFaults, PosesAndIntrinsicsMustBeNumbers) {
  SampleModel model;
  model.images[2].translation[1] = NAN;
  expectBad(model, {"the images: image 5 ('c.jpg')", "'TX, TY, TZ': found (-1, nan, 2)"});
  model = {};
  model.images[2].rotation[0] = NAN;
  expectBad(model, {"image 5 ('c.jpg')", "nan", "unit quaternion"});
  model = {};
  model.images[2].rotation[0] = model.images[2].rotation[2] = 0;
  expectBad(model, {"image 5 ('c.jpg')", "(0, 0, 0, 0)"});
  model = {};
  model.cameras[0].parameters[1] = 0;
  expectBad(model, {"the cameras: camera 7", "'fy'", "found 0"});
  model = {};
  model.cameras[1].parameters[3] = INFINITY;
  expectBad(model, {"the cameras: camera 2", "'distortion'"});
  model = {};
  model.cameras[0].width = 0;
  expectBad(model, {"the cameras: camera 7", "'width'"});
  model = {};
  model.points[1].position[2] = NAN;
  expectBad(model, {"the points: point 3", "nan", "remove the point"});
}

TEST(ColmapFaults, IdsAndNamesMustFit) {
  SampleModel model;
  model.images[1].name = "c.jpg";
  expectBad(model, {"the images", "'c.jpg'", "both have the name"});
  model = {};
  model.images[1].id = 5;
  expectBad(model, {"the images: image 5", "stands twice"});
  model = {};
  model.cameras[1].id = 7;
  expectBad(model, {"the cameras: camera 7", "stands twice"});
  model = {};
  model.images[0].camera = 3;
  expectBad(model, {"the images: image 4 ('b 2.jpg')", "found 3, which the cameras lacks"});
  model = {};
  model.points[0].track.push_back(77);
  expectBad(model, {"the points: point 11", "found image 77"});
  model = {};
  model.images.clear();
  expectBad(model, {"the images", "no images"});
  for (const char* name : {"../a.jpg", "/etc/passwd", "a/../../b.jpg", "folder/"}) {
    model = {};
    model.images[0].name = name;
    expectBad(model, {"the images: image 4", "below the folder of the photos"});
  }
}

TEST(ColmapFaults, ModelsWithoutALensAreNamed) {
  SampleModel model;
  model.cameras[1] = {2, 7, "FOV", 320, 200, {300, 300, 160, 100, 0.9}};
  expectBad(model, {"the cameras: camera 2", "'FOV'", "OPENCV"});
  model.cameras[1] = {2, 99, "NEW", 320, 200, {300, 300, 160, 100}};
  const Result<Capture> binary = parseModel(test::binaryModel(model)), text = parseModel(test::textModel(model));
  ASSERT_FALSE(binary);
  EXPECT_THAT(binary.error().message, HasSubstr("camera 1: field 'model': found 99"));
  ASSERT_FALSE(text);
  EXPECT_THAT(text.error().message, HasSubstr("found 'NEW'"));
}

TEST(ColmapFaults, TextNamesTheLine) {
  test::ModelBytes bytes = test::textModel({});
  bytes.cameras = "# cameras\n7 PINHOLE 640 480 500 500 320\n";
  Result<Capture> capture = parseModel(bytes);
  ASSERT_FALSE(capture);
  EXPECT_THAT(capture.error().message, HasSubstr("camera 7, field 'PARAMS': found 3 numbers; PINHOLE has 4"));
  bytes.cameras = "# cameras\n\n7 PINHOLE 640 four\n";
  capture = parseModel(bytes);
  ASSERT_FALSE(capture);
  EXPECT_THAT(capture.error().message, HasSubstr("the cameras: line 3: field 'HEIGHT': found 'four'"));
  bytes = test::textModel({});
  bytes.images = "4 1 0 0 0 0 0\n\n";
  capture = parseModel(bytes);
  ASSERT_FALSE(capture);
  EXPECT_THAT(capture.error().message, HasSubstr("line 1: field 'TX, TY, TZ': found the end of the line"));
}

}  // namespace
}  // namespace froth
