// Fades from cut to cut of assets with levels of detail. There is one at a time in a context: cuts that can change
// begin it together, and no other changes until it ends. So each view has one weight, and each asset two cuts at most.
#include <algorithm>

#include "runtime/context/context.h"
#include "runtime/render/border_pass.h"
#include "runtime/render/fade.h"

namespace froth {

uint32_t Context::mostFadeFrames() const {
  uint32_t most = 0;
  views_.forEach([&](const View& view) { most = std::max(most, view.fadeFrames); });
  return most;
}

bool Context::isFading() const {
  bool isAny = false;
  assets_.forEach([&](const Asset& asset) { isAny = isAny || asset.before(); });
  return isAny;
}

// In each frame, before cuts change: fadeStep_ is 1 if they may.
void Context::stepFade() {
  const uint32_t frames = mostFadeFrames();
  ++fadeStep_;
  assets_.forEach([&](Asset& asset) {
    if (asset.before() && (fadeStep_ > frames || asset.mustEndFade())) asset.endFade(serial_);
  });
  if (!isFading()) fadeStep_ = 1;
}

// Of the cuts now; 1: nothing fades. Else the instances with the cuts before are in view.visibleBefore.
float Context::fadeWeight(View& view, const FrothRenderInfo& info) const {
  if (!isFading() || fadeStep_ > view.fadeFrames || !info.colour.image) return 1;
  bool isAny = false, areCovered = true;
  view.visibleBefore = view.visible;
  for (RenderInstance& instance : view.visibleBefore) {
    assets_.forEach([&](const Asset& asset) {
      if (instance.asset != &asset.gpu() || !asset.before()) return;
      instance.asset = asset.before();
      isAny = true;
    });
    areCovered = areCovered && view.renderer->covers(instance);
  }
  return isAny && areCovered ? static_cast<float>(fadeStep_) / static_cast<float>(view.fadeFrames + 1) : 1;
}

// The table of borders is that of the cuts now before this is called, and after it. A recording leaves it so: others
// may be recorded at once, and submitted in any order.
uint32_t Context::recordView(RenderMethod method, View& view, VkCommandBuffer commandBuffer,
                             const FrothRenderInfo& info) {
  const bool isWalk = method == RenderMethod::kWalk;
  if (isWalk) publishBorders(commandBuffer);
  const float weight = fadeWeight(view, info);
  if (weight == 1) {
    return view.renderer->record(method, commandBuffer, *pipelines_, view.visible, info, serial_, 1);
  }
  const FadeInfos infos = splitForFade(info);
  if (isWalk) turnBorders(commandBuffer, true);
  uint32_t bits =
      view.renderer->record(method, commandBuffer, *pipelines_, view.visibleBefore, infos.before, serial_, 0);
  if (isWalk) turnBorders(commandBuffer, false);
  bits |= view.renderer->record(method, commandBuffer, *pipelines_, view.visible, infos.now, serial_, weight);
  return bits;
}

// Of assets that fade: to where the borders were in the cut before, or back.
void Context::turnBorders(VkCommandBuffer commandBuffer, bool isBefore) {
  assets_.forEach([&](const Asset& asset) {
    if (!asset.before() || !asset.gpu().hasWalkGraph || stateOf(asset) != FROTH_ASSET_READY) return;
    recordBorders(device_, *pipelines_, commandBuffer, isBefore ? *asset.before() : asset.gpu(),
                  isBefore ? asset.bordersBefore() : asset.bordersNow());
  });
}

}  // namespace froth
