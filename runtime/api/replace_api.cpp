// The C entry points of hot reload.
#include "froth/froth_replace.h"

#include "runtime/api/call_guard.h"

using namespace froth;

FrothResult frothReplaceAsset(FrothContext* context, FrothAsset asset, const FrothAssetInfo* info) {
  return guard(context, __func__, [&](const char* call) {
    FrothAssetInfo known;
    FrothReader reader;
    const FrothResult result = readAssetInfo(context->messages, call, info, known, reader);
    return result == FROTH_OK ? context->replaceAsset(asset, known) : result;
  });
}

FrothResult frothGetReplacement(FrothContext* context, FrothAsset asset, FrothReplacementStatus* status) {
  return guard(context, __func__, [&](const char* call) {
    FrothReplacementStatus known{};
    const FrothResult result = context->describeReplacement(asset, known);
    return result == FROTH_OK ? writeOutput(context->messages, call, known, status) : result;
  });
}
