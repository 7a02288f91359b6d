#include "measure/sweep/features.h"

#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "baker/synth/simplify.h"
#include "format/read/asset_reader.h"

namespace froth {
namespace {

// One part: its own foam where the input has to change, and what is baked with and without.
struct Part {
  FeatureCost cost;
  std::function<Foam(const Foam&)> change;  // of the variant; empty: the input itself
  std::function<void(ReportConfig&)> turn;  // the variant's configuration
};

Part partOf(const char* feature, bool isUsed, const char* variant, std::function<Foam(const Foam&)> change,
            std::function<void(ReportConfig&)> turn = {}) {
  Part part;
  part.cost.feature = feature;
  part.cost.isUsed = isUsed;
  part.cost.variant = variant;
  part.change = std::move(change);
  part.turn = std::move(turn);
  return part;
}

bool hasHeights(const Foam& foam) {
  return std::any_of(foam.detailHeights.begin(), foam.detailHeights.end(), [](float height) { return height != 0; });
}

std::vector<Part> listParts(const Foam& foam, const AssetContents& asset) {
  std::vector<Part> parts;
  if (asset.lobeCount > 0) {
    parts.push_back(partOf("view dependence", true, "baked with --lobes 0", {},
                           [](ReportConfig& config) { config.knobs.appearance.lobeLimit = 0; }));
  } else {
    parts.push_back(partOf("view dependence", false, "two lobes of 1/16 put in", withSomeViewDependence));
  }
  if (hasHeights(foam)) {
    parts.push_back(partOf("displacement", true, "heights taken out", withoutDisplacement));
  } else {
    parts.push_back(partOf("displacement", false, "heights of 1/16 radius put in", withSomeDisplacement));
  }
  if (foam.detailCount > 1) {
    parts.push_back(partOf("detail sites", true, "one left in each cell", {},
                           [](ReportConfig& config) { config.detailsKept = 1; }));
  } else {
    parts.push_back(partOf("detail sites", false, "each made two, 1/16 apart in colour", withSomeDetailSites));
  }
  parts.push_back(partOf("walk graph", true, "baked with --no-walk", {},
                         [](ReportConfig& config) { config.walkGraph = config.steiner = false; }));
  parts.push_back(partOf("Steiner cells", true, "baked with --no-steiner", {},
                         [](ReportConfig& config) { config.steiner = false; }));
  return parts;
}

Draw drawBy(Draw draw, Method method, const std::filesystem::path& asset) {
  draw.options.method = method;
  draw.asset = asset;
  draw.options.isLinear = true;
  return draw;
}

// Bakes the variant and says where it lies.
Result<std::filesystem::path> bakeVariant(const Part& part, const Bench& bench, const FoamInput& input,
                                          const CameraSet& cameras, const std::filesystem::path& folder,
                                          const Progress& progress) {
  ReportConfig config = defaultConfig();
  if (part.turn) part.turn(config);
  if (!part.change) {
    if (Status baked = bench.bakes.bake({&config, 1}, progress); !baked) return baked.error();
    return bench.bakes.assetOf(config);
  }
  FoamInput changed = input;
  changed.foam = part.change(input.foam);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return makeError(ErrorKind::kIo, "%s: %s", folder.c_str(), error.message().c_str());
  BakeCache bakes(changed, cameras, folder);
  if (Status baked = bakes.bake({&config, 1}, progress); !baked) return baked.error();
  return bakes.assetOf(config);
}

Result<double> psnrOf(const Bench& bench, const std::filesystem::path& asset, const Progress& progress) {
  Draw draw = drawOf(bench, defaultConfig());
  draw.asset = asset;
  Result<std::vector<RenderedImages>> images = bench.renderer.render(draw, progress);
  if (!images) return images.error();
  const Result<PointErrors> errors = bench.references.compare(std::move(*images));
  if (!errors) return errors.error();
  return errors->errors.psnr;
}

// What the part costs: with minus without.
void fillCost(FeatureCost& cost, const DrawTimes& base, const DrawTimes& variant, int64_t baseBytes,
              int64_t variantBytes) {
  const int64_t sign = cost.isUsed ? 1 : -1;
  cost.diskBytes = sign * (baseBytes - variantBytes);
  cost.residentBytes = sign * (static_cast<int64_t>(base.residentBytes) - static_cast<int64_t>(variant.residentBytes));
  cost.rasterWith = cost.isUsed ? base.total : variant.total;
  cost.rasterWithout = cost.isUsed ? variant.total : base.total;
}

}  // namespace

Result<std::vector<FeatureCost>> assetFeatures(const Bench& bench, const FoamInput& input, const CameraSet& cameras,
                                               const std::filesystem::path& folder, const Progress& progress) {
  const ReportConfig base = defaultConfig();
  const std::filesystem::path baseAsset = bench.bakes.assetOf(base);
  const Result<AssetReader> reader = AssetReader::open(baseAsset);
  if (!reader) return reader.error();
  std::vector<Part> parts = listParts(input.foam, reader->manifest());
  const Draw plain = drawOf(bench, base);
  std::vector<Draw> draws{drawBy(plain, Method::kRaster, baseAsset), drawBy(plain, Method::kWalk, baseAsset)};
  std::vector<std::filesystem::path> assets;
  for (Part& part : parts) {
    const Result<std::filesystem::path> asset =
        bakeVariant(part, bench, input, cameras, folder / fmt::format("part_{}", assets.size()), progress);
    if (!asset) return asset.error();
    assets.push_back(*asset);
    draws.push_back(drawBy(plain, Method::kRaster, *asset));
    // Without a graph there is nothing to walk: the base is drawn again in its place.
    draws.push_back(drawBy(plain, Method::kWalk, part.cost.feature == "walk graph" ? baseAsset : *asset));
  }
  const Result<std::vector<DrawTimes>> times = bench.renderer.time(draws, bench.rounds, progress);
  if (!times) return times.error();
  std::vector<FeatureCost> costs;
  for (size_t i = 0; i < parts.size(); ++i) {
    FeatureCost& cost = parts[i].cost;
    fillCost(cost, (*times)[0], (*times)[2 + 2 * i], static_cast<int64_t>(std::filesystem::file_size(baseAsset)),
             static_cast<int64_t>(std::filesystem::file_size(assets[i])));
    if (cost.feature != "walk graph") {
      cost.walkWith = (*times)[cost.isUsed ? 1 : 3 + 2 * i].total;
      cost.walkWithout = (*times)[cost.isUsed ? 3 + 2 * i : 1].total;
    }
    if (cost.isUsed) {
      const Result<double> psnr = psnrOf(bench, assets[i], progress);
      if (!psnr) return psnr.error();
      cost.psnr = *psnr;
    }
    costs.push_back(cost);
  }
  return costs;
}

Result<std::vector<FeatureCost>> runtimeFeatures(const Bench& bench, const GpuDeviceOptions& device,
                                                 const Progress& progress) {
  const Draw raster = drawBy(drawOf(bench, defaultConfig()), Method::kRaster, bench.bakes.assetOf(defaultConfig()));
  // Without a graph the raster stands in, and its times are not told.
  const Draw walk = drawBy(raster, bench.walks ? Method::kWalk : Method::kRaster, raster.asset);
  std::vector<FeatureCost> costs;
  const auto add = [&](const char* feature, const char* variant, const std::vector<DrawTimes>& without,
                       const std::vector<DrawTimes>& with) {
    FeatureCost cost;
    cost.feature = feature;
    cost.variant = variant;
    cost.residentBytes = static_cast<int64_t>(with[0].residentBytes) - static_cast<int64_t>(without[0].residentBytes);
    cost.rasterWithout = without[0].total;
    cost.rasterWith = with[0].total;
    if (bench.walks) {
      cost.walkWithout = without[1].total;
      cost.walkWith = with[1].total;
    }
    costs.push_back(cost);
  };
  Draw fullRaster = raster, fullWalk = walk;
  fullRaster.options.isFull = fullWalk.options.isFull = true;
  const Result<std::vector<DrawTimes>> plain =
      bench.renderer.time({raster, walk, fullRaster, fullWalk}, bench.rounds, progress);
  if (!plain) return plain.error();
  add("images of distance and normal", "drawn too (shaders specialized on it), all in float",
      {(*plain)[0], (*plain)[1]}, {(*plain)[2], (*plain)[3]});

  const auto withDevice = [&](GpuDeviceOptions options, const char* feature, const char* variant) -> Status {
    Result<std::unique_ptr<SweepRenderer>> renderer = createGpuSweepRenderer(std::move(options));
    if (!renderer) return renderer.error();
    const Result<std::vector<DrawTimes>> times = (*renderer)->time({raster, walk}, bench.rounds, progress);
    if (!times) return times.error();
    add(feature, variant, *plain, *times);
    return {};
  };
  GpuDeviceOptions hits = device, lenses = device;
  hits.keepsHits = true;
  lenses.lensClasses = FROTH_LENS_CLASS_MAPPED | FROTH_LENS_CLASS_ORTHOGRAPHIC;
  if (Status added =
          withDevice(hits, "kept hits", "views made for ids and motion (FrothViewInfo::keepsHits): memory alone");
      !added) {
    return added.error();
  }
  // Without their images bound a frame does not write hits: a time would say nothing.
  costs.back().rasterWithout = costs.back().rasterWith = costs.back().walkWithout = costs.back().walkWith = {};
  if (Status added = withDevice(lenses, "other lenses", "a context and views for all lenses"); !added) {
    return added.error();
  }
  return costs;
}

Result<std::vector<FeatureCost>> bakeLeftOut(const Bench& bench) {
  const Result<BakeRecord> record = bench.bakes.recordOf(defaultConfig());
  if (!record) return record.error();
  std::vector<FeatureCost> costs;
  for (const LeftOut& one : record->leftOut) {
    FeatureCost cost;
    cost.feature = one.what;
    cost.variant = "not written; bytes before compression";
    cost.diskBytes = static_cast<int64_t>(one.savedBytes);
    costs.push_back(cost);
  }
  return costs;
}

}  // namespace froth
