#include "samples/flythrough/streaming.h"

#include <utility>

namespace froth {

Status applySettings(const Scene& scene, const StreamSettings& settings) {
  Status set = scene.check(frothSetBudget(scene.context(), settings.budget), "frothSetBudget");
  if (!set) return set;
  FrothStreamInfo info{};
  info.structSize = sizeof(info);
  info.detail = settings.detail;
  info.isFrozen = settings.isFrozen ? 1 : 0;
  return scene.check(frothSetStreaming(scene.context(), &info), "frothSetStreaming");
}

Result<StreamFigures> readFigures(const Scene& scene) {
  const Result<FrothStreamStatus> status = scene.streamStatus();
  if (!status) return status.error();
  Result<std::vector<FrothChunk>> chunks = scene.chunks();
  if (!chunks) return chunks.error();
  return StreamFigures{*status, std::move(*chunks)};
}

}  // namespace froth
