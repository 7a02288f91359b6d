// The C entry points of queries.
#include "froth/froth_query.h"

#include "runtime/api/call_guard.h"

using namespace froth;

FrothResult frothCastRays(FrothContext* context, const FrothCastInfo* info, const FrothRay* rays, FrothRayHit* hits,
                          uint32_t count) {
  return guard(context, __func__, [&](const char* call) {
    FrothCastInfo known{};
    const FrothResult result = info ? readInput(context->messages, call, info, known) : FROTH_OK;
    if (result != FROTH_OK || count == 0) {
      return result;
    }
    if (!rays || !hits) {
      return failNull(*context, call, rays ? "hits" : "rays");
    }
    return context->castRays(known, {rays, count}, hits);
  });
}

FrothResult frothLocate(FrothContext* context, FrothInstance instance, const double point[3], FrothLocation* location) {
  return guard(context, __func__, [&](const char* call) {
    if (!point) {
      return failNull(*context, call, "point");
    }
    FrothLocation found{};
    const FrothResult result = context->locate(instance, {point[0], point[1], point[2]}, found);
    return result == FROTH_OK ? writeOutput(context->messages, call, found, location) : result;
  });
}

FrothResult frothOverlapSphere(FrothContext* context, const FrothSphere* sphere, FrothContact* contact) {
  return guard(context, __func__, [&](const char* call) {
    FrothSphere known;
    FrothResult result = readInput(context->messages, call, sphere, known);
    if (result < 0) {
      return result;
    }
    FrothContact found{};
    result = context->overlapSphere(known, found);
    const FrothResult written = result >= 0 ? writeOutput(context->messages, call, found, contact) : result;
    return written == FROTH_OK ? result : written;
  });
}
