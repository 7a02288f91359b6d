// The C entry points of rays on the GPU.
#include "froth/froth_walk.h"

#include "runtime/api/call_guard.h"

using namespace froth;

FrothResult frothGetWalkSetLayout(FrothContext* context, VkDescriptorSetLayout* layout) {
  return guard(context, __func__, [&](const char* call) {
    return layout ? context->describeWalkLayout(*layout) : failNull(*context, call, "layout");
  });
}

FrothResult frothRecordWalkSet(FrothContext* context, VkCommandBuffer commandBuffer, const FrothWalkInfo* info,
                               VkDescriptorSet* set) {
  return guard(context, __func__, [&](const char* call) {
    if (!set) {
      return failNull(*context, call, "set");
    }
    *set = VK_NULL_HANDLE;
    FrothWalkInfo known;
    const FrothResult result = readInput(context->messages, call, info, known);
    return result == FROTH_OK ? context->recordWalkSet(commandBuffer, known, *set) : result;
  });
}

FrothResult frothRecordRays(FrothContext* context, VkCommandBuffer commandBuffer, VkDeviceAddress rays,
                            VkDeviceAddress hits, uint32_t count, FrothRayKind kind) {
  return guard(context, __func__,
               [&](const char*) { return context->recordRays(commandBuffer, rays, hits, count, kind); });
}

FrothResult frothGetWalkStatus(FrothContext* context, FrothWalkStatus* status) {
  return guard(context, __func__, [&](const char* call) {
    FrothWalkStatus known{};
    const FrothResult result = context->describeWalks(known);
    return result == FROTH_OK ? writeOutput(context->messages, call, known, status) : result;
  });
}
