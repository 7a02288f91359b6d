#include "runtime/context/estimate.h"

#include "runtime/asset/asset_measure.h"
#include "runtime/context/info_checks.h"
#include "runtime/render/view_buffers.h"
#include "runtime/render/view_renderer.h"

namespace froth {
namespace {

ViewOptions optionsOf(const FrothEstimateInfo& info) {
  const FrothViewInfo& view = *info.view;
  return {.maxExtent = view.maxExtent,
          .lensClasses = view.lensClasses,
          .framesInFlight = info.framesInFlight == 0 ? kDefaultFramesInFlight : info.framesInFlight,
          .keepsHits = view.keepsHits != 0 || view.keepsReactive != 0,
          .keepsReactive = view.keepsReactive != 0,
          .fades = view.fadeFrames != 0,
          .reservedCells = view.reserveCells == 0 ? kReservedCells : view.reserveCells};
}

void addView(const ViewOptions& options, const GpuAsset& asset, FrothMemoryEstimate& estimate) {
  ViewCapacity first = firstCapacity(options), other = leastCapacity(options);
  coverAsset(asset, options.reservedCells, first);
  coverAsset(asset, options.reservedCells, other);
  estimate.viewBytes = bytesOf(first) - bytesOf(other);
  estimate.viewInstanceBytes = bytesOf(other);
  estimate.viewInstanceHostBytes = hostBytesOf(other);
}

}  // namespace

FrothResult estimateMemory(const Messages& messages, const char* call, const FrothEstimateInfo& info,
                           FrothMemoryEstimate& estimate) {
  FrothResult result = checkSourceAtHand(messages, call, *info.asset);
  if (result == FROTH_OK) result = checkFramesInFlight(messages, call, info.framesInFlight);
  if (result == FROTH_OK && info.view) result = checkExtent(messages, call, info.view->maxExtent);
  if (result != FROTH_OK) {
    return result;
  }
  const Result<AssetMeasure> asset = measureAsset(sourceOf(*info.asset), info.asset->keepForQueries != 0,
                                                  info.walkShaders != 0, info.asset->prepareRays);
  if (!asset) {
    return messages.fail(asset.error(), call);
  }
  estimate.assetBytes = asset->deviceBytes;
  estimate.assetHostBytes = asset->hostBytes;
  if (info.view) {
    addView(optionsOf(info), asset->gpu, estimate);
  }
  return FROTH_OK;
}

}  // namespace froth
