#include "samples/mirror_room/window.h"

#include <memory>
#include <string>
#include <utility>

#include <GLFW/glfw3.h>
#include <imgui.h>

#include "host/app_window.h"
#include "host/flight_input.h"
#include "host/pass_history.h"
#include "samples/mirror_room/pick.h"
#include "samples/mirror_room/stage.h"

namespace froth {
namespace {

constexpr double kSpeed = 1.2;        // of the camera [m/s]
constexpr double kLongestStep = 0.1;  // [s] of the room's time: what is slower than that goes slower

class MirrorRoom : public WindowClient {
 public:
  explicit MirrorRoom(const MirrorRoomOptions& options) : options_(options) {}
  ~MirrorRoom() override;

  Status create();
  Status run() { return window_->run(*this, options_.frames); }

  Status resize(VkExtent2D extent) override { return stage_->renderer().setExtent(stage_->scene(), extent); }
  void handleInput(double seconds) override;
  void layOut() override;
  Status record(VkCommandBuffer commands, const FrameRing& frames) override;
  const HostImage& picture() const override { return stage_->renderer().result(); }

 private:
  Status pick();
  Status advance();

  // Destroyed from the last to the first.
  const MirrorRoomOptions& options_;
  std::unique_ptr<AppWindow> window_;
  std::unique_ptr<RoomStage> stage_;
  std::unique_ptr<FlyCamera> camera_;
  PassHistory history_;
  double seconds_ = 0;  // since the last frame
  bool isPlaced_ = false, isPickWanted_ = false, isOverlayShown_ = true;
  std::string picked_ = "right click: what is there?";
  Status screenshot_;
};

MirrorRoom::~MirrorRoom() {
  if (window_) vkDeviceWaitIdle(window_->host().device);
}

Status MirrorRoom::create() {
  Result<std::unique_ptr<AppWindow>> window =
      AppWindow::create("Froth: mirror room", options_.extent, hostOptionsOf(options_));
  if (!window) return window.error();
  window_ = std::move(*window);
  Result<std::unique_ptr<RoomStage>> stage = RoomStage::create(window_->host(), options_);
  if (!stage) return stage.error();
  stage_ = std::move(*stage);
  camera_ = std::make_unique<FlyCamera>(stage_->room().camera, glm::dvec3(0, 1, 0), kSpeed);
  return {};
}

void MirrorRoom::handleInput(double seconds) {
  seconds_ = std::min(seconds, kLongestStep);
  if (ImGui::IsKeyPressed(GLFW_KEY_ESCAPE, false)) window_->close();
  if (ImGui::IsKeyPressed(GLFW_KEY_B, false)) stage_->dropBall();
  if (ImGui::IsKeyPressed(GLFW_KEY_H, false)) isOverlayShown_ = !isOverlayShown_;
  if (ImGui::IsKeyPressed(GLFW_KEY_C, false)) screenshot_ = window_->saveScreenshot(*this, options_.output);
  isPickWanted_ = ImGui::IsMouseClicked(ImGuiMouseButton_Right) && !ImGui::GetIO().WantCaptureMouse;
  camera_->scaleSpeed(flightSpeedChange());
  camera_->step(flightInput(seconds));
}

Status MirrorRoom::pick() {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const Result<std::optional<Pick>> pick = pickAt(stage_->scene().context(), stage_->room(), stage_->meshes(),
                                                  camera_->pose(), window_->extent(), {mouse.x, mouse.y});
  if (!pick) return pick.error();
  picked_ = *pick ? describe(**pick) : "nothing";
  if (*pick) stage_->mark((*pick)->position);
  return {};
}

Status MirrorRoom::advance() {
  if (!stage_->scene().isReady()) return {};
  if (!std::exchange(isPlaced_, true)) {
    if (Status placed = stage_->placeFoam(); !placed) return placed;
  }
  if (Status moved = stage_->advance(seconds_); !moved) return moved;
  return std::exchange(isPickWanted_, false) ? pick() : Status();
}

Status MirrorRoom::record(VkCommandBuffer commands, const FrameRing& frames) {
  if (!screenshot_) return screenshot_;
  Status recorded = stage_->scene().beginFrame(commands, frames.nextSerial(), frames.completedSerial());
  if (!recorded) return recorded;
  if (Status advanced = advance(); !advanced) return advanced;
  const GpuTimer::Times times = stage_->renderer().times(frames.completedSerial());
  history_.add(times.serial, times.passes);
  return stage_->record(commands, camera_->pose(), frames.nextSerial(), VK_PIPELINE_STAGE_2_BLIT_BIT);
}

void MirrorRoom::layOut() {
  if (!isOverlayShown_) return;
  ImGui::SetNextWindowPos(ImVec2(12, 12), ImGuiCond_FirstUseEver);
  ImGui::Begin("Mirror room", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::Text("%.1f frames/s", ImGui::GetIO().Framerate);
  layOutPassTimes(history_);
  ImGui::Separator();
  auto catching = static_cast<float>(stage_->look().shadowCatching);
  if (ImGui::SliderFloat("shadows on the foam", &catching, 0, 1)) stage_->look().shadowCatching = catching;
  auto reach = static_cast<float>(stage_->look().occlusionReach);
  if (ImGui::SliderFloat("reach of occlusion", &reach, 0.05f, 2)) stage_->look().occlusionReach = reach;
  ImGui::TextUnformatted(picked_.c_str());
  ImGui::Separator();
  ImGui::TextUnformatted(
      "W A S D Q E fly, drag to look, wheel: speed\n"
      "B drop the ball  right click: pick  C screenshot\n"
      "H hide this  Esc quit");
  ImGui::End();
}

}  // namespace

Status showInWindow(const MirrorRoomOptions& options) {
  MirrorRoom room(options);
  if (Status made = room.create(); !made) return made;
  return room.run();
}

}  // namespace froth
