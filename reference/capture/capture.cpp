#include "reference/capture/capture.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "base/atomic_file.h"
#include "foam/checkpoint/bad_input.h"
#include "reference/capture/colmap.h"
#include "reference/capture/ply_points.h"
#include "reference/capture/transforms.h"

namespace froth {
namespace {

namespace fs = std::filesystem;

bool isFile(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

// `name` is the photo's, relative to the folder that holds all photos.
void findMask(const fs::path& scene, const fs::path& name, CapturedView& view) {
  const fs::path masks = scene / "masks";
  const fs::path stem = fs::path(name).replace_extension();
  const fs::path dynamic = "dynamic_mask_" + view.photo.stem().string() + ".png";
  const std::pair<fs::path, MaskSense> places[] = {{masks / (name.string() + ".png"), MaskSense::kBlackIgnored},
                                                   {masks / (stem.string() + ".png"), MaskSense::kBlackIgnored},
                                                   {view.photo.parent_path() / dynamic, MaskSense::kWhiteIgnored}};
  for (const auto& [path, sense] : places) {
    if (!isFile(path)) continue;
    view.mask = path;
    view.maskSense = sense;
    return;
  }
}

// The folder that holds images/ and masks/ of a model: that of sparse/0 is two above it.
fs::path sceneOfModel(const fs::path& model) {
  fs::path folder = fs::absolute(model).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();  // it ended in a slash
  if (folder.filename() == "sparse") return folder.parent_path();
  return folder.parent_path().filename() == "sparse" ? folder.parent_path().parent_path() : folder;
}

Result<Capture> readColmapScene(const fs::path& model) {
  Result<Capture> capture = readColmapModel(model);
  if (!capture) return capture;
  const fs::path scene = sceneOfModel(model);
  for (CapturedView& view : capture->views) {
    view.photo = scene / "images" / view.view.name;
    findMask(scene, view.view.name, view);
  }
  return capture;
}

// A name without the folder "images" in front of it.
fs::path belowImages(const fs::path& name) {
  return name.begin() != name.end() && *name.begin() == "images" ? name.lexically_relative("images") : name;
}

void leaveOutMissing(Capture& capture) {
  const auto isMissing = [](const CapturedView& view) { return !isFile(view.photo); };
  if (std::all_of(capture.views.begin(), capture.views.end(), isMissing)) return;
  for (const CapturedView& view : capture.views) {
    if (isMissing(view)) capture.leftOut.push_back(view.view.name);
  }
  std::erase_if(capture.views, isMissing);
}

// A file that is not there is no fault: data sets travel without it.
Status readPoints(Capture& capture) {
  if (!isFile(capture.pointFile)) return {};
  const Result<std::vector<uint8_t>> bytes = readFile(capture.pointFile);
  if (!bytes) return bytes.error();
  Result<std::vector<CapturedPoint>> points = parsePlyPoints({*bytes, capture.pointFile.string()});
  if (!points) return points.error();
  capture.points = std::move(*points);
  return {};
}

Result<Capture> readTransformsFile(const fs::path& path) {
  const Result<std::vector<uint8_t>> bytes = readFile(path);
  if (!bytes) return bytes.error();
  const fs::path folder = path.parent_path();
  Result<Capture> capture =
      parseTransforms(*bytes, path.string(), [&](const std::string& name) { return readImageSize(folder / name); });
  if (!capture) return capture;
  for (CapturedView& view : capture->views) {
    view.photo = folder / view.photo;
    if (!view.mask.empty()) {
      view.mask = folder / view.mask;
    } else {
      findMask(folder, belowImages(view.view.name), view);
    }
  }
  leaveOutMissing(*capture);
  if (!capture->pointFile.empty()) capture->pointFile = folder / capture->pointFile;
  return capture;
}

// Names in bytewise order; `file` heads the message.
Status sortViews(const std::string& file, Capture& capture) {
  std::vector<CapturedView>& views = capture.views;
  std::stable_sort(views.begin(), views.end(),
                   [](const CapturedView& a, const CapturedView& b) { return a.view.name < b.view.name; });
  const auto twice = std::adjacent_find(views.begin(), views.end(), [](const CapturedView& a, const CapturedView& b) {
    return a.view.name == b.view.name;
  });
  if (twice == views.end()) return {};
  return badInput(file, "field 'file_path': found {} in two frames; remove one", froth::quoted(twice->view.name));
}

// One file for training, one for tests: those of the test set, else of the validation set.
Result<Capture> readTransformsParts(const fs::path& folder) {
  Result<Capture> capture = readTransformsFile(folder / "transforms_train.json");
  if (!capture) return capture;
  for (CapturedView& view : capture->views) view.part = CapturePart::kTraining;
  for (const char* name : {"transforms_test.json", "transforms_val.json"}) {
    if (!isFile(folder / name)) continue;
    Result<Capture> tests = readTransformsFile(folder / name);
    if (!tests) return tests;
    for (CapturedView& view : tests->views) {
      view.part = CapturePart::kTest;
      capture->views.push_back(std::move(view));
    }
    capture->leftOut.insert(capture->leftOut.end(), tests->leftOut.begin(), tests->leftOut.end());
    break;
  }
  return capture;
}

// What transforms.json describes, of one file or of several.
Result<Capture> finishTransforms(Result<Capture> capture, const fs::path& path) {
  if (!capture) return capture;
  if (Status read = readPoints(*capture); !read) return read.error();
  if (Status status = sortViews(path.string(), *capture); !status) return status.error();
  return capture;
}

}  // namespace

Result<Capture> readCapture(const fs::path& path) {
  if (isFile(path) && path.extension() != ".json") {
    return badInput(path.string(), "found a file that is no transforms.json; give the scene's folder");
  }
  if (isFile(path)) return finishTransforms(readTransformsFile(path), path);
  for (const fs::path& model : {path / "sparse" / "0", path / "sparse", path}) {
    if (hasColmapModel(model)) return readColmapScene(model);
  }
  if (isFile(path / "transforms.json")) return finishTransforms(readTransformsFile(path / "transforms.json"), path);
  if (isFile(path / "transforms_train.json")) return finishTransforms(readTransformsParts(path), path);
  return badInput(path.string(),
                  "found {}; give a folder with a COLMAP model (sparse/0/cameras.bin or .txt) or transforms.json",
                  fs::exists(path) ? "neither a COLMAP model nor transforms.json" : "no such file or folder");
}

}  // namespace froth
