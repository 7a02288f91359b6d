// Draws through the runtime's public calls on a device with validation and index checks; what tests ask of an
// image.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "baker/bake/bake.h"
#include "base/image/image.h"
#include "foam/foam.h"
#include "format/asset_contents.h"
#include "froth/froth.h"
#include "host/host.h"
#include "host/method.h"
#include "reference/camera/camera.h"
#include "reference/image/metrics.h"
#include "reference/render/reference.h"

namespace froth::test {

struct Frame {
  Image colour;                             // 3 channels, as the image holds them
  Image alpha;                              // 1 channel
  Image distance;                           // 1 channel; +inf: never
  Image normal;                             // 3 channels
  Image depth;                              // 1 channel, device depth
  std::vector<std::array<uint32_t, 2>> id;  // of a view that keeps hits; else empty, as what follows
  Image motion;                             // 2 channels
  Image reactive;                           // 1 channel
  FrothViewStatus status{};
};

// Fails the test for another result than FROTH_OK.
void check(FrothResult result, const char* call);
// FrothContextInfo::onMessage that fails the test.
void failOnMessage(void* user, FrothSeverity severity, FrothResult code, const char* object, const char* text);

// One device with validation layers, and one context that checks indices, for all tests of the program:
// pipelines are made once per asset shape. A shared context holds one Stage at a time, else its constructor fails the
// test.
Host& sharedHost();
FrothContext* sharedContext();
// For contexts on that device; they share what shaders compile to (tests/kept_pipelines.h).
FrothContextInfo sharedContextInfo();

// The same for cameras of all lenses.
FrothContext* lensContext();
// Of such contexts; lenses: FrothContextInfo::lensClasses.
FrothContextInfo checkedContextInfo(uint32_t lensClasses);
// A context of its own, for instances that stay; lenses: FrothContextInfo::lensClasses.
FrothContext* createCheckedContext(uint32_t lensClasses);

// One asset, one instance, one view. Any failing call, validation message or index violation fails the test.
class Stage {
 public:
  Stage(const AssetContents& contents, VkExtent2D maxExtent, FrothContext* context = sharedContext(),
        uint32_t layers = 0, uint32_t lensClasses = 0, bool keepsHits = false, uint32_t eyeCount = 0,
        bool keepForQueries = true, bool keepsReactive = false);
  ~Stage();

  void place(const FrothInstanceInfo& placement);  // `asset` is filled in
  Frame draw(Method method, const FrothRenderInfo& info, VkExtent2D extent,
             VkFormat colourFormat = VK_FORMAT_R32G32B32A32_SFLOAT, const std::function<void()>& afterUpdate = {});
  Frame draw(Method method, const View& view);

  // Records only the wanted images of `info`; returns the status of that frame.
  FrothViewStatus submit(Method method, const FrothRenderInfo& info) { return submit({{method, info}}); }

  FrothView view() const { return view_; }
  FrothAssetStatus assetStatus() const;
  FrothInstance instance() const { return instance_; }
  FrothAsset asset() const { return asset_; }
  FrothContext* context() const { return context_; }

  // Several draws in one frame and command buffer. afterUpdate: called between frothUpdate and the first of them;
  // afterDraws:
  // after the last.
  FrothViewStatus submit(const std::vector<std::pair<Method, FrothRenderInfo>>& draws,
                         const std::function<void()>& afterUpdate = {},
                         const std::function<void(VkCommandBuffer)>& afterDraws = {});

 private:
  FrothContext* context_;
  std::vector<uint8_t> bytes_;
  FrothAsset asset_{};
  FrothInstance instance_{};
  FrothView view_{};
  bool keepsHits_, keepsReactive_;
};

FrothInstanceInfo placementOf(const glm::dvec3& position, const glm::vec4& rotation, float scale);

// A camera at `eye` that looks at `target`, `width` x `height` pixels, with the given half-angle's tangent.
View lookAt(const glm::dvec3& eye, const glm::dvec3& target, uint32_t width, uint32_t height, double tanHalfFovY);

// `size` pixels of R32G32B32A32_SFLOAT with the view's ray map.
HostImage uploadRayMap(const View& view);

// Display-coded, cut-off 1e-3, reversed depth with an infinite far plane; near limits of the view, else off. A ray
// map's image is left to the caller.
FrothRenderInfo infoOf(const View& view);

AssetContents bakeForTest(const Foam& foam);
// sceneDistance: ReferenceOptions.
RenderedImages renderReference(const Foam& foam, const View& view, double cutoff = 0,
                               const Image* sceneDistance = nullptr);

double psnr(const Image& a, const Image& b);
double overTwoSteps(const Image& a, const Image& b);

}  // namespace froth::test
