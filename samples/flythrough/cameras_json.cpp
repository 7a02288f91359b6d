#include "samples/flythrough/cameras_json.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "base/atomic_file.h"

namespace froth {
namespace {

// Orthonormal and not mirrored. False for nan.
bool isRotation(const glm::dmat3& matrix) {
  constexpr double kTolerance = 1e-4;  // docs/CAMERAS.md
  const glm::dmat3 product = glm::transpose(matrix) * matrix;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) {
      if (!(std::abs(product[column][row] - (column == row)) <= kTolerance)) return false;
    }
  }
  return glm::determinant(matrix) > 0;
}

Result<Pose> readPose(const nlohmann::json& view) {
  double matrix[12];
  for (size_t i = 0; i < 12; ++i) matrix[i] = view.at("world_from_camera").at(i / 4).at(i % 4).get<double>();
  const glm::dmat3 columns(matrix[0], matrix[4], matrix[8], matrix[1], matrix[5], matrix[9], matrix[2], matrix[6],
                           matrix[10]);
  if (!isRotation(columns)) {
    return makeError(ErrorKind::kBadInput,
                     "field 'world_from_camera': found a determinant of %.6g; give a rotation without scale in "
                     "the first three columns",
                     glm::determinant(columns));
  }
  const double height = view.at("height").get<double>(), fy = view.at("fy").get<double>();
  if (!(height > 0 && fy > 0)) {
    return makeError(ErrorKind::kBadInput, "fields 'height' and 'fy': found %.6g and %.6g; give numbers > 0", height,
                     fy);
  }
  return poseFromMatrix(matrix, height / (2.0 * fy));
}

}  // namespace

Result<std::vector<Pose>> readKeyPoses(const std::filesystem::path& path) {
  const Result<std::vector<uint8_t>> text = readFile(path);
  if (!text) return text.error();
  std::vector<Pose> poses;
  const char* list = "views";
  try {
    const nlohmann::json root = nlohmann::json::parse(*text);
    if (root.contains("flight") && !root["flight"].empty()) list = "flight";
    for (const nlohmann::json& view : root.at(list)) {
      const Result<Pose> pose = readPose(view);
      if (!pose) {
        return makeError(ErrorKind::kBadInput, "%s: %s %zu, %s", path.c_str(), list, poses.size(),
                         pose.error().message.c_str());
      }
      poses.push_back(*pose);
    }
  } catch (const nlohmann::json::parse_error& fault) {
    return makeError(ErrorKind::kBadInput, "%s: not JSON (%s); docs/CAMERAS.md shows the layout", path.c_str(),
                     fault.what());
  } catch (const nlohmann::json::exception& fault) {
    return makeError(ErrorKind::kBadInput, "%s: %s %zu: %s; docs/CAMERAS.md shows the layout", path.c_str(), list,
                     poses.size(), fault.what());
  }
  if (poses.empty()) return makeError(ErrorKind::kBadInput, "%s: field 'views': holds none; add a view", path.c_str());
  return poses;
}

}  // namespace froth
