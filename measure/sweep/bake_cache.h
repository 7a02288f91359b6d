// Bakes what a report draws, and keeps the assets in a folder until it is done.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "baker/bake/bake.h"
#include "baker/input/foam_input.h"
#include "measure/sweep/config.h"
#include "reference/camera/camera.h"

namespace froth {

struct BakeRecord {
  double seconds = 0;  // with others beside it, unless it was baked alone; 0: not baked here
  std::vector<LeftOut> leftOut;
  std::map<std::string, double> largestErrors;  // of the stored attributes, by the names and units of the manifest
};

// Refers to foam and cameras.
class BakeCache {
 public:
  // Assets are named by what they hold, so those of an interrupted report serve the next. The folder exists.
  BakeCache(const FoamInput& input, const CameraSet& cameras, std::filesystem::path folder);
  // Of an asset that stays as it is: the one that every configuration draws.
  BakeCache(const FoamInput& input, const CameraSet& cameras, std::filesystem::path folder,
            std::filesystem::path asset);

  // Bakes those that are not there yet: small foams several at a time.
  Status bake(std::span<const ReportConfig> configs, const Progress& progress);
  std::filesystem::path assetOf(const ReportConfig& config) const;
  Result<BakeRecord> recordOf(const ReportConfig& config) const;  // of a bake that is done

 private:
  Status bakeOne(const ReportConfig& config, const Progress& progress) const;
  std::filesystem::path recordPath(const ReportConfig& config) const;

  const FoamInput& input_;
  const CameraSet& cameras_;
  std::filesystem::path folder_, asset_;
};

}  // namespace froth
