// Points of PLY files: forms that are found in the wild, spoilt ones, and beside a transforms.json.
#include "reference/capture/ply_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/atomic_file.h"
#include "tests/surroundings.h"

namespace froth {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Result<std::vector<CapturedPoint>> parse(const std::string& text) {
  return parsePlyPoints({{reinterpret_cast<const uint8_t*>(text.data()), text.size()}, "a.ply"});
}

std::string header(const std::string& format, const std::string& element) {
  return "ply\nformat " + format + " 1.0\ncomment of a test\n" + element + "\nend_header\n";
}

constexpr const char* kPlace = "property float x\nproperty double y\nproperty short z";

std::string append(std::string text, auto number, std::endian order) {
  char bytes[sizeof(number)];
  std::memcpy(bytes, &number, sizeof(number));
  if (order != std::endian::native) std::reverse(std::begin(bytes), std::end(bytes));
  return text.append(bytes, sizeof(number));
}

TEST(PlyPoints, TextAndBothBinaryFormsAreRead) {
  const std::string colours =
      "\nproperty uchar red\nproperty float green\nproperty uint8 diffuse_blue\nproperty int id";
  const std::string element =
      "element vertex 1\n" + std::string(kPlace) + colours + "\nelement face 0\nproperty list uchar int i";
  std::vector<std::string> files = {header("ascii", element) + "1.5 -2e3\n 7 200 0.5 300 9"};
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    std::string text = header(order == std::endian::little ? "binary_little_endian" : "binary_big_endian", element);
    text = append(append(append(text, 1.5f, order), -2000.0, order), int16_t{7}, order);
    text = append(append(append(text, uint8_t{200}, order), 0.5f, order), uint8_t{255}, order);
    files.push_back(append(text, int32_t{9}, order));
  }
  for (const std::string& text : files) {
    const auto points = parse(text);
    ASSERT_TRUE(points) << points.error().message;
    ASSERT_EQ(points->size(), 1u);
    EXPECT_EQ((*points)[0].position, glm::dvec3(1.5, -2000, 7));
    EXPECT_THAT((*points)[0].colour, ElementsAre(200, 128, 255));
    EXPECT_EQ((*points)[0].observerCount, 0u);
  }
  const auto grey = parse(
      "ply\r\nformat ascii 1.0\r\nelement vertex 1\r\nproperty float x\r\nproperty float y\r\nproperty float "
      "z\r\nend_header\r\n1 2 3");
  ASSERT_TRUE(grey) << grey.error().message;
  EXPECT_THAT((*grey)[0].colour, ElementsAre(128, 128, 128));
}

TEST(PlyPoints, MessagesSayWhatIsWrong) {
  const std::string element = "element vertex 2\n" + std::string(kPlace);
  const std::pair<std::string, std::string> cases[] = {
      {"", "no PLY header"},
      {"version https://git-lfs.github.com/spec/v1\n", "no PLY header"},
      {"ply\nformat ascii 1.0\nelement vertex 390711\n", "header does not end"},
      {header("ascii", element) + "1 2 3 4.25 5.25", "vertex 1, field 'z': found no number"},
      {header("ascii", element) + "1 2 3 4 nan 5", "vertex 1, field 'y': found a number that is not finite"},
      {header("ascii", element) + "1 2 3 4 b 5", "vertex 1, field 'y': found no number"},
      {header("binary_little_endian", element) + std::string(27, '\0'),
       "found 2 vertices, which take at least 14 bytes each; the file has 27 bytes left"},
      {header("ascii", "element vertex 18446744073709551615\n" + std::string(kPlace)),
       "found 18446744073709551615 vertices"},
      {header("ascii", "element vertex -1\n" + std::string(kPlace)), "found element 'vertex' '-1'"},
      {header("ascii", "element face 0\n" + element), "put the vertices first"},
      {header("ascii", "element vertex 0\nproperty float x\nproperty float y"), "no 'z' of vertices"},
      {header("ascii", element + "\nproperty float x"), "found 'x' twice"},
      {header("ascii", element + "\nproperty list uchar int i"), "a property of type 'list'"},
      {header("binary", element), "found format 'binary'"},
      {"ply\n" + element + "\nend_header\n", "found no format"},
  };
  for (const auto& [text, message] : cases) {
    const auto points = parse(text);
    ASSERT_FALSE(points) << text;
    EXPECT_THAT(points.error().message, HasSubstr("a.ply: "));
    EXPECT_THAT(points.error().message, HasSubstr(message));
  }
}

TEST(PlyPoints, FilesOfOtherProgramsAreReadOrRefused) {
  const std::filesystem::path folder = test::dataFolder() / "malformed";
  if (!std::filesystem::exists(folder)) FROTH_SKIP() << "no " << folder;
  const std::pair<const char*, size_t> files[] = {{"assimp_ply/Wuson.ply", 11184},
                                                  {"assimp_ply/cube.ply", 8},
                                                  {"assimp_ply/cube_binary.ply", 8},
                                                  {"assimp_ply/cube_binary_header_with_RN_newline.ply", 8},
                                                  {"assimp_ply/cube_binary_starts_with_nl.ply", 8},
                                                  {"assimp_ply/cube_uv.ply", 24},
                                                  {"assimp_ply/float-color.ply", 3},
                                                  {"assimp_ply/points.ply", 4},
                                                  {"assimp_ply/pond.0.ply", 70051},
                                                  {"assimp_ply/empty.ply", 0},
                                                  {"assimp_ply/issue623.ply", 0},
                                                  {"assimp_ply/crash-30d6d0f7c529b3b66b4131700b7a4580cd7082df.ply", 0},
                                                  {"lfs_pointer.ply", 0},
                                                  {"sb_output_43_bytes.ply", 0}};
  for (const auto& [name, count] : files) {
    const Result<std::vector<uint8_t>> bytes = readFile(folder / name);
    ASSERT_TRUE(bytes) << bytes.error().message;
    const auto points = parsePlyPoints({*bytes, name});
    EXPECT_EQ(points ? points->size() : 0, count) << name << (points ? "" : ": " + points.error().message);
  }
}

}  // namespace
}  // namespace froth
