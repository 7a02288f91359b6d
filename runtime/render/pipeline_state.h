// The render passes as pipelines, by pass and by asset shape.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>

#include "runtime/render/depth_export.h"
#include "runtime/render/image_pass.h"
#include "runtime/render/passes.h"
#include "runtime/render/pipelines.h"
#include "shaders/gpu/layout.h"

namespace froth {

using PassPipelines = std::array<VkPipeline, kPassCount>;
using LensPipelines = std::array<PassPipelines, gpu::kLensClassCount>;  // [gpu::kLensClass...]

struct RenderPipelines::State {
  Device& device;
  VkPipelineCache cache = VK_NULL_HANDLE;
  ShaderOptions options{};
  VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;  // the output images
  VkPipelineLayout layout = VK_NULL_HANDLE;          // of all passes: the set, 128 bytes of push constants
  LensPipelines common{};              // null from kFirstMergedPass on, and for other lenses than options name
  LensPipelines merged{};              // from there to kFirstShapedPass, once made
  std::atomic<bool> canMerge = false;  // all of them are there
  std::unique_ptr<ImagePass> writeIds{}, writeMotion{};  // null without ShaderOptions::hasExtendedFormats
  std::unique_ptr<ImagePass> writeReactive{};            // the same, and without keepsQuarters
  std::unique_ptr<ImagePass> composite{};                // null without ShaderOptions::compositeFormat,
  std::unique_ptr<DepthExport> depthExport{};            // depthExportFormat
  std::map<AssetShape, LensPipelines> byShape{};         // complete; guarded by `mutex`, entries never change or move
  std::mutex mutex{};
  std::mutex making{};  // held while pipelines are made: nobody makes the same ones

  bool hasLensClass(uint32_t lensClass) const;
  // Null if prepareFor was not called for this shape, or the context has not this class of lenses.
  const PassPipelines* find(const AssetShape& shape, uint32_t lensClass);
};

// The caller's images (gpu::kBinding...).
SetBindings outputBindings();

}  // namespace froth
