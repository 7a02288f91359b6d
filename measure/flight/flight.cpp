#include "measure/flight/flight.h"

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "base/progress_printer.h"
#include "reference/image/metrics.h"

namespace froth {
namespace {

// Pixels in which less than this is a miss, and more than the other a hit.
constexpr float kMissAlpha = 0.1f, kHitAlpha = 0.9f;

uint64_t countMissing(const Image& flown, const Image& whole) {
  uint64_t missing = 0;
  for (size_t pixel = 0; pixel < whole.values.size(); ++pixel) {
    missing += flown.values[pixel] < kMissAlpha && whole.values[pixel] > kHitAlpha ? 1 : 0;
  }
  return missing;
}

Result<double> psnrOf(const FlownImage& image, const FlownImage& whole) {
  const Result<ImageDifference> difference = compareImages(image.colour, whole.colour);
  if (!difference) return difference.error();
  return difference->psnr;
}

// Images of views at rest, one after the other in one context.
Result<std::vector<FlownImage>> settledImages(Host& host, const SceneOptions& options, const std::vector<View>& views,
                                              const char* name, const Progress& progress) {
  Result<std::unique_ptr<StreamedScene>> scene = StreamedScene::create(host, options);
  if (!scene) return scene.error();
  std::vector<FlownImage> images;
  for (const View& view : views) {
    if (!report(progress, name, images.size(), views.size())) return stoppedError();
    if (Status settled = (*scene)->settle(view); !settled) return settled.error();
    Result<FlownImage> image = (*scene)->readImage();
    if (!image) return image.error();
    images.push_back(std::move(*image));
  }
  return images;
}

Status compare(Host& host, const FlightOptions& options, const std::vector<View>& views,
               const std::vector<FlownImage>& flown, std::vector<ComparedImage>& images, const Progress& progress) {
  SceneOptions atRest = options.scene;
  atRest.disk = {};
  const Result<std::vector<FlownImage>> settled = settledImages(host, atRest, views, "at rest", progress);
  if (!settled) return settled.error();
  const Result<std::vector<FlownImage>> whole =
      settledImages(host, allCellsOf(options.scene), views, "all cells", progress);
  if (!whole) return whole.error();
  for (size_t i = 0; i < images.size(); ++i) {
    const Result<double> asFlown = psnrOf(flown[i], (*whole)[i]);
    if (!asFlown) return asFlown.error();
    const Result<double> asSettled = psnrOf((*settled)[i], (*whole)[i]);
    if (!asSettled) return asSettled.error();
    images[i].flown = *asFlown;
    images[i].settled = *asSettled;
    images[i].missing = countMissing(flown[i].alpha, (*whole)[i].alpha);
  }
  return {};
}

}  // namespace

View viewOf(const CameraPath& path, const FlightOptions& options, uint32_t frame) {
  double share = static_cast<double>(frame) / (options.frames - 1);
  // Multiples of the golden ratio visit the path evenly, and never the same place twice.
  if (options.jumpEvery > 0) {
    const uint32_t jumps = frame / options.jumpEvery;
    double whole = 0;
    share = std::modf(share + jumps * std::numbers::phi, &whole);
  }
  const Pose pose = path.at(share);
  const glm::dmat3 rotation = glm::mat3_cast(pose.worldFromCamera);
  View view;
  view.name = "frame " + std::to_string(frame);
  view.width = options.scene.extent.width;
  view.height = options.scene.extent.height;
  view.fx = view.fy = view.height / (2 * pose.tanHalfFovY);
  view.cx = view.width / 2.0;
  view.cy = view.height / 2.0;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) view.worldFromCamera[row * 4 + column] = rotation[column][row];
    view.worldFromCamera[row * 4 + 3] = pose.eye[row];
  }
  return view;
}

namespace {

// What is compared afterwards.
struct Taken {
  std::vector<View> views;
  std::vector<FlownImage> images;
};

Status flyPath(StreamedScene& scene, const CameraPath& path, const FlightOptions& options, Flight& flight, Taken& taken,
               const Progress& progress) {
  if (options.isFromRest) {
    if (Status settled = scene.settle(viewOf(path, options, 0)); !settled) return settled;
  }
  const auto before = static_cast<std::ptrdiff_t>(scene.frames().size());
  for (uint32_t frame = 0; frame < options.frames; ++frame) {
    if (!report(progress, "fly", frame, options.frames)) return stoppedError();
    const View view = viewOf(path, options, frame);
    if (Status drawn = scene.draw(view); !drawn) return drawn;
    if (frame % options.imageEvery != options.imageEvery - 1 || !scene.frames().back().isReady) continue;
    Result<FlownImage> image = scene.readImage();
    if (!image) return image.error();
    taken.images.push_back(std::move(*image));
    taken.views.push_back(view);
    flight.images.push_back({frame});
  }
  if (Status settled = scene.settle(viewOf(path, options, options.frames - 1)); !settled) return settled;
  const auto begin = scene.frames().begin() + before;
  flight.frames.assign(begin, begin + options.frames);
  flight.framesToSettle = static_cast<uint32_t>(scene.frames().end() - begin) - options.frames;
  flight.atEnd = scene.frames().back().stream;
  flight.bytesRead = scene.bytesRead();
  flight.asset = scene.assetStatus();
  return {};
}

}  // namespace

Result<Flight> fly(const CameraPath& path, const FlightOptions& options, const Progress& progress) {
  Result<std::unique_ptr<Host>> host = Host::create({options.device});
  if (!host) return host.error();
  Flight flight;
  flight.deviceName = (*host)->info.name;
  flight.driverName = (*host)->info.driver;
  Taken taken;
  {
    Result<std::unique_ptr<StreamedScene>> scene = StreamedScene::create(**host, options.scene);
    if (!scene) return scene.error();
    if (Status flown = flyPath(**scene, path, options, flight, taken, progress); !flown) return flown.error();
  }
  if (Status compared = compare(**host, options, taken.views, taken.images, flight.images, progress); !compared) {
    return compared.error();
  }
  return flight;
}

}  // namespace froth
