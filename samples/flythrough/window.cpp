#include "samples/flythrough/window.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <GLFW/glfw3.h>
#include <imgui.h>

#include "samples/flythrough/cameras_json.h"
#include "samples/host/fly_camera.h"
#include "samples/host/frame_ring.h"
#include "samples/host/imgui_layer.h"
#include "samples/flythrough/overlay.h"
#include "samples/host/picture_file.h"
#include "samples/host/vulkan_check.h"
#include "samples/host/window_system.h"

namespace froth {
namespace {

constexpr double kSecondsPerKey = 2.0;      // of the path camera
constexpr double kRadiansPerPixel = 0.003;  // of a drag

class Flythrough {
 public:
  explicit Flythrough(const FlythroughOptions& options) : options_(options), shown_(options.picture) {}
  ~Flythrough();

  Status create();
  Status run();

 private:
  Status resize();
  Status startFlight();
  void handleInput(double seconds);
  void steer(double seconds);

  Status drawFrame();
  void recordBlit(VkCommandBuffer commands, VkImage target);
  OverlayContent overlayContent() const;
  Pose currentPose() const;
  Status saveScreenshot();

  // Destroyed from the last to the first.
  const FlythroughOptions& options_;
  std::unique_ptr<WindowSystem> system_;
  std::unique_ptr<Host> host_;
  std::unique_ptr<Swapchain> swapchain_;
  std::unique_ptr<FrameRing> frames_;
  std::unique_ptr<ImGuiLayer> imgui_;
  Overlay overlay_;
  std::unique_ptr<Scene> scene_;
  std::unique_ptr<Painter> painter_;

  std::vector<Pose> keys_;          // of --cameras
  std::optional<CameraPath> path_;  // once the asset is ready
  std::optional<FlyCamera> flight_;
  double pathSeconds_ = 0;
  Picture shown_;
  bool isOnPath_ = true, isOverlayShown_ = true, isScreenshotWanted_ = false;
  uint32_t screenshots_ = 0;
};

Flythrough::~Flythrough() {
  if (!host_) return;
  vkDeviceWaitIdle(host_->device);
  painter_.reset();
  scene_.reset();
  imgui_.reset();
  frames_.reset();
  swapchain_.reset();
  system_->destroySurface();
}

Status Flythrough::create() {
  if (!options_.cameras.empty()) {
    Result<std::vector<Pose>> keys = readKeyPoses(options_.cameras);
    if (!keys) return keys.error();
    keys_ = std::move(*keys);
  }
  Result<std::unique_ptr<WindowSystem>> system = WindowSystem::create("Froth", options_.extent);
  if (!system) return system.error();
  system_ = std::move(*system);
  HostOptions hostOptions{options_.device, options_.validate};
  hostOptions.instanceExtensions = system_->instanceExtensions();
  hostOptions.deviceExtensions = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
  Result<std::unique_ptr<Host>> host = Host::create(hostOptions);
  if (!host) return host.error();
  host_ = std::move(*host);
  if (Status made = system_->createSurface(host_->instance); !made) return made;

  swapchain_ = std::make_unique<Swapchain>(*host_, system_->surface());
  if (Status chosen = swapchain_->chooseFormat(); !chosen) return chosen;
  if (Status sized = swapchain_->resize(system_->framebufferExtent()); !sized) return sized;
  Result<std::unique_ptr<FrameRing>> frames = FrameRing::create(*host_);
  if (!frames) return frames.error();
  frames_ = std::move(*frames);
  Result<std::unique_ptr<ImGuiLayer>> imgui = ImGuiLayer::create(*host_, system_->window(), *swapchain_);
  if (!imgui) return imgui.error();
  imgui_ = std::move(*imgui);

  FrothContextInfo contextInfo = host_->contextInfo();
  contextInfo.framesInFlight = kFramesInFlight;
  contextInfo.countWork = options_.isCounting ? 1 : 0;
  Result<std::unique_ptr<Scene>> scene = Scene::create(contextInfo, options_.asset);
  if (!scene) return scene.error();
  scene_ = std::move(*scene);
  painter_ = std::make_unique<Painter>(*host_);
  return painter_->setExtent(*scene_, swapchain_->extent());
}

Status Flythrough::resize() {
  const VkExtent2D extent = system_->framebufferExtent();
  if (extent.width == 0 || extent.height == 0) return {};  // minimized: there is nothing to draw to
  vkDeviceWaitIdle(host_->device);
  if (Status sized = swapchain_->resize(extent); !sized) return sized;
  if (Status set = imgui_->setSwapchain(*swapchain_); !set) return set;
  return painter_->setExtent(*scene_, swapchain_->extent());
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
  return {};
}

Pose Flythrough::currentPose() const {
  if (!path_) return {};
  if (!isOnPath_) return flight_->pose();
  // There and back again, without end.
  const double duration = kSecondsPerKey * static_cast<double>(path_->keyCount());
  const double share = std::fmod(pathSeconds_ / duration, 2.0);
  return path_->at(share <= 1 ? share : 2 - share);
}

void Flythrough::handleInput(double seconds) {
  if (ImGui::IsKeyPressed(GLFW_KEY_ESCAPE, false)) glfwSetWindowShouldClose(system_->window(), GLFW_TRUE);
  if (ImGui::IsKeyPressed(GLFW_KEY_1, false)) shown_ = Picture::kRaster;
  if (ImGui::IsKeyPressed(GLFW_KEY_2, false)) shown_ = Picture::kWalk;
  if (ImGui::IsKeyPressed(GLFW_KEY_3, false)) shown_ = Picture::kDifference;
  if (ImGui::IsKeyPressed(GLFW_KEY_H, false)) isOverlayShown_ = !isOverlayShown_;
  if (ImGui::IsKeyPressed(GLFW_KEY_C, false)) isScreenshotWanted_ = true;
  if (!path_) return;
  if (ImGui::IsKeyPressed(GLFW_KEY_P, false)) {
    flight_->jumpTo(currentPose());
    isOnPath_ = !isOnPath_;
  }
  if (isOnPath_) pathSeconds_ += seconds;
  steer(seconds);
}

void Flythrough::steer(double seconds) {
  const ImGuiIO& io = ImGui::GetIO();
  const auto axis = [](int positive, int negative) {
    return static_cast<double>(ImGui::IsKeyDown(positive)) - static_cast<double>(ImGui::IsKeyDown(negative));
  };
  FlyInput input;
  input.seconds = seconds;
  input.move = {axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_Q, GLFW_KEY_E), axis(GLFW_KEY_W, GLFW_KEY_S)};
  if (ImGui::IsMouseDown(ImGuiMouseButton_Left) && !io.WantCaptureMouse) {
    input.turn = kRadiansPerPixel * glm::dvec2(io.MouseDelta.x, io.MouseDelta.y);
  }
  if (!io.WantCaptureMouse && io.MouseWheel != 0) flight_->scaleSpeed(std::pow(1.2, io.MouseWheel));
  if (isOnPath_ && (input.move != glm::dvec3(0) || input.turn != glm::dvec2(0))) {
    flight_->jumpTo(currentPose());  // whoever steers leaves the path where it was
    isOnPath_ = false;
  }
  flight_->step(input);
}

// Premultiplied colour over black is the colour itself; the blit to an sRGB format encodes it.
void Flythrough::recordBlit(VkCommandBuffer commands, VkImage target) {
  imageBarrier(
      commands, target, {VK_IMAGE_LAYOUT_UNDEFINED, VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_NONE},
      {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT});
  const auto width = static_cast<int32_t>(swapchain_->extent().width);
  const auto height = static_cast<int32_t>(swapchain_->extent().height);
  VkImageBlit region{};
  region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.srcOffsets[1] = region.dstOffsets[1] = {width, height, 1};
  vkCmdBlitImage(commands, painter_->result().image, VK_IMAGE_LAYOUT_GENERAL, target,
                 VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_NEAREST);
}

OverlayContent Flythrough::overlayContent() const {
  OverlayContent content;
  content.picture = nameOf(shown_);
  content.camera = isOnPath_ ? "path" : "free flight";
  content.asset = scene_->assetStatus();
  content.frame = scene_->frameStatus();
  if (const Result<FrothViewStatus> view = scene_->viewStatus()) content.view = *view;
  return content;
}

Status Flythrough::drawFrame() {
  Result<FrameSlot*> slot = frames_->wait();
  if (!slot) return slot.error();
  uint32_t index = 0;
  const VkResult acquired = vkAcquireNextImageKHR(host_->device, swapchain_->handle(), UINT64_MAX,
                                                  (*slot)->isAcquired, VK_NULL_HANDLE, &index);
  if (acquired == VK_ERROR_OUT_OF_DATE_KHR) return resize();  // nothing was acquired; the next turn draws
  if (acquired != VK_SUBOPTIMAL_KHR) {
    if (Status got = checkVulkan(acquired, "vkAcquireNextImageKHR"); !got) return got;
  }
  const SwapchainImage& target = swapchain_->images()[index];

  VkCommandBuffer commands = (*slot)->commands;
  if (Status begun = frames_->begin(**slot); !begun) return begun;
  Status recorded = scene_->beginFrame(commands, frames_->nextSerial(), frames_->completedSerial());
  if (!recorded) return recorded;
  if (!path_ && scene_->isReady()) {
    if (Status started = startFlight(); !started) return started;
  }
  recorded = painter_->record(commands, *scene_, shown_, currentPose(), VK_PIPELINE_STAGE_2_BLIT_BIT);
  if (!recorded) return recorded;
  recordBlit(commands, target.image);
  if (isOverlayShown_) overlay_.layOut(overlayContent(), swapchain_->extent());
  imgui_->record(commands, index);
  if (Status submitted = frames_->submit(**slot, target.isDrawn); !submitted) return submitted;

  const VkSwapchainKHR handle = swapchain_->handle();
  VkPresentInfoKHR present{};
  present.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
  present.waitSemaphoreCount = 1;
  present.pWaitSemaphores = &target.isDrawn;
  present.swapchainCount = 1;
  present.pSwapchains = &handle;
  present.pImageIndices = &index;
  const VkResult presented = vkQueuePresentKHR(host_->queue, &present);
  if (presented == VK_ERROR_OUT_OF_DATE_KHR || presented == VK_SUBOPTIMAL_KHR) return resize();
  return checkVulkan(presented, "vkQueuePresentKHR");
}

Status Flythrough::saveScreenshot() {
  vkDeviceWaitIdle(host_->device);
  const Result<std::vector<float>> texels = host_->readImage(painter_->result());
  if (!texels) return texels.error();
  char name[48];
  std::snprintf(name, sizeof(name), "screenshot_%02u.png", screenshots_++);
  const std::filesystem::path path = options_.output / name;
  if (Status written = writePicture(path, encodePicture(*texels, painter_->result().extent)); !written)
    return written;
  std::printf("%s\n", path.c_str());
  return {};
}

Status Flythrough::run() {
  using Clock = std::chrono::steady_clock;
  Clock::time_point last = Clock::now();
  for (uint32_t frame = 0; options_.frames == 0 || frame < options_.frames; ++frame) {
    glfwPollEvents();
    const VkExtent2D extent = system_->framebufferExtent();
    if (glfwWindowShouldClose(system_->window())) break;
    if (extent.width == 0 || extent.height == 0) {
      glfwWaitEvents();  // minimized
      continue;
    }

    const Clock::time_point now = Clock::now();
    imgui_->beginFrame();
    handleInput(std::chrono::duration<double>(now - std::exchange(last, now)).count());
    if (Status drawn = drawFrame(); !drawn) return drawn;
    ImGui::EndFrame();  // does nothing if the frame was drawn; else closes what no one rendered
    if (std::exchange(isScreenshotWanted_, false)) {
      if (Status saved = saveScreenshot(); !saved) return saved;
    }
  }
  return host_->checkSilence();
}

}  // namespace

Status flyInWindow(const FlythroughOptions& options) {
  Flythrough flythrough(options);
  if (Status made = flythrough.create(); !made) return made;
  return flythrough.run();
}

}  // namespace froth
