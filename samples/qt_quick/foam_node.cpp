#include "samples/qt_quick/foam_node.h"

#include <cmath>
#include <utility>

namespace froth {

FoamNode::FoamNode(QQuickWindow& window, const QtDevice& device, std::string asset)
    : window_(window), device_(device.contextInfo()), asset_(std::move(asset)) {
  connect(&window, &QQuickWindow::beforeRendering, this, &FoamNode::render, Qt::DirectConnection);
}

// The item goes, or the window. Frames in flight may still read what is destroyed here.
FoamNode::~FoamNode() { vkDeviceWaitIdle(device_.device); }

void FoamNode::fail(const Error& error) {
  hasFailed_ = true;
  emit failed(error);
}

uint64_t FoamNode::framesInFlight() const { return static_cast<uint64_t>(window_.graphicsStateInfo().framesInFlight); }

Status FoamNode::open() {
  FrothContextInfo info = device_;
  info.framesInFlight = static_cast<uint32_t>(framesInFlight());
  Result<std::unique_ptr<FoamScene>> scene = FoamScene::create(info, asset_);
  if (!scene) return scene.error();
  scene_ = std::move(*scene);
  return {};
}

void FoamNode::synchronize(const QRectF& place, double turn) {
  if (hasFailed_) return;
  if (!scene_) {
    if (Status opened = open(); !opened) return fail(opened.error());
  }
  const double ratio = window_.effectiveDevicePixelRatio();
  const VkExtent2D extent{static_cast<uint32_t>(std::lround(ratio * place.width())),
                          static_cast<uint32_t>(std::lround(ratio * place.height()))};
  if (Status resized = resize(extent); !resized) return fail(resized.error());
  setRect(place);
  turn_ = turn;
  lastWanted_ = serial_ + framesInFlight() + 1;
}

Status FoamNode::resize(VkExtent2D extent) {
  if (target_.images && target_.images->extent().width == extent.width &&
      target_.images->extent().height == extent.height) {
    return {};
  }
  if (Status made = scene_->makeRoomFor(extent); !made) return made;
  Result<std::unique_ptr<FoamImages>> images = FoamImages::create(device_.physicalDevice, device_.device, extent);
  if (!images) return images.error();
  Target target;
  target.images = std::move(*images);
  target.texture.reset(QNativeInterface::QSGVulkanTexture::fromNative(
      target.images->shown(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, &window_,
      QSize(static_cast<int>(extent.width), static_cast<int>(extent.height)), QQuickWindow::TextureHasAlphaChannel));
  setTexture(target.texture.get());
  target_.texture.reset();  // Qt keeps what its frames in flight need of it
  target_.lastSerial = serial_;
  if (target_.images) retired_.push_back(std::move(target_));
  target_ = std::move(target);
  return {};
}

void FoamNode::render() {
  if (hasFailed_ || !target_.images) return;
  const QSGRendererInterface& qt = *window_.rendererInterface();
  window_.beginExternalCommands();
  const auto commands =
      *static_cast<VkCommandBuffer*>(qt.getResource(&window_, QSGRendererInterface::CommandListResource));
  const Result<bool> isWhole = record(commands);
  window_.endExternalCommands();
  if (!isWhole) return fail(isWhole.error());
  // Qt draws on demand. Until the foam is loaded, and has had as many frames to learn its room from as are in flight,
  // the demand is ours.
  if (!*isWhole) lastWanted_ = serial_ + framesInFlight() + 1;
  if (serial_ < lastWanted_) window_.update();
  emit drawn(*isWhole);
}

Result<bool> FoamNode::record(VkCommandBuffer commands) {
  ++serial_;
  // Qt begins a frame when the one that used its slot before is complete.
  const uint64_t completed = serial_ > framesInFlight() ? serial_ - framesInFlight() : 0;
  while (!retired_.empty() && retired_.front().lastSerial <= completed) retired_.pop_front();
  if (Status begun = scene_->beginFrame(commands, serial_, completed); !begun) return begun.error();
  Result<bool> isWhole = scene_->draw(commands, target_.images->drawn(), turn_);
  if (isWhole) target_.images->recordCopy(commands);
  return isWhole;
}

}  // namespace froth
