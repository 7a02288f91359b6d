#include "froth/froth_quality.h"

#include <cstddef>

#include "runtime/api/call_guard.h"
#include "runtime/context/quality.h"

using namespace froth;

namespace {

Messages messagesOf(const FrothQualityInfo* info) {
  const bool hasCallback = info && info->structSize >= offsetof(FrothQualityInfo, messageUser) + sizeof(void*);
  return hasCallback ? Messages{info->onMessage, info->messageUser} : Messages{};
}

}  // namespace

FrothResult frothStepQuality(const FrothQualityInfo* info, const FrothQualityTimes* times, FrothQuality* quality) {
  const Messages messages = messagesOf(info);
  return guard(messages, __func__, [&](const char* call) {
    if (!(times && quality)) {
      return messages.fail(FROTH_ERROR_ARGUMENT, call, "%s: null", times ? "quality" : "times");
    }
    FrothQualityInfo known;
    FrothQualityTimes knownTimes;
    FrothQuality next;
    FrothResult result = readInput(messages, call, info, known);
    if (result == FROTH_OK) result = readInput(messages, call, times, knownTimes, "times.");
    if (result == FROTH_OK) result = readInput(messages, call, quality, next, "quality.");
    if (result == FROTH_OK) result = stepQuality(messages, call, known, knownTimes, next);
    return result == FROTH_OK ? writeOutput(messages, call, next, quality) : result;
  });
}
