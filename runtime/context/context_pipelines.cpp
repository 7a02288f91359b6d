// When a context makes its pipelines: ahead of time, for assets that load, for the second instance.
#include <algorithm>
#include <iterator>

#include "runtime/context/context.h"
#include "runtime/context/info_checks.h"

namespace froth {
namespace {

FrothVariant toVariant(const AssetShape& shape) {
  return {{shape.detailCount, shape.lobeCount, shape.hasHeights ? 1u : 0u}};
}

// Empty: no variant of this version.
std::optional<AssetShape> toShape(const FrothVariant& variant) {
  const AssetShape shape{variant.words[0], variant.words[1], variant.words[2] != 0};
  const FrothVariant known = toVariant(shape);
  const bool isKnown = std::ranges::equal(known.words, variant.words) && shape.detailCount > 0;
  return isKnown ? std::optional(shape) : std::nullopt;
}

}  // namespace

FrothResult Context::readVariant(const FrothAssetInfo& info, FrothVariant& variant) const {
  if (const FrothResult result = checkSourceAtHand(messages, "frothReadVariant", info); result != FROTH_OK) {
    return result;
  }
  const AssetSource source = sourceOf(info);
  const Result<AssetReader> reader = openReader(source);
  if (!reader) {
    return messages.fail(reader.error(), "frothReadVariant");
  }
  variant = toVariant(shapeOf(*reader, source.lastLayer));
  return FROTH_OK;
}

FrothResult Context::precompile(const FrothPrecompileInfo& info) {
  constexpr const char* kCall = "frothPrecompile";
  if (info.variantCount > 0 && !info.variants) {
    return messages.fail(FROTH_ERROR_ARGUMENT, kCall, "variants: null, with variantCount %u", info.variantCount);
  }
  if (const FrothResult result = checkDevice(kCall); result != FROTH_OK || isNull_) {
    return result;
  }
  const uint32_t total = info.variantCount + (info.severalInstances != 0 ? 1 : 0);
  for (uint32_t done = 0; done < total; ++done) {
    if (info.onProgress) info.onProgress(info.progressUser, done, total);
    const bool isVariant = done < info.variantCount;
    const std::optional<AssetShape> shape = isVariant ? toShape(info.variants[done]) : std::nullopt;
    if (isVariant && !shape) {
      return messages.fail(FROTH_ERROR_ARGUMENT, kCall,
                           "variants[%u]: not of frothReadVariant of this library; read it again", done);
    }
    const Status status = isVariant ? pipelines_->prepareFor(*shape) : makeMerging();
    if (!status) {
      return messages.fail(status.error(), kCall);
    }
  }
  if (info.onProgress) info.onProgress(info.progressUser, total, total);
  return FROTH_OK;
}

// Pipelines for assets of this shape; empty: they are under way, or wait for room.
std::optional<Status> Context::prepareShape(const AssetShape& shape) {
  if (!pipelines_ || pipelines_->hasShape(shape)) {
    return Status();
  }
  Job<Done>& job = making_[shape];
  if (!job.isUnderWay() && jobs_.hasRoom()) {
    job.start(jobs_, [pipelines = pipelines_.get(), shape] { return doneIf(pipelines->prepareFor(shape)); });
  }
  if (!job.hasEnded()) {
    return {};
  }
  const Result<Done> done = job.take();
  return done ? Status() : done.error();
}

// All pipelines that draw several instances, or cast rays through them.
Status Context::makeMerging() {
  const Status status = pipelines_->prepareMerging();
  return status && walks_ ? walks_->prepareMerging() : status;
}

void Context::takePipelines(PipelineJob& making, const char* object) {
  if (!making.job.hasEnded()) return;
  const Result<Done> done = making.job.take();
  if (!done && making.error != done.error().message && !device_.loss->isTold()) {  // once, not in every frame
    making.error = done.error().message;
    messages.fail(done.error(), object);
  }
}

// Where there are two instances.
void Context::prepareMerging() {
  takePipelines(merging_, "several instances");
  uint32_t count = 0;
  instances_.forEach([&](const Instance&) { ++count; });
  const bool canMerge = !pipelines_ || (pipelines_->canMerge() && (!walks_ || walks_->canMerge()));
  if (count < 2 || canMerge || merging_.job.isUnderWay() || !jobs_.hasRoom()) {
    return;
  }
  merging_.job.start(jobs_, [this] { return doneIf(makeMerging()); });
}

// Where an asset is to have cells prepared for rays.
void Context::prepareRayForms() {
  takePipelines(rayForms_, "prepared cells");
  uint32_t prepared = gpu::kPreparedNothing;
  assets_.forEach([&](const Asset& asset) { prepared = std::max(prepared, asset.preparedForm()); });
  if (!walks_ || prepared <= walks_->mostPrepared() || rayForms_.job.isUnderWay() || !jobs_.hasRoom()) {
    return;
  }
  rayForms_.job.start(jobs_, [this, prepared] { return doneIf(walks_->prepareFor(prepared)); });
}

}  // namespace froth
