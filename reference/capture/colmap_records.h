// A COLMAP model as its three files hold it, before anything in it is believed. Internal to colmap.h.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "base/result.h"
#include "foam/checkpoint/bad_input.h"

namespace froth {

struct ColmapCamera {
  uint32_t id = 0;
  std::string model;  // "OPENCV"
  uint64_t width = 0, height = 0;
  std::vector<double> parameters;
};

struct ColmapImage {
  uint32_t id = 0;
  std::array<double, 4> rotation{};  // (w, x, y, z) of cameraFromWorld
  glm::dvec3 translation{0};
  uint32_t camera = 0;
  std::string name;
};

struct ColmapPoint {
  uint64_t id = 0;
  glm::dvec3 position{0};
  std::array<uint8_t, 3> colour{};
  std::vector<uint32_t> track;  // ids of images, in any order, some twice
};

// Models in COLMAP's numbering: name and count of parameters.
struct ColmapModel {
  const char* name;
  uint32_t parameterCount;
};
constexpr ColmapModel kColmapModels[] = {{"SIMPLE_PINHOLE", 3},
                                         {"PINHOLE", 4},
                                         {"SIMPLE_RADIAL", 4},
                                         {"RADIAL", 5},
                                         {"OPENCV", 8},
                                         {"OPENCV_FISHEYE", 8},
                                         {"FULL_OPENCV", 12},
                                         {"FOV", 5},
                                         {"SIMPLE_RADIAL_FISHEYE", 4},
                                         {"RADIAL_FISHEYE", 5},
                                         {"THIN_PRISM_FISHEYE", 12}};

// Files of one form. Counts are compared with what the bytes can hold before memory is taken for them.
Result<std::vector<ColmapCamera>> readBinaryCameras(const NamedBytes& file);
Result<std::vector<ColmapImage>> readBinaryImages(const NamedBytes& file);
Result<std::vector<ColmapPoint>> readBinaryPoints(const NamedBytes& file);

Result<std::vector<ColmapCamera>> readTextCameras(const NamedBytes& file);
Result<std::vector<ColmapImage>> readTextImages(const NamedBytes& file);
Result<std::vector<ColmapPoint>> readTextPoints(const NamedBytes& file);

}  // namespace froth
