#include "measure/sweep/config.h"

#include <fmt/format.h>

namespace froth {

std::string encodingKey(const ReportConfig& config) {
  const BakeKnobs& k = config.knobs;
  std::string key = fmt::format("p{} r{} d{} f{} s{} h{} w{} t{} k{} n{} v{}", k.positionBits, k.radiusBits,
                                k.densityBits, k.frameBits, k.detailSiteBits, k.heightBits, config.walkGraph,
                                config.steiner, config.detailsKept, config.copies, config.hasCameras);
  if (!k.compressColours) return key;
  const AppearanceOptions& a = k.appearance;
  return key +
         fmt::format(" e{} l{} b{} c{} x{}", a.errorBound, a.lobeLimit, a.codebookSize, a.colourStep, a.lobeAxisStep);
}

std::string configKey(const ReportConfig& config) {
  return fmt::format("{} | {} c{} l{} m{} s{} t{} u{}", encodingKey(config), infoOf(config.method).name, config.cutoff,
                     config.layers, config.maxSteps, config.pixelSize, config.streaming.detail,
                     config.streaming.budget);
}

ReportConfig defaultConfig() {
  ReportConfig config;
  config.knobs = *presetKnobs("default");
  return config;
}

ReportConfig exactConfig() {
  ReportConfig config;
  config.cutoff = 0;
  return config;
}

}  // namespace froth
