// Pipelines of the render passes. Made at context creation and asset opening, never inside a record call.
#pragma once

#include <memory>

#include "runtime/asset/gpu_asset.h"
#include "runtime/device/device.h"

namespace froth {

// What all shaders are specialized to do besides.
struct ShaderOptions {
  bool checkIndices = false;                         // check every index, count those out of range
  bool countWork = false;                            // count what rays cost
  bool floatColours = false;                         // keep colours of detail sites as floats
  uint32_t lensClasses = 0;                          // FrothLensClass: what cameras they are made for besides pinholes
  bool hasExtendedFormats = false;                   // the device has shaderStorageImageExtendedFormats
  bool keepsQuarters = false;                        // full frames can have what reactive is made from
  VkFormat compositeFormat = VK_FORMAT_UNDEFINED;    // of the engine's colour; UNDEFINED: no pass for it
  VkFormat depthExportFormat = VK_FORMAT_UNDEFINED;  // of its depth attachment
};

class RenderPipelines {
 public:
  // Makes what does not depend on an asset.
  static Result<std::unique_ptr<RenderPipelines>> create(Device& device, VkPipelineCache cache, ShaderOptions options);
  ~RenderPipelines();

  // Makes the pipelines specialized on an asset's shape; if they are there already, returns at once. Any thread.
  Status prepareFor(const AssetShape& shape);

  bool hasShape(const AssetShape& shape) const;

  // The same for those that draw several instances.
  Status prepareMerging();
  bool canMerge() const;

  struct State;
  State& state() { return *state_; }

 private:
  RenderPipelines(Device& device, VkPipelineCache cache, ShaderOptions options);
  std::unique_ptr<State> state_;
};

}  // namespace froth
