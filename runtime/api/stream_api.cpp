// The C entry points of streaming.
#include "froth/froth_stream.h"

#include "runtime/api/call_guard.h"

using namespace froth;

FrothResult frothSetStreaming(FrothContext* context, const FrothStreamInfo* info) {
  return guard(context, __func__, [&](const char* call) {
    FrothStreamInfo known;
    const FrothResult result = readInput(context->messages, call, info, known);
    return result == FROTH_OK ? context->setStreaming(known) : result;
  });
}

FrothResult frothGetStreamStatus(FrothContext* context, FrothStreamStatus* status) {
  return guard(context, __func__, [&](const char* call) {
    FrothStreamStatus known{};
    const FrothResult result = context->describeStreaming(known);
    return result == FROTH_OK ? writeOutput(context->messages, call, known, status) : result;
  });
}

FrothResult frothGetChunks(FrothContext* context, FrothAsset asset, uint32_t capacity, FrothChunk* chunks,
                           uint32_t* count) {
  return guard(context, __func__, [&](const char* call) {
    return count ? context->copyChunks(asset, capacity, chunks, *count) : failNull(*context, call, "count");
  });
}
