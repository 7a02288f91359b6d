#include "reference/capture/transforms.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "base/json_input.h"
#include "foam/checkpoint/bad_input.h"
#include "reference/camera/view_check.h"
#include "reference/capture/capture_names.h"

namespace froth {
namespace {

using Json = nlohmann::json;

constexpr const char* kRemedy = "write it as nerfstudio or instant-ngp do";

// Fields of a frame, or else of the file. The first fault is kept; later reads then return nothing.
class FrameReader {
 public:
  FrameReader(const Json& root, const Json& frame, std::string place)
      : root_(root), frame_(frame), place_(std::move(place)) {}

  const Json* find(const char* key) const {
    for (const Json* object : {&frame_, &root_}) {
      if (const auto it = object->find(key); it != object->end() && !it->is_null()) return &*it;
    }
    return nullptr;
  }

  std::optional<double> number(const char* key) {
    const Json* value = find(key);
    if (!value) return std::nullopt;
    if (value->is_number() && std::isfinite(value->get<double>())) return value->get<double>();
    fail(key, describe(*value), "give a finite number");
    return std::nullopt;
  }

  bool flag(const char* key) {
    const Json* value = find(key);
    if (!value) return false;
    if (value->is_boolean()) return value->get<bool>();
    fail(key, describe(*value), "give true or false");
    return false;
  }

  std::string text(const char* key) {
    const Json* value = find(key);
    if (!value) return {};
    if (value->is_string()) return value->get<std::string>();
    fail(key, describe(*value), "give a text in quotes");
    return {};
  }

  static std::string describe(const Json& value) {
    if (value.is_number()) return value.dump();
    return value.is_string() ? froth::quoted(value.get_ref<const std::string&>()) : std::string(value.type_name());
  }

  void fail(const char* key, const std::string& found, const std::string& remedy) {
    if (!error_) error_ = badInput(place_, "field '{}': found {}; {}", key, found, remedy);
  }

  const std::string& place() const { return place_; }
  const std::optional<Error>& error() const { return error_; }

 private:
  const Json& root_;
  const Json& frame_;
  std::string place_;
  std::optional<Error> error_;
};

std::optional<uint32_t> readSide(FrameReader& fields, const char* key) {
  const std::optional<double> side = fields.number(key);
  if (!side) return std::nullopt;
  if (*side >= 1 && *side <= 65536 && *side == std::floor(*side)) return static_cast<uint32_t>(*side);
  fields.fail(key, fmt::format("{}", *side), "give a whole number of pixels, 1 to 65536");
  return std::nullopt;
}

Status setSize(FrameReader& fields, const PhotoSizes& sizes, View& view) {
  const std::optional<uint32_t> width = readSide(fields, "w"), height = readSide(fields, "h");
  if (fields.error()) return *fields.error();
  if (width && height) {
    view.width = *width;
    view.height = *height;
    return {};
  }
  const Result<ImageSize> size = sizes(view.name);
  if (!size) return size.error();
  view.width = size->width;
  view.height = size->height;
  return {};
}

// Pixels from a focal length, or from the angle that the whole side is seen at; none: neither is given.
std::optional<double> focalLength(FrameReader& fields, const char* lengthKey, const char* angleKey, uint32_t side) {
  if (const std::optional<double> length = fields.number(lengthKey)) return length;
  const std::optional<double> angle = fields.number(angleKey);
  if (!angle) return std::nullopt;
  if (*angle > 0 && *angle < 3.14159) return 0.5 * side / std::tan(0.5 * *angle);
  fields.fail(angleKey, fmt::format("{}", *angle), "give an angle in radians, above 0 and below pi");
  return std::nullopt;
}

void setLens(FrameReader& fields, View& view) {
  const std::string model = fields.text("camera_model");
  const bool isFisheye = fields.flag("is_fisheye") || model == "OPENCV_FISHEYE";
  const bool isKnown = model.empty() || isFisheye || model == "OPENCV" || model == "PINHOLE" ||
                       model == "SIMPLE_PINHOLE" || model == "SIMPLE_RADIAL" || model == "RADIAL";
  if (!isKnown) fields.fail("camera_model", froth::quoted(model), "give OPENCV, OPENCV_FISHEYE or PINHOLE");
  const auto coefficient = [&](const char* key) { return fields.number(key).value_or(0); };
  const double k1 = coefficient("k1"), k2 = coefficient("k2"), k3 = coefficient("k3"), k4 = coefficient("k4");
  if (isFisheye) {
    view.lens = {LensKind::kKannalaBrandt, {k1, k2, k3, k4}, nullptr, {}};
    return;
  }
  // nerfstudio's k4 belongs to r^8, which OpenCV's lens lacks.
  if (k4 != 0) fields.fail("k4", fmt::format("{}", k4), "give 0, or is_fisheye: the lens has terms up to k3");
  const std::vector<double> distortion = {k1, k2, coefficient("p1"), coefficient("p2"), k3};
  const bool isDistorted = std::any_of(distortion.begin(), distortion.end(), [](double k) { return k != 0; });
  if (isDistorted) view.lens = {LensKind::kRadialTangential, distortion, nullptr, {}};
}

Status setIntrinsics(FrameReader& fields, const PhotoSizes& sizes, View& view) {
  if (Status status = setSize(fields, sizes, view); !status) return status;
  const std::optional<double> fx = focalLength(fields, "fl_x", "camera_angle_x", view.width);
  const std::optional<double> fy = focalLength(fields, "fl_y", "camera_angle_y", view.height);
  if (!fx && !fy) fields.fail("fl_x", "nothing", "give it in pixels, or camera_angle_x in radians");
  view.fx = fx.value_or(fy.value_or(0));
  view.fy = fy.value_or(fx.value_or(0));
  view.cx = fields.number("cx").value_or(0.5 * view.width);
  view.cy = fields.number("cy").value_or(0.5 * view.height);
  setLens(fields, view);
  return fields.error() ? Status(*fields.error()) : Status();
}

// The file's camera axes are right, up, back: columns 1 and 2 change their signs.
Status setPose(FrameReader& fields, View& view) {
  const char* const key = "transform_matrix";
  constexpr const char* kGive = "give 3 or 4 rows of 4 finite numbers";
  const Json* rows = fields.find(key);
  if (!rows || !rows->is_array() || rows->size() < 3 || rows->size() > 4) {
    fields.fail(key, rows ? FrameReader::describe(*rows) : "nothing", kGive);
    return *fields.error();
  }
  for (int row = 0; row < 3; ++row) {
    const Json& numbers = (*rows)[row];
    for (int column = 0; column < 4; ++column) {
      if (!numbers.is_array() || numbers.size() != 4 || !numbers[column].is_number()) {
        fields.fail(key, fmt::format("no number in row {}, column {}", row, column), kGive);
        return *fields.error();
      }
      const double sign = column == 1 || column == 2 ? -1 : 1;
      view.worldFromCamera[row * 4 + column] = sign * numbers[column].get<double>();
    }
  }
  return {};
}

// nerfstudio's lists of the frames of each part.
struct PartNames {
  std::set<std::string> training, test;
};

Status readPartList(const Json& root, const char* key, const std::string& file, std::set<std::string>& names) {
  const auto list = root.find(key);
  if (list == root.end()) return {};
  if (!list->is_array()) return badInput(file, "field '{}': found {}; give an array of names", key, list->type_name());
  for (const Json& name : *list) {
    if (!name.is_string()) return badInput(file, "field '{}': found {}; give names", key, FrameReader::describe(name));
    names.insert(name.get<std::string>());
  }
  return {};
}

Result<PartNames> readParts(const Json& root, const std::string& file) {
  PartNames parts;
  if (Status status = readPartList(root, "train_filenames", file, parts.training); !status) return status.error();
  if (Status status = readPartList(root, "test_filenames", file, parts.test); !status) return status.error();
  if (!parts.test.empty()) return parts;
  if (Status status = readPartList(root, "val_filenames", file, parts.test); !status) return status.error();
  return parts;
}

// nerfstudio's points, in the frame of the poses.
Status readPointFile(const Json& root, const std::string& file, std::filesystem::path& pointFile) {
  const auto name = root.find("ply_file_path");
  if (name == root.end() || name->is_null()) return {};
  const std::string place = file + ", field 'ply_file_path'";
  if (!name->is_string()) return badInput(place, "found {}; give the name of a file", FrameReader::describe(*name));
  pointFile = name->get<std::string>();
  return checkPhotoName(name->get<std::string>(), place);
}

Result<CapturedView> readFrame(const Json& root, const Json& frame, const std::string& place, const PartNames& parts,
                               const PhotoSizes& sizes) {
  if (!frame.is_object()) return badInput(place, "found {}; give an object", frame.type_name());
  FrameReader fields(root, frame, place);
  CapturedView view;
  const std::string path = fields.text("file_path");
  view.mask = fields.text("mask_path");
  if (fields.error()) return *fields.error();
  if (Status status = checkPhotoName(path, place + ", field 'file_path'"); !status) return status.error();
  if (!view.mask.empty()) {
    if (Status status = checkPhotoName(view.mask.string(), place + ", field 'mask_path'"); !status) {
      return status.error();
    }
  }
  std::filesystem::path name = std::filesystem::path(path).lexically_normal();
  if (!name.has_extension()) name += ".png";  // as the synthetic scenes of NeRF leave it out
  view.photo = name;
  view.view.name = name.string();
  if (parts.training.contains(path)) view.part = CapturePart::kTraining;
  if (parts.test.contains(path)) view.part = CapturePart::kTest;
  if (Status status = setIntrinsics(fields, sizes, view.view); !status) return status.error();
  if (Status status = setPose(fields, view.view); !status) return status.error();
  if (Status status = checkView(view.view, place); !status) return status.error();
  return view;
}

}  // namespace

Result<Capture> parseTransforms(std::span<const uint8_t> bytes, const std::string& file, const PhotoSizes& sizes) {
  const Result<Json> root = parseJson(bytes, file, kRemedy);
  if (!root) return root.error();
  if (!root->is_object()) return badInput(file, "found {}; {}", root->type_name(), kRemedy);
  const auto frames = root->find("frames");
  if (frames == root->end() || !frames->is_array() || frames->empty()) {
    return badInput(file, "field 'frames': found {}; give an array of frames, one per photo",
                    frames == root->end() ? "nothing"
                    : frames->is_array()  ? "no frame"
                                          : frames->type_name());
  }
  const Result<PartNames> parts = readParts(*root, file);
  if (!parts) return parts.error();
  Capture capture;
  if (Status read = readPointFile(*root, file, capture.pointFile); !read) return read.error();
  for (size_t i = 0; i < frames->size(); ++i) {
    Result<CapturedView> view = readFrame(*root, (*frames)[i], fmt::format("{}: frame {}", file, i), *parts, sizes);
    if (!view) return view.error();
    capture.views.push_back(std::move(*view));
  }
  return capture;
}

}  // namespace froth
