#include <cstddef>

#include "runtime/api/call_guard.h"
#include "runtime/context/estimate.h"

using namespace froth;

namespace {

Messages messagesOf(const FrothEstimateInfo* info) {
  const bool hasCallback = info && info->structSize >= offsetof(FrothEstimateInfo, messageUser) + sizeof(void*);
  return hasCallback ? Messages{info->onMessage, info->messageUser} : Messages{};
}

}  // namespace

FrothResult frothEstimateMemory(const FrothEstimateInfo* info, FrothMemoryEstimate* estimate) {
  const Messages messages = messagesOf(info);
  return guard(messages, __func__, [&](const char* call) {
    FrothEstimateInfo known;
    FrothAssetInfo asset;
    FrothViewInfo view;
    FrothResult result = readInput(messages, call, info, known);
    if (result == FROTH_OK && !(estimate && known.asset)) {
      return messages.fail(FROTH_ERROR_ARGUMENT, call, "%s: null", estimate ? "asset" : "estimate");
    }
    if (result == FROTH_OK) result = readInput(messages, "frothEstimateMemory, asset", known.asset, asset);
    if (result == FROTH_OK && known.view) result = readInput(messages, "frothEstimateMemory, view", known.view, view);
    if (result != FROTH_OK) {
      return result;
    }
    known.asset = &asset;
    known.view = known.view ? &view : nullptr;
    FrothMemoryEstimate made{};
    result = estimateMemory(messages, call, known, made);
    return result == FROTH_OK ? writeOutput(messages, call, made, estimate) : result;
  });
}
