#include "froth/froth_reader.h"
#include "runtime/api/call_guard.h"

using namespace froth;

FrothResult frothCompleteRead(FrothContext* context, uint64_t request, FrothResult result) {
  return guard(context, __func__, [&](const char*) { return context->completeRead(request, result); });
}
