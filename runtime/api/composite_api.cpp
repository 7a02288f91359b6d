// The C entry points that write into the engine's own images.
#include "froth/froth_composite.h"

#include "runtime/api/call_guard.h"

using namespace froth;

FrothResult frothRecordComposite(FrothContext* context, FrothView view, VkCommandBuffer commandBuffer,
                                 const FrothCompositeInfo* info) {
  return guard(context, __func__, [&](const char* call) {
    FrothCompositeInfo known;
    const FrothResult result = readInput(context->messages, call, info, known);
    return result == FROTH_OK ? context->composite(view, commandBuffer, known) : result;
  });
}

FrothResult frothRecordDepthExport(FrothContext* context, FrothView view, VkCommandBuffer commandBuffer,
                                   const FrothDepthExportInfo* info) {
  return guard(context, __func__, [&](const char* call) {
    FrothDepthExportInfo known;
    const FrothResult result = readInput(context->messages, call, info, known);
    return result == FROTH_OK ? context->exportDepth(view, commandBuffer, known) : result;
  });
}
