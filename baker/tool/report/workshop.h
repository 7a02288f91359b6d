// Bakes what a report draws, and keeps the assets in a folder until it is done.
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <span>
#include <string>

#include "baker/bake/bake.h"
#include "baker/camera/camera.h"
#include "baker/tool/foam_input.h"
#include "baker/tool/report/config.h"

namespace froth {

// Refers to foam and cameras.
class Workshop {
 public:
  // Assets are named by what they hold, so those of an interrupted report serve the next.
  Workshop(const FoamInput& input, const CameraSet& cameras, std::filesystem::path folder);

  // Bakes those that are not there yet: small foams several at a time.
  Status bake(std::span<const ReportConfig> configs, const Progress& progress);
  std::filesystem::path assetOf(const ReportConfig& config) const;
  // Of the bake [s]; 0: done by an earlier run.
  double secondsOf(const ReportConfig& config) const;
  // What the bake said it left out; empty: done by an earlier run.
  std::vector<LeftOut> leftOutOf(const ReportConfig& config) const;

 private:
  struct Done {
    double seconds = 0;
    std::vector<LeftOut> leftOut;
  };
  Status bakeOne(const ReportConfig& config, const Progress& progress);

  const FoamInput& input_;
  const CameraSet& cameras_;
  std::filesystem::path folder_;
  mutable std::mutex mutex_;
  std::map<std::string, Done> done_;  // by encodingKey
};

}  // namespace froth
