#include "measure/flight/pops.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "base/progress_printer.h"
#include "measure/gpu/gpu_camera.h"

namespace froth {
namespace {

constexpr double kPixelsPerFrame = 0.1;

View moveForwards(View view, double distance) {
  for (size_t row = 0; row < 3; ++row) {
    view.worldFromCamera[4 * row + 3] += distance * view.worldFromCamera[4 * row + 2];
  }
  return view;
}

Result<double> medianDistance(const View& view, const FlightOptions& options, const Progress& progress) {
  GpuDeviceOptions device;
  device.device = options.device;
  device.lensClasses = lensClassesOf(view);
  const Result<std::unique_ptr<GpuRenderer>> renderer = GpuRenderer::create(device);
  if (!renderer) return renderer.error();
  AssetInput asset;
  asset.path = options.scene.asset;
  if (Status loaded = (*renderer)->load(asset, progress); !loaded) return loaded.error();
  Result<GpuFrame> frame = (*renderer)->render(view, options.scene.render);
  if (!frame) return frame.error();
  std::vector<float>& distances = frame->images.distance.values;
  std::erase_if(distances, [](float distance) { return !(distance > 0); });
  if (distances.empty()) {
    return makeError(ErrorKind::kUsage, "%s: the first view sees no surface; let the path begin elsewhere",
                     options.scene.asset.string().c_str());
  }
  const auto median = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), median, distances.end());
  return double{*median};
}

// Of chunks that are in one of two ascending lists alone.
uint32_t countMoved(const std::vector<uint32_t>& before, const std::vector<uint32_t>& now) {
  std::vector<uint32_t> moved;
  std::ranges::set_symmetric_difference(before, now, std::back_inserter(moved));
  return static_cast<uint32_t>(moved.size());
}

// A scene, and the newest of its frames.
struct Dolly {
  std::unique_ptr<StreamedScene> scene;
  Image image;
  std::vector<uint32_t> chunks;

  static Result<Dolly> begin(Host& host, const SceneOptions& options, const View& view) {
    Result<std::unique_ptr<StreamedScene>> scene = StreamedScene::create(host, options);
    if (!scene) return scene.error();
    Dolly dolly{std::move(*scene), {}, {}};
    if (Status settled = dolly.scene->settle(view); !settled) return settled.error();
    if (Status read = dolly.read(); !read) return read.error();
    return dolly;
  }
  Status draw(const View& view) {
    if (Status drawn = scene->draw(view); !drawn) return drawn;
    return read();
  }
  Status read() {
    Result<FlownImage> flown = scene->readImage();
    if (!flown) return flown.error();
    image = std::move(flown->colour);
    Result<std::vector<uint32_t>> drawn = scene->drawnChunks();
    if (!drawn) return drawn.error();
    chunks = std::move(*drawn);
    return {};
  }
};

// The largest change of a channel in the difference of two pictures.
double mostChange(const Image& before, const Image& wholeBefore, const Image& now, const Image& wholeNow) {
  double most = 0;
  for (size_t i = 0; i < now.values.size(); ++i) {
    const double errorBefore = double{before.values[i]} - double{wholeBefore.values[i]};
    most = std::max(most, std::abs(double{now.values[i]} - double{wholeNow.values[i]} - errorBefore));
  }
  return most;
}

// A further frame of a scene with levels, beside those with all cells.
Status drawLevels(const View& view, const Image& wholeBefore, const Image& wholeNow, Dolly& levels,
                  std::vector<FrameChange>& frames, PixelChanges& still, PixelChanges& moved) {
  const Image before = std::move(levels.image);
  const std::vector<uint32_t> chunksBefore = std::move(levels.chunks);
  if (Status drawn = levels.draw(view); !drawn) return drawn;
  const uint32_t movedChunks = countMoved(chunksBefore, levels.chunks);
  FrameChange change = (movedChunks > 0 ? moved : still).add(before, levels.image);
  change.movedChunks = movedChunks;
  change.mostOfError = mostChange(before, wholeBefore, levels.image, wholeNow);
  frames.push_back(change);
  return {};
}

// faded: null without fades.
Status drawNext(const View& view, Dolly& levels, Dolly* faded, Dolly& whole, Pops& pops) {
  const Image wholeBefore = std::move(whole.image);
  if (Status drawn = whole.draw(view); !drawn) return drawn;
  pops.whole.push_back(pops.wholeChanges.add(wholeBefore, whole.image));
  Status drawn = drawLevels(view, wholeBefore, whole.image, levels, pops.levels, pops.still, pops.moved);
  if (!drawn || !faded) return drawn;
  return drawLevels(view, wholeBefore, whole.image, *faded, pops.faded, pops.fadedChanges, pops.fadedChanges);
}

// The time of the last frame is not known.
void takeTimes(std::span<const FlownFrame> frames, Pops& pops) {
  for (const FlownFrame& frame : frames.first(frames.size() - 1)) {
    (frame.isFading ? pops.gpuFading : pops.gpuStill).push_back(frame.gpuMs);
  }
}

}  // namespace

FrameChange PixelChanges::add(const Image& before, const Image& now) {
  FrameChange frame;
  for (size_t pixel = 0; pixel < now.values.size(); pixel += now.channels) {
    double change = 0;
    for (size_t i = pixel; i < pixel + now.channels; ++i) {
      change = std::max(change, std::abs(double{now.values[i]} - double{before.values[i]}));
    }
    frame.most = std::max(frame.most, change);
    frame.seenPixels += change > kSeenChange ? 1 : 0;
    ++counts_[std::min(static_cast<size_t>(change * kBins), kBins)];
    ++pixels_;
  }
  return frame;
}

double PixelChanges::quantile(double share) const {
  const double wanted = share * static_cast<double>(pixels_);
  uint64_t below = 0;
  for (size_t bin = 0; bin <= kBins; ++bin) {
    if (static_cast<double>(below) >= wanted) return static_cast<double>(bin) / kBins;
    below += counts_[bin];
  }
  return 1 + 1.0 / kBins;
}

Result<Pops> measurePops(const View& first, const FlightOptions& options, const Progress& progress) {
  Pops pops;
  const Result<double> distance = medianDistance(first, options, progress);
  if (!distance) return distance.error();
  pops.distance = *distance;
  // At the middle of the upper edge a step of s moves what is z away by half of the height times s / z.
  pops.step = kPixelsPerFrame * pops.distance / (first.height / 2.0);

  Result<std::unique_ptr<Host>> host = Host::create({options.device});
  if (!host) return host.error();
  pops.deviceName = (*host)->info.name;
  pops.driverName = (*host)->info.driver;
  SceneOptions unfaded = options.scene;
  unfaded.fadeFrames = 0;
  Result<Dolly> levels = Dolly::begin(**host, unfaded, first);
  if (!levels) return levels.error();
  std::optional<Dolly> faded;
  if (options.scene.fadeFrames > 0) {
    Result<Dolly> begun = Dolly::begin(**host, options.scene, first);
    if (!begun) return begun.error();
    faded = std::move(*begun);
  }
  const size_t settling = faded ? faded->scene->frames().size() : 0;
  Result<Dolly> whole = Dolly::begin(**host, allCellsOf(options.scene), first);
  if (!whole) return whole.error();
  for (uint32_t frame = 1; frame < options.frames; ++frame) {
    if (!report(progress, "dolly", frame, options.frames)) return stoppedError();
    const View view = moveForwards(first, frame * pops.step);
    if (Status drawn = drawNext(view, *levels, faded ? &*faded : nullptr, *whole, pops); !drawn) return drawn.error();
  }
  if (faded) takeTimes(std::span(faded->scene->frames()).subspan(settling), pops);
  pops.asset = levels->scene->assetStatus();
  return pops;
}

}  // namespace froth
