// Reading and writing cameras.json (docs/CAMERAS.md).
#include <nlohmann/json.hpp>

#include <algorithm>
#include <initializer_list>

#include "base/atomic_file.h"
#include "base/json_input.h"
#include "reference/camera/camera.h"
#include "reference/camera/ray_map.h"
#include "reference/camera/view_check.h"

namespace froth {
namespace {

using Json = nlohmann::json;
using WrittenJson = nlohmann::ordered_json;  // keeps keys in their order; many take it quadratic time

// As cameras.json names the lenses, in the order of LensKind.
constexpr const char* kLensNames[] = {"pinhole",         "fisheye", "kannala_brandt", "radial_tangential",
                                      "equirectangular", "ray_map", "orthographic"};

// Fields of one JSON object. The first fault is kept; later reads then return defaults.
class FieldReader {
 public:
  FieldReader(const Json& object, std::string place) : object_(object), place_(std::move(place)) {
    if (!object.is_object()) {
      error_ = makeError(ErrorKind::kBadInput, "%s: found %s; give an object", place_.c_str(), object.type_name());
    }
  }

  // A misspelt key would silently change the image: refuse what is not known.
  void refuseOthers(std::initializer_list<const char*> known) {
    if (error_) return;
    for (const auto& [key, value] : object_.items()) {
      const bool isKnown = std::find(known.begin(), known.end(), key) != known.end();
      if (!isKnown) {
        return fail(key.c_str(), "an unknown field", "remove it, or check its spelling against docs/CAMERAS.md");
      }
    }
  }

  const Json* find(const char* key) const {
    if (error_) return nullptr;
    const auto it = object_.find(key);
    return it == object_.end() ? nullptr : &*it;
  }

  uint32_t readSize(const char* key) {
    const Json* value = require(key);
    if (!value) return 0;
    if (value->is_number_unsigned() && value->get<uint64_t>() <= UINT32_MAX) return value->get<uint32_t>();
    fail(key, describe(*value), "give a whole number of pixels, 1 to 65536");
    return 0;
  }

  double readNumber(const char* key) {
    const Json* value = require(key);
    return value ? asNumber(key, *value) : 0;
  }

  std::optional<double> readOptionalNumber(const char* key) {
    const Json* value = find(key);
    return value ? std::optional(asNumber(key, *value)) : std::nullopt;
  }

  std::string readText(const char* key) {
    const Json* value = find(key);
    if (!value) return {};
    if (value->is_string()) return value->get<std::string>();
    fail(key, describe(*value), "give a text in quotes");
    return {};
  }

  // A file beside cameras.json: a name without a folder, so that a foreign file cannot point anywhere else.
  std::string readFileName(const char* key) {
    std::string name = readText(key);
    if (name == ".." || name.find_first_of("/\\") != std::string::npos) {
      fail(key, '"' + name + '"', "give the name of a file in the folder of cameras.json");
    }
    return name;
  }

  // One of kLensNames.
  LensKind readLensKind(const char* key) {
    const Json* value = find(key);
    if (!value) return LensKind::kPinhole;
    const auto found = std::find(std::begin(kLensNames), std::end(kLensNames), *value);
    if (found != std::end(kLensNames)) return static_cast<LensKind>(found - std::begin(kLensNames));
    fail(key, describe(*value),
         "give \"pinhole\", \"fisheye\", \"kannala_brandt\", \"radial_tangential\", \"equirectangular\", "
         "\"ray_map\" or \"orthographic\"");
    return LensKind::kPinhole;
  }

  // At most eight.
  std::vector<double> readNumbers(const char* key) {
    constexpr size_t kMost = 8;
    std::vector<double> numbers;
    const Json* values = find(key);
    if (!values) return numbers;
    if (!values->is_array() || values->size() > kMost) {
      fail(key, describe(*values), "give an array of up to eight numbers");
      return numbers;
    }
    for (const Json& value : *values) numbers.push_back(asNumber(key, value));
    return numbers;
  }

  std::array<double, 12> readPose(const char* key) {
    std::array<double, 12> pose{};
    const Json* rows = require(key);
    if (!rows) return pose;
    const bool isMatrix =
        rows->is_array() && rows->size() == 3 &&
        std::all_of(rows->begin(), rows->end(), [](const Json& row) { return row.is_array() && row.size() == 4; });
    if (!isMatrix) {
      fail(key, describe(*rows), "give three rows of four numbers");
      return pose;
    }
    for (size_t i = 0; i < 12; ++i) pose[i] = asNumber(key, (*rows)[i / 4][i % 4]);
    return pose;
  }

  void fail(const char* key, const std::string& found, const char* remedy) {
    if (error_) return;
    error_ =
        makeError(ErrorKind::kBadInput, "%s, field '%s': found %s; %s", place_.c_str(), key, found.c_str(), remedy);
  }

  const std::optional<Error>& error() const { return error_; }
  const std::string& place() const { return place_; }

 private:
  // A file may nest values as deep as it is long, and dump() recurses.
  static bool isDeeperThan(const Json& value, int levels) {
    return value.is_structured() &&
           (levels == 0 || std::any_of(value.begin(), value.end(),
                                       [levels](const Json& child) { return isDeeperThan(child, levels - 1); }));
  }

  static std::string describe(const Json& value) {
    constexpr size_t kShown = 60;
    constexpr int kShownLevels = 3;
    if (isDeeperThan(value, kShownLevels)) return std::string("a deeply nested ") + value.type_name();
    std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
    return text.size() > kShown ? text.substr(0, kShown) + "..." : text;
  }

  const Json* require(const char* key) {
    const Json* value = find(key);
    if (!value) fail(key, "nothing", "add the field (docs/CAMERAS.md)");
    return value;
  }

  double asNumber(const char* key, const Json& value) {
    if (value.is_number()) return value.get<double>();
    fail(key, describe(value), "give a number");
    return 0;
  }

  const Json& object_;
  std::string place_;
  std::optional<Error> error_;
};

// The lens, and where on the image it looks.
void readLens(FieldReader& fields, View& view) {
  Lens& lens = view.lens;
  lens.kind = fields.readLensKind("lens");
  lens.distortion = fields.readNumbers("distortion");
  lens.raysFile = fields.readFileName("rays");
  const auto isAbsent = [&](const char* key) { return !fields.find(key); };
  if (lens.kind == LensKind::kRayMap) {
    if (lens.raysFile.empty()) fields.fail("rays", "nothing", "name the file of the ray map");
    for (const char* key : {"fx", "fy", "cx", "cy"}) {
      if (!isAbsent(key)) fields.fail(key, "a value", "remove it: the ray map says it all");
    }
    return;
  }
  if (!isAbsent("rays")) fields.fail("rays", "a file", "remove it, or write \"lens\": \"ray_map\"");
  if (lens.kind == LensKind::kEquirectangular && isAbsent("fx") && isAbsent("fy") && isAbsent("cx") && isAbsent("cy")) {
    constexpr double kPi = 3.14159265358979323846;
    view.fx = view.width / (2 * kPi);  // all around
    view.fy = view.height / kPi;
    view.cx = 0.5 * view.width;
    view.cy = 0.5 * view.height;
    return;
  }
  view.fx = fields.readNumber("fx");
  view.fy = fields.readNumber("fy");
  view.cx = fields.readNumber("cx");
  view.cy = fields.readNumber("cy");
}

Result<View> readView(const Json& object, const std::string& place, const std::string& defaultName) {
  FieldReader fields(object, place);
  fields.refuseOthers({"photo", "width", "height", "lens", "distortion", "rays", "fx", "fy", "cx", "cy",
                       "world_from_camera", "near_depth", "near_ratio", "golden", "reference_psnr"});
  View view;
  view.name = fields.readText("photo");
  if (view.name.empty()) view.name = defaultName;
  view.width = fields.readSize("width");
  view.height = fields.readSize("height");
  readLens(fields, view);
  view.worldFromCamera = fields.readPose("world_from_camera");
  view.nearDepth = fields.readOptionalNumber("near_depth");
  view.nearRatio = fields.readOptionalNumber("near_ratio");
  view.referencePsnr = fields.readOptionalNumber("reference_psnr").value_or(0);
  if (const Json* golden = fields.find("golden")) {
    FieldReader names(*golden, place + ", field 'golden'");
    names.refuseOthers({"rgb", "alpha", "depth"});
    view.goldenColour = names.readFileName("rgb");
    view.goldenAlpha = names.readFileName("alpha");
    view.goldenDepth = names.readFileName("depth");
    if (names.error()) return *names.error();
  }
  if (fields.error()) return *fields.error();
  if (Status status = checkView(view, place); !status) return status.error();
  return view;
}

std::string viewPlace(const std::string& file, const char* list, size_t index) {
  return file + ": " + (std::string(list) == "views" ? "view " : "flight view ") + std::to_string(index);
}

Result<std::vector<View>> readViews(const Json& root, const char* list, const std::string& file) {
  std::vector<View> views;
  const auto it = root.find(list);
  if (it == root.end()) return views;
  if (!it->is_array()) {
    return makeError(ErrorKind::kBadInput, "%s: field '%s': found %s; give an array of views", file.c_str(), list,
                     it->type_name());
  }
  for (size_t i = 0; i < it->size(); ++i) {
    char defaultName[32];
    std::snprintf(defaultName, sizeof defaultName, "view_%02zu", i);
    Result<View> view = readView((*it)[i], viewPlace(file, list, i), defaultName);
    if (!view) return view.error();
    views.push_back(std::move(*view));
  }
  return views;
}

WrittenJson toJson(const View& view) {
  const auto& m = view.worldFromCamera;
  const Lens& lens = view.lens;
  WrittenJson object = {{"photo", view.name}, {"width", view.width}, {"height", view.height}};
  if (lens.kind != LensKind::kPinhole) object["lens"] = kLensNames[static_cast<int>(lens.kind)];
  if (!lens.distortion.empty()) object["distortion"] = lens.distortion;
  if (lens.kind == LensKind::kRayMap) {
    object["rays"] = lens.raysFile;
  } else {
    object.update({{"fx", view.fx}, {"fy", view.fy}, {"cx", view.cx}, {"cy", view.cy}});
  }
  object["world_from_camera"] = {{m[0], m[1], m[2], m[3]}, {m[4], m[5], m[6], m[7]}, {m[8], m[9], m[10], m[11]}};
  if (view.nearDepth) object["near_depth"] = *view.nearDepth;
  if (view.nearRatio) object["near_ratio"] = *view.nearRatio;
  if (view.referencePsnr != 0) object["reference_psnr"] = view.referencePsnr;
  if (!view.goldenColour.empty()) object["golden"]["rgb"] = view.goldenColour;
  if (!view.goldenAlpha.empty()) object["golden"]["alpha"] = view.goldenAlpha;
  if (!view.goldenDepth.empty()) object["golden"]["depth"] = view.goldenDepth;
  return object;
}

}  // namespace

Result<CameraSet> readCameras(const std::filesystem::path& path) {
  Result<std::vector<uint8_t>> bytes = readFile(path, kMostJsonBytes);
  if (!bytes) return bytes.error();
  Result<CameraSet> cameras = parseCameras(*bytes, path.string());
  if (!cameras) return cameras;
  for (std::vector<View>* views : {&cameras->views, &cameras->flight}) {
    for (View& view : *views) {
      if (view.lens.kind != LensKind::kRayMap) continue;
      Result<RayMap> rays = readRayMap(path.parent_path() / view.lens.raysFile, view.width, view.height);
      if (!rays) return rays.error();
      view.lens.rays = std::make_shared<RayMap>(std::move(*rays));
    }
  }
  return cameras;
}

Result<CameraSet> parseCameras(std::span<const uint8_t> bytes, const std::string& file) {
  const Result<Json> root = parseJson(bytes, file, "write it as docs/CAMERAS.md shows");
  if (!root) return root.error();
  FieldReader fields(*root, file);
  CameraSet cameras;
  cameras.scene = fields.readText("scene");
  if (!fields.find("views")) fields.fail("views", "nothing", "add an array of views (docs/CAMERAS.md)");
  if (fields.error()) return *fields.error();

  Result<std::vector<View>> views = readViews(*root, "views", file);
  if (!views) return views.error();
  cameras.views = std::move(*views);
  Result<std::vector<View>> flight = readViews(*root, "flight", file);
  if (!flight) return flight.error();
  cameras.flight = std::move(*flight);
  return cameras;
}

Status writeCameras(const std::filesystem::path& path, const CameraSet& cameras) {
  const Result<std::string> text = camerasText(cameras, path.string());
  if (!text) return text.error();
  return writeFileAtomically(path, {reinterpret_cast<const uint8_t*>(text->data()), text->size()});
}

Result<std::string> camerasText(const CameraSet& cameras, const std::string& file) {
  WrittenJson root;
  if (!cameras.scene.empty()) root["scene"] = cameras.scene;
  root["convention"] =
      "camera axes x right, y down, z forward; pixel centres at +0.5; world_from_camera: 3 rows of 4; "
      "near_depth in scene units";
  const std::pair<const char*, const std::vector<View>&> lists[] = {{"views", cameras.views},
                                                                    {"flight", cameras.flight}};
  for (const auto& [list, views] : lists) {
    WrittenJson array = WrittenJson::array();
    for (size_t i = 0; i < views.size(); ++i) {
      if (Status status = checkView(views[i], viewPlace(file, list, i)); !status) return status.error();
      array.push_back(toJson(views[i]));
    }
    if (!views.empty() || &views == &cameras.views) root[list] = std::move(array);
  }
  // File names need not be UTF-8; a name that is not is written with replacement characters instead of
  // failing.
  return root.dump(1, ' ', false, WrittenJson::error_handler_t::replace) + "\n";
}

}  // namespace froth
