// A small COLMAP model that tests write in either form, and spoil.
#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>

#include "foam/checkpoint/little_endian.h"
#include "reference/capture/colmap.h"

namespace froth::test {

struct SampleCamera {
  uint32_t id;
  int32_t model;
  const char* modelName;
  uint64_t width, height;
  std::vector<double> parameters;
};

struct SampleImage {
  uint32_t id;
  double rotation[4], translation[3];
  uint32_t camera;
  std::string name;
};

struct SamplePoint {
  uint64_t id;
  double position[3];
  uint8_t colour[3];
  std::vector<uint32_t> track;
};

struct SampleModel {
  // Ids and names are in no order.
  std::vector<SampleCamera> cameras = {{7, 1, "PINHOLE", 640, 480, {500.5, 501, 321, 239}},
                                       {2, 2, "SIMPLE_RADIAL", 320, 200, {300, 160, 100, -0.1}}};
  std::vector<SampleImage> images = {{4, {1, 0, 0, 0}, {0, 0, 0}, 7, "b 2.jpg"},
                                     {9, {0, 1, 0, 0}, {1, 2, 3}, 2, "a/1.jpg"},
                                     {5, {0.6, 0, 0.8, 0}, {-1, 0.5, 2}, 7, "c.jpg"}};
  std::vector<SamplePoint> points = {{11, {1, 2, 3}, {10, 20, 30}, {5, 9, 5}}, {3, {-1, 0.25, 8}, {255, 0, 1}, {4}}};
};

struct ModelBytes {
  std::string cameras, images, points;
  bool isBinary = true;
};

inline ModelBytes binaryModel(const SampleModel& model) {
  ModelBytes bytes;
  appendLittleEndian(bytes.cameras, uint64_t{model.cameras.size()});
  for (const SampleCamera& camera : model.cameras) {
    appendLittleEndian(bytes.cameras, camera.id);
    appendLittleEndian(bytes.cameras, camera.model);
    appendLittleEndian(bytes.cameras, camera.width);
    appendLittleEndian(bytes.cameras, camera.height);
    for (const double parameter : camera.parameters) appendLittleEndian(bytes.cameras, parameter);
  }
  appendLittleEndian(bytes.images, uint64_t{model.images.size()});
  for (const SampleImage& image : model.images) {
    appendLittleEndian(bytes.images, image.id);
    for (const double component : image.rotation) appendLittleEndian(bytes.images, component);
    for (const double component : image.translation) appendLittleEndian(bytes.images, component);
    appendLittleEndian(bytes.images, image.camera);
    bytes.images += image.name + '\0';
    appendLittleEndian(bytes.images, uint64_t{1});
    appendLittleEndian(bytes.images, 1.5);
    appendLittleEndian(bytes.images, 2.5);
    appendLittleEndian(bytes.images, int64_t{-1});
  }
  appendLittleEndian(bytes.points, uint64_t{model.points.size()});
  for (const SamplePoint& point : model.points) {
    appendLittleEndian(bytes.points, point.id);
    for (const double component : point.position) appendLittleEndian(bytes.points, component);
    for (const uint8_t channel : point.colour) appendLittleEndian(bytes.points, channel);
    appendLittleEndian(bytes.points, 0.5);
    appendLittleEndian(bytes.points, uint64_t{point.track.size()});
    for (const uint32_t image : point.track) {
      appendLittleEndian(bytes.points, image);
      appendLittleEndian(bytes.points, uint32_t{0});
    }
  }
  return bytes;
}

inline ModelBytes textModel(const SampleModel& model) {
  ModelBytes bytes{"# cameras\n", "# images\r\n", "\n# points\n", false};
  for (const SampleCamera& camera : model.cameras) {
    bytes.cameras += fmt::format("{} {} {} {} {}\n", camera.id, camera.modelName, camera.width, camera.height,
                                 fmt::join(camera.parameters, " "));
  }
  for (const SampleImage& image : model.images) {
    bytes.images +=
        fmt::format("{} {} {} {} {}\r\n{}\r\n", image.id, fmt::join(image.rotation, " "),
                    fmt::join(image.translation, " "), image.camera, image.name, image.id == 4 ? "" : "1.5 2.5 -1");
  }
  for (const SamplePoint& point : model.points) {
    bytes.points += fmt::format("{} {} {} 0.5", point.id, fmt::join(point.position, " "), fmt::join(point.colour, " "));
    for (const uint32_t image : point.track) bytes.points += fmt::format(" {} 0", image);
    bytes.points += "\n";
  }
  return bytes;
}

inline Result<Capture> parseModel(const ModelBytes& model) {
  const auto named = [](const std::string& bytes, const char* name) {
    return NamedBytes{{reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, name};
  };
  return parseColmap({named(model.cameras, "the cameras"), named(model.images, "the images"),
                      named(model.points, "the points"), model.isBinary});
}

}  // namespace froth::test
