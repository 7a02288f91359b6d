// Pipelines of the render passes. Made at context creation and asset opening, never inside a record call.
#pragma once

#include <memory>

#include "runtime/asset/gpu_asset.h"
#include "runtime/core/device.h"

namespace froth {

class RenderPipelines {
 public:
  // Makes what does not depend on an asset. `checkIndices` specializes all shaders to check and count.
  static Result<std::unique_ptr<RenderPipelines>> create(Device& device, VkPipelineCache cache,
                                                         bool checkIndices);
  ~RenderPipelines();

  // Makes the pipelines specialized on an asset's shape (K, M, what it holds). Called before the asset becomes
  // READY; idempotent.
  Status prepareFor(const GpuAsset& asset);

  struct State;
  State& state() { return *state_; }

 private:
  RenderPipelines();
  std::unique_ptr<State> state_;
};

}  // namespace froth
