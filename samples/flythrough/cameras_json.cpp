#include "samples/flythrough/cameras_json.h"

#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

namespace froth {
namespace {

Pose readPose(const nlohmann::json& view) {
  double matrix[12];
  for (size_t i = 0; i < 12; ++i) matrix[i] = view.at("world_from_camera").at(i / 4).at(i % 4).get<double>();
  return poseFromMatrix(matrix, view.at("height").get<double>() / (2.0 * view.at("fy").get<double>()));
}

bool isUsable(const Pose& pose) {
  const auto& q = pose.worldFromCamera;
  const double sum = pose.eye.x + pose.eye.y + pose.eye.z + q.x + q.y + q.z + q.w;
  return std::isfinite(sum) && std::isfinite(pose.tanHalfFovY) && pose.tanHalfFovY > 0;
}

}  // namespace

Result<std::vector<Pose>> readKeyPoses(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) return makeError(ErrorKind::kBadInput, "%s: cannot be opened; check the name", path.c_str());
  std::vector<Pose> poses;
  try {
    const nlohmann::json root = nlohmann::json::parse(file);
    const char* list = root.contains("flight") && !root["flight"].empty() ? "flight" : "views";
    for (const nlohmann::json& view : root.at(list)) {
      poses.push_back(readPose(view));
      if (isUsable(poses.back())) continue;
      return makeError(ErrorKind::kBadInput,
                       "%s: %s %zu: the pose or focal length is not finite and positive; correct it",
                       path.c_str(), list, poses.size() - 1);
    }
  } catch (const nlohmann::json::exception& fault) {
    return makeError(ErrorKind::kBadInput, "%s: view %zu: %s; docs/CAMERAS.md shows the layout", path.c_str(),
                     poses.size(), fault.what());
  }
  if (poses.empty())
    return makeError(ErrorKind::kBadInput, "%s: field 'views': holds none; add a view", path.c_str());
  return poses;
}

}  // namespace froth
