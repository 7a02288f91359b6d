// Rays of a view's pixels, cast one by one through the runtime's public API.
#include <algorithm>
#include <cstring>
#include <limits>
#include <span>

#include "froth/froth_query.h"
#include "froth/froth_walk.h"
#include "measure/gpu/gpu_camera.h"
#include "measure/gpu/gpu_renderer_state.h"
#include "reference/camera/view_rays.h"
#include "reference/image/distances.h"

namespace froth {
namespace {

struct PixelRay {
  size_t pixel;
  ViewRay ray;
  float end;  // > 0, as 0 means no end to the runtime
};

std::vector<PixelRay> raysOf(const View& view, const Image* ends) {
  const ViewRays rays(view);
  std::vector<PixelRay> all;
  for (uint32_t y = 0; y < view.height; ++y) {
    for (uint32_t x = 0; x < view.width; ++x) {
      const std::optional<ViewRay> ray = rays.ofPixel(x, y);
      const float end = ends ? *ends->pixel(x, y) : std::numeric_limits<float>::infinity();
      if (ray) all.push_back({size_t{y} * view.width + x, *ray, std::max(end, std::numeric_limits<float>::min())});
    }
  }
  return all;
}

FrothRay queryRayOf(const View& view, const ViewRay& ray, float end) {
  const glm::dvec3 origin = eyeOf(view) + ray.offset;
  FrothRay queryRay{};
  queryRay.tMax = end;
  for (int axis = 0; axis < 3; ++axis) {
    queryRay.origin[axis] = origin[axis];
    queryRay.direction[axis] = ray.direction[axis];
  }
  return queryRay;
}

Image filled(const View& view, uint32_t channels, float value) {
  return {view.width, view.height, channels, std::vector<float>(size_t{view.width} * view.height * channels, value)};
}

// As of rays that meet nothing.
RenderedImages emptyRayImages(const View& view) {
  RenderedImages images;
  images.alpha = filled(view, 1, 0);
  images.distance = filled(view, 1, std::numeric_limits<float>::infinity());
  return images;
}

void putHit(size_t pixel, float transmittance, float distance, RenderedImages& images) {
  images.alpha.values[pixel] = 1.0f - transmittance;
  images.distance.values[pixel] = distance;
}

}  // namespace

Status GpuRenderer::State::recordRays(const glm::dvec3& eye, const RayOptions& wanted, const HostBuffer& buffer,
                                      uint32_t count, VkCommandBuffer commands) {
  FrothWalkInfo info{};
  info.structSize = sizeof(info);
  for (int axis = 0; axis < 3; ++axis) info.eye[axis] = eye[axis];
  info.cutoff = -1;
  info.maxSteps = wanted.maxSteps;
  VkDescriptorSet set = VK_NULL_HANDLE;
  if (Status made = check(frothRecordWalkSet(context, commands, &info, &set), "frothRecordWalkSet"); !made) return made;
  const VkDeviceAddress hits = buffer.address + count * sizeof(FrothGpuRay);
  const FrothResult cast = frothRecordRays(context, commands, buffer.address, hits, count, FROTH_RAY_RADIANCE);
  if (Status recorded = check(cast, "frothRecordRays"); !recorded) return recorded;
  recordMemoryBarrier(commands, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
  return {};
}

Result<std::vector<FrothGpuHit>> GpuRenderer::State::castAndRead(const glm::dvec3& eye, const RayOptions& wanted,
                                                                 const std::vector<FrothGpuRay>& asked) {
  const size_t raysSize = asked.size() * sizeof(FrothGpuRay);
  std::vector<FrothGpuHit> hits(asked.size());
  if (asked.empty()) return hits;
  const VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
  Result<HostBuffer> buffer = host->createBuffer(raysSize + hits.size() * sizeof(FrothGpuHit), usage);
  if (!buffer) return buffer.error();
  std::memcpy(buffer->mapped, asked.data(), raysSize);
  const auto count = static_cast<uint32_t>(asked.size());
  Status done =
      submitFrame([&](VkCommandBuffer commands) { return recordRays(eye, wanted, *buffer, count, commands); });
  if (done) {
    std::memcpy(hits.data(), static_cast<const char*>(buffer->mapped) + raysSize, hits.size() * sizeof(FrothGpuHit));
  }
  host->destroyBuffer(*buffer);
  if (!done) return done.error();
  // The counts of a frame are known in the frothUpdate after it.
  if (Status updated = submitFrame(); !updated) return updated.error();
  FrothWalkStatus status{};
  status.structSize = sizeof(status);
  if (Status told = check(frothGetWalkStatus(context, &status), "frothGetWalkStatus"); !told) return told.error();
  if (Status silent = checkSilence(status.indexViolations); !silent) return silent.error();
  return hits;
}

Result<RayFrame> GpuRenderer::castRays(const View& view, const RayOptions& options) {
  const std::vector<PixelRay> rays = raysOf(view, options.ends);
  std::vector<FrothGpuRay> asked;
  for (const PixelRay& one : rays) asked.push_back(gpuRayOf(view, one.ray, one.end));
  const Result<std::vector<FrothGpuHit>> hits = state_->castAndRead(eyeOf(view), options, asked);
  if (!hits) return hits.error();
  RayFrame frame{emptyRayImages(view)};
  frame.images.colour = filled(view, 3, 0);
  for (size_t i = 0; i < rays.size(); ++i) {
    const FrothGpuHit& hit = (*hits)[i];
    putHit(rays[i].pixel, hit.transmittance, hit.distance, frame.images);
    std::memcpy(&frame.images.colour.values[3 * rays[i].pixel], hit.colour, sizeof(hit.colour));
    frame.hitStepLimit = frame.hitStepLimit || hit.status == FROTH_WALK_STEP_LIMIT;
  }
  markMissingDistances(frame.images.distance);
  return frame;
}

Result<RayFrame> GpuRenderer::queryRays(const View& view, const RayOptions& options) {
  const std::vector<PixelRay> rays = raysOf(view, options.ends);
  std::vector<FrothRay> asked;
  for (const PixelRay& one : rays) asked.push_back(queryRayOf(view, one.ray, one.end));
  std::vector<FrothRayHit> hits(rays.size());
  FrothCastInfo info{};
  info.structSize = sizeof(info);
  info.cutoff = -1;
  info.maxSteps = options.maxSteps;
  const FrothResult cast =
      frothCastRays(state_->context, &info, asked.data(), hits.data(), static_cast<uint32_t>(hits.size()));
  if (Status done = state_->check(cast, "frothCastRays"); !done) return done.error();
  RayFrame frame{emptyRayImages(view)};
  for (size_t i = 0; i < rays.size(); ++i) {
    putHit(rays[i].pixel, hits[i].transmittance, static_cast<float>(hits[i].distance), frame.images);
    frame.hitStepLimit = frame.hitStepLimit || (hits[i].bits & FROTH_QUERY_STEP_LIMIT) != 0;
  }
  markMissingDistances(frame.images.distance);
  return frame;
}

}  // namespace froth
