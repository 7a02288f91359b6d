#include "froth/froth_precompile.h"
#include "runtime/api/call_guard.h"

using namespace froth;

FrothResult frothReadVariant(FrothContext* context, const FrothAssetInfo* info, FrothVariant* variant) {
  return guard(context, __func__, [&](const char* call) {
    if (!variant) {
      return failNull(*context, call, "variant");
    }
    *variant = {};
    FrothAssetInfo known;
    const FrothResult result = readInput(context->messages, call, info, known);
    return result == FROTH_OK ? context->readVariant(known, *variant) : result;
  });
}

FrothResult frothPrecompile(FrothContext* context, const FrothPrecompileInfo* info) {
  return guard(context, __func__, [&](const char* call) {
    FrothPrecompileInfo known;
    const FrothResult result = readInput(context->messages, call, info, known);
    return result == FROTH_OK ? context->precompile(known) : result;
  });
}
