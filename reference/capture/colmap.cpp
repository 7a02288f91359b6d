#include "reference/capture/colmap.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <glm/gtc/quaternion.hpp>

#include "base/atomic_file.h"
#include "reference/camera/view_check.h"
#include "reference/capture/capture_names.h"
#include "reference/capture/colmap_records.h"

namespace froth {
namespace {

// COLMAP writes unit quaternions; one this far from them is damaged and not rounded.
constexpr double kQuaternionTolerance = 1e-3;

Status checkParameterCount(const ColmapCamera& camera, const std::string& file) {
  for (const ColmapModel& model : kColmapModels) {
    if (camera.model != model.name || camera.parameters.size() == model.parameterCount) continue;
    return badInput(file, "camera {}, field 'PARAMS': found {} numbers; {} has {}", camera.id, camera.parameters.size(),
                    model.name, model.parameterCount);
  }
  return {};
}

// Where each parameter of a model goes: one or two focal lengths, the principal point, coefficients in COLMAP's order,
// which is OpenCV's.
Status setLens(const ColmapCamera& camera, const std::string& file, View& view) {
  if (Status status = checkParameterCount(camera, file); !status) return status;
  const std::string& model = camera.model;
  const std::vector<double>& p = camera.parameters;
  const bool isPinhole = model == "PINHOLE" || model == "SIMPLE_PINHOLE";
  const bool isFisheye = model == "OPENCV_FISHEYE" || model == "SIMPLE_RADIAL_FISHEYE" || model == "RADIAL_FISHEYE";
  const bool isRadial = model == "SIMPLE_RADIAL" || model == "RADIAL" || model == "OPENCV" || model == "FULL_OPENCV";
  if (!isPinhole && !isFisheye && !isRadial) {
    return badInput(file,
                    "camera {}, field 'MODEL': found {}; calibrate with PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV, "
                    "FULL_OPENCV or OPENCV_FISHEYE",
                    camera.id, froth::quoted(model));
  }
  const bool hasOneLength = model.starts_with("SIMPLE_") || model.starts_with("RADIAL");
  const size_t centre = hasOneLength ? 1 : 2;
  view.fx = p[0];
  view.fy = p[centre - 1];
  view.cx = p[centre];
  view.cy = p[centre + 1];
  if (isPinhole) return {};
  view.lens.kind = isFisheye ? LensKind::kKannalaBrandt : LensKind::kRadialTangential;
  view.lens.distortion.assign(p.begin() + static_cast<ptrdiff_t>(centre) + 2, p.end());
  view.lens.distortion.resize(std::max<size_t>(view.lens.distortion.size(), 4), 0.0);
  return {};
}

Result<std::map<uint32_t, View>> indexCameras(const std::vector<ColmapCamera>& cameras, const std::string& file) {
  std::map<uint32_t, View> views;
  for (const ColmapCamera& camera : cameras) {
    View view;
    view.width = static_cast<uint32_t>(std::min<uint64_t>(camera.width, UINT32_MAX));
    view.height = static_cast<uint32_t>(std::min<uint64_t>(camera.height, UINT32_MAX));
    if (Status status = setLens(camera, file, view); !status) return status.error();
    view.worldFromCamera = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    if (Status status = checkView(view, fmt::format("{}: camera {}", file, camera.id)); !status) return status.error();
    if (!views.emplace(camera.id, std::move(view)).second) {
      return badInput(file, "camera {}: stands twice; keep one of them", camera.id);
    }
  }
  return views;
}

// COLMAP states cameraFromWorld.
Status setPose(const ColmapImage& image, const std::string& file, View& view) {
  const auto& q = image.rotation;
  const glm::dvec4 components(q[0], q[1], q[2], q[3]);
  const double length = glm::length(components);
  if (!(std::abs(length - 1) <= kQuaternionTolerance)) {
    return badInput(file, "image {} ({}), field 'QW, QX, QY, QZ': found ({}, {}, {}, {}); give a unit quaternion",
                    image.id, froth::quoted(image.name), q[0], q[1], q[2], q[3]);
  }
  const glm::dvec3& t = image.translation;
  if (!std::isfinite(t.x) || !std::isfinite(t.y) || !std::isfinite(t.z)) {
    return badInput(file, "image {} ({}), field 'TX, TY, TZ': found ({}, {}, {}); give finite numbers", image.id,
                    froth::quoted(image.name), t.x, t.y, t.z);
  }
  const glm::dmat3 worldFromCamera =
      glm::transpose(glm::mat3_cast(glm::dquat(q[0] / length, q[1] / length, q[2] / length, q[3] / length)));
  const glm::dvec3 eye = -(worldFromCamera * t);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) view.worldFromCamera[row * 4 + column] = worldFromCamera[column][row];
    view.worldFromCamera[row * 4 + 3] = eye[row];
  }
  return checkView(view, fmt::format("{}: image {} ({})", file, image.id, froth::quoted(image.name)));
}

Result<std::vector<CapturedView>> makeViews(const std::vector<ColmapImage>& images,
                                            const std::map<uint32_t, View>& cameras, const ColmapFiles& files) {
  const std::string& file = files.images.name;
  std::vector<CapturedView> views;
  for (const ColmapImage& image : images) {
    const auto camera = cameras.find(image.camera);
    if (camera == cameras.end()) {
      return badInput(file, "image {} ({}), field 'CAMERA_ID': found {}, which {} lacks; export both files together",
                      image.id, froth::quoted(image.name), image.camera, files.cameras.name);
    }
    const std::string place = fmt::format("{}: image {}, field 'NAME'", file, image.id);
    if (Status status = checkPhotoName(image.name, place); !status) return status.error();
    CapturedView& view = views.emplace_back();
    view.view = camera->second;
    view.view.name = image.name;
    if (Status status = setPose(image, file, view.view); !status) return status.error();
  }
  return views;
}

// The view of each image id.
Result<std::map<uint32_t, uint32_t>> indexImages(const std::vector<ColmapImage>& images, const std::string& file) {
  std::map<uint32_t, uint32_t> viewOf;
  for (size_t i = 0; i < images.size(); ++i) {
    if (!viewOf.emplace(images[i].id, static_cast<uint32_t>(i)).second) {
      return badInput(file, "image {}: stands twice; keep one of them", images[i].id);
    }
    if (i > 0 && images[i].name == images[i - 1].name) {
      return badInput(file, "images {} and {}: both have the name {}; keep one of them", images[i - 1].id, images[i].id,
                      froth::quoted(images[i].name));
    }
  }
  return viewOf;
}

Status addPoints(const std::vector<ColmapPoint>& points, const std::map<uint32_t, uint32_t>& viewOf,
                 const ColmapFiles& files, Capture& capture) {
  const std::string& file = files.points.name;
  capture.points.reserve(points.size());
  for (const ColmapPoint& point : points) {
    const glm::dvec3& x = point.position;
    if (!std::isfinite(x.x) || !std::isfinite(x.y) || !std::isfinite(x.z)) {
      return badInput(file, "point {}, field 'XYZ': found ({}, {}, {}); remove the point", point.id, x.x, x.y, x.z);
    }
    const uint64_t first = capture.observers.size();
    for (const uint32_t image : point.track) {
      const auto view = viewOf.find(image);
      if (view == viewOf.end()) {
        return badInput(file, "point {}, field 'TRACK': found image {}, which {} lacks; export both files together",
                        point.id, image, files.images.name);
      }
      capture.observers.push_back(view->second);
    }
    const auto begin = capture.observers.begin() + static_cast<ptrdiff_t>(first);
    std::sort(begin, capture.observers.end());
    capture.observers.erase(std::unique(begin, capture.observers.end()), capture.observers.end());
    const auto count = static_cast<uint32_t>(capture.observers.size() - first);
    capture.points.push_back({point.position, point.colour, first, count});
  }
  return {};
}

}  // namespace

Result<Capture> parseColmap(const ColmapFiles& files) {
  const auto cameras = files.isBinary ? readBinaryCameras(files.cameras) : readTextCameras(files.cameras);
  if (!cameras) return cameras.error();
  auto images = files.isBinary ? readBinaryImages(files.images) : readTextImages(files.images);
  if (!images) return images.error();
  const auto points = files.isBinary ? readBinaryPoints(files.points) : readTextPoints(files.points);
  if (!points) return points.error();
  if (images->empty()) return badInput(files.images.name, "found no images; match the photos and map them again");

  const auto lenses = indexCameras(*cameras, files.cameras.name);
  if (!lenses) return lenses.error();
  std::stable_sort(images->begin(), images->end(),
                   [](const ColmapImage& a, const ColmapImage& b) { return a.name < b.name; });
  const auto viewOf = indexImages(*images, files.images.name);
  if (!viewOf) return viewOf.error();
  Capture capture;
  Result<std::vector<CapturedView>> views = makeViews(*images, *lenses, files);
  if (!views) return views.error();
  capture.views = std::move(*views);
  if (Status status = addPoints(*points, *viewOf, files, capture); !status) return status.error();
  return capture;
}

bool hasColmapModel(const std::filesystem::path& folder) {
  return std::filesystem::exists(folder / "cameras.bin") || std::filesystem::exists(folder / "cameras.txt");
}

Result<Capture> readColmapModel(const std::filesystem::path& folder) {
  const bool isBinary = std::filesystem::exists(folder / "cameras.bin");
  const char* extension = isBinary ? ".bin" : ".txt";
  std::vector<uint8_t> bytes[3];
  NamedBytes files[3];
  for (size_t i = 0; i < 3; ++i) {
    constexpr const char* kStems[] = {"cameras", "images", "points3D"};
    const std::filesystem::path path = folder / (std::string(kStems[i]) + extension);
    Result<std::vector<uint8_t>> read = readFile(path);
    if (!read) return read.error();
    bytes[i] = std::move(*read);
    files[i] = {bytes[i], path.string()};
  }
  return parseColmap({files[0], files[1], files[2], isBinary});
}

}  // namespace froth
