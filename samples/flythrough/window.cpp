#include "samples/flythrough/window.h"

#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <GLFW/glfw3.h>
#include <imgui.h>

#include "host/app_window.h"
#include "host/flight_input.h"
#include "samples/flythrough/cameras_json.h"
#include "samples/flythrough/overlay.h"
#include "samples/flythrough/streaming_panel.h"

namespace froth {
namespace {

constexpr double kSecondsPerKey = 2.0;  // of the path camera

class Flythrough : public WindowClient {
 public:
  explicit Flythrough(const FlythroughOptions& options)
      : options_(options), shown_(options.picture), streaming_(options.streaming) {}
  ~Flythrough() override;

  Status create();
  Status run() { return window_->run(*this, options_.frames); }

  Status resize(VkExtent2D extent) override;
  void handleInput(double seconds) override;
  void layOut() override;
  Status record(VkCommandBuffer commands, const FrameRing& frames) override;
  const HostImage& picture() const override { return painter_->result(); }

 private:
  Status startFlight();
  void choosePicture();
  void steer(double seconds);
  Pose currentPose() const;
  Status holdTime(uint64_t serial);
  Status follow();
  std::string followed() const;
  void layOutLevels();
  bool hasLevels() const { return scene_->levelCount() > 1; }

  // Destroyed from the last to the first.
  const FlythroughOptions& options_;
  std::unique_ptr<AppWindow> window_;
  std::unique_ptr<Scene> scene_;
  std::unique_ptr<Painter> painter_;
  Overlay overlay_;

  std::vector<Pose> keys_;          // of --cameras
  std::optional<CameraPath> path_;  // once the asset is ready
  std::optional<FlyCamera> flight_;
  double pathSeconds_ = 0;
  Picture shown_;
  FrothQuality quality_{};
  StreamSettings streaming_;
  bool isStreamingNew_ = true;  // not applied yet
  bool isOnPath_ = true, isOverlayShown_ = true;
  Status screenshot_;
  bool isReplacing_ = false;  // --follow: the newest asset is loading
  std::string replacementFault_;
};

Flythrough::~Flythrough() {
  if (window_) vkDeviceWaitIdle(window_->host().device);
}

Status Flythrough::create() {
  if (!options_.cameras.empty()) {
    Result<std::vector<Pose>> keys = readKeyPoses(options_.cameras);
    if (!keys) return keys.error();
    keys_ = std::move(*keys);
  }
  Result<std::unique_ptr<AppWindow>> window =
      AppWindow::create("Froth", options_.extent, {options_.device, options_.validate});
  if (!window) return window.error();
  window_ = std::move(*window);
  FrothContextInfo contextInfo = window_->host().contextInfo();
  contextInfo.framesInFlight = kFramesInFlight;
  contextInfo.countWork = options_.isCounting ? 1 : 0;
  Result<std::unique_ptr<Scene>> scene = Scene::create(contextInfo, options_.asset);
  if (!scene) return scene.error();
  scene_ = std::move(*scene);
  painter_ = std::make_unique<Painter>(window_->host());
  return {};
}

Status Flythrough::resize(VkExtent2D extent) {
  quality_ = {};
  return painter_->setExtent(*scene_, extent);
}

// Draws less where frames take longer than --target-ms.
Status Flythrough::holdTime(uint64_t serial) {
  if (options_.targetMilliseconds == 0) return {};
  FrothQualityInfo info{};
  info.structSize = sizeof(info);
  info.targetMilliseconds = options_.targetMilliseconds;
  FrothQualityTimes times{};
  times.structSize = sizeof(times);
  times.serial = serial;
  const Result<FrothViewStatus> view = scene_->viewStatus();
  if (!view) return view.error();
  times.measuredSerial = view->serial;
  for (uint32_t i = 0; i < view->passCount; ++i) times.milliseconds += view->passes[i].milliseconds;
  quality_.structSize = sizeof(quality_);
  Status stepped = scene_->check(frothStepQuality(&info, &times, &quality_), "frothStepQuality");
  if (stepped) painter_->setQuality(quality_);
  return stepped;
}

// What the foam's newest bake gave takes the place of what is shown. Another bake waits until it is loaded, for it
// would replace the file.
Status Flythrough::follow() {
  if (!options_.follower || !scene_->isReady()) return {};
  if (isReplacing_) {
    const Result<FrothReplacementStatus> status = scene_->replacement();
    if (!status) return status.error();
    isReplacing_ = status->state == FROTH_REPLACEMENT_LOADING;
    const bool hasFailed = status->state == FROTH_REPLACEMENT_FAILED;
    replacementFault_ = hasFailed ? frothResultName(status->error) : "";
    return {};
  }
  const Result<FoamFollower::News> news = options_.follower->poll();
  if (!news) return news.error();
  if (*news != FoamFollower::News::kBaked) return {};
  isReplacing_ = true;
  return scene_->replace(options_.follower->asset());
}

std::string Flythrough::followed() const {
  if (!options_.follower) return "";
  const std::string& fault = options_.follower->fault();
  if (!fault.empty()) return "the last foam stays: " + fault;
  if (!replacementFault_.empty()) return "the last foam stays: " + replacementFault_;
  return isReplacing_ ? "a new foam is loading" : options_.follower->isBaking() ? "a new foam is baked" : "newest foam";
}

Status Flythrough::startFlight() {
  Result<CameraPath> path = scene_->path(std::move(keys_));
  if (!path) return path.error();
  path_ = std::move(*path);
  const FrothAssetStatus& asset = scene_->assetStatus();
  const glm::dvec3 least(asset.boundsMin[0], asset.boundsMin[1], asset.boundsMin[2]);
  const glm::dvec3 most(asset.boundsMax[0], asset.boundsMax[1], asset.boundsMax[2]);
  constexpr double kSpeed = 0.1;  // scene diagonals per second
  flight_.emplace(path_->at(0), path_->up(), kSpeed * glm::length(most - least));
  if (!hasLevels()) return {};
  vkDeviceWaitIdle(window_->host().device);
  return resize(window_->extent());  // now it is known that the view is to keep hits
}

Pose Flythrough::currentPose() const {
  if (!path_) return {};
  if (!isOnPath_) return flight_->pose();
  // There and back again, without end.
  const double duration = kSecondsPerKey * static_cast<double>(path_->keyCount());
  const double share = std::fmod(pathSeconds_ / duration, 2.0);
  return path_->at(share <= 1 ? share : 2 - share);
}

void Flythrough::choosePicture() {
  if (ImGui::IsKeyPressed(GLFW_KEY_1, false)) shown_ = Picture::kRaster;
  if (ImGui::IsKeyPressed(GLFW_KEY_2, false)) shown_ = Picture::kWalk;
  if (ImGui::IsKeyPressed(GLFW_KEY_3, false)) shown_ = Picture::kDifference;
  if (ImGui::IsKeyPressed(GLFW_KEY_4, false) && hasLevels()) shown_ = Picture::kLevels;
}

void Flythrough::handleInput(double seconds) {
  if (path_ && isOnPath_) pathSeconds_ += seconds;
  if (ImGui::GetIO().WantTextInput) return;  // a number of the panel
  choosePicture();
  if (ImGui::IsKeyPressed(GLFW_KEY_ESCAPE, false)) window_->close();
  if (ImGui::IsKeyPressed(GLFW_KEY_H, false)) isOverlayShown_ = !isOverlayShown_;
  if (ImGui::IsKeyPressed(GLFW_KEY_C, false)) screenshot_ = window_->saveScreenshot(*this, options_.output);
  if (!path_) return;
  if (ImGui::IsKeyPressed(GLFW_KEY_P, false)) {
    flight_->jumpTo(currentPose());
    isOnPath_ = !isOnPath_;
  }
  steer(seconds);
}

void Flythrough::steer(double seconds) {
  const FlyInput input = flightInput(seconds);
  flight_->scaleSpeed(flightSpeedChange());
  if (isOnPath_ && (input.move != glm::dvec3(0) || input.turn != glm::dvec2(0))) {
    flight_->jumpTo(currentPose());  // whoever steers leaves the path where it was
    isOnPath_ = false;
  }
  flight_->step(input);
}

void Flythrough::layOut() {
  if (!isOverlayShown_) return;
  OverlayContent content;
  content.picture = nameOf(shown_);
  content.scale = options_.targetMilliseconds > 0 ? quality_.scale : 1;
  content.camera = isOnPath_ ? "path" : "free flight";
  content.asset = scene_->assetStatus();
  content.frame = scene_->frameStatus();
  if (const Result<FrothViewStatus> view = scene_->viewStatus()) content.view = *view;
  content.hasLevels = hasLevels();
  content.followed = followed();
  overlay_.layOut(content, window_->extent());
  if (hasLevels()) layOutLevels();
}

void Flythrough::layOutLevels() {
  const Result<StreamFigures> figures = readFigures(*scene_);
  if (!figures) return;
  isStreamingNew_ |= layOutStreaming(*figures, {currentPose(), path_->up()}, streaming_);
}

Status Flythrough::record(VkCommandBuffer commands, const FrameRing& frames) {
  if (!screenshot_) return screenshot_;
  if (std::exchange(isStreamingNew_, false)) {
    if (Status applied = applySettings(*scene_, streaming_); !applied) return applied;
  }
  Status recorded = scene_->beginFrame(commands, frames.nextSerial(), frames.completedSerial());
  if (!recorded) return recorded;
  if (!path_ && scene_->isReady()) {
    if (Status started = startFlight(); !started) return started;
  }
  if (Status followed = follow(); !followed) return followed;
  if (Status held = holdTime(frames.nextSerial()); !held) return held;
  return painter_->record(commands, *scene_, shown_, currentPose(), VK_PIPELINE_STAGE_2_BLIT_BIT);
}

}  // namespace

Status flyInWindow(const FlythroughOptions& options) {
  Flythrough flythrough(options);
  if (Status made = flythrough.create(); !made) return made;
  return flythrough.run();
}

}  // namespace froth
