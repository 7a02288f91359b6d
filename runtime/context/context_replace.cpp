// Hot reload: another file loads beside an asset and takes its handle at the edge of a frame.
#include <algorithm>
#include <utility>

#include "runtime/context/context.h"
#include "runtime/context/info_checks.h"

namespace froth {

Context::Replacement* Context::findReplacement(FrothAsset handle) {
  const auto isIts = [&](const Replacement& replacement) { return isSame(replacement.asset, handle); };
  const auto found = std::ranges::find_if(replacements_, isIts);
  return found == replacements_.end() ? nullptr : &*found;
}

FrothResult Context::replaceAsset(FrothAsset handle, const FrothAssetInfo& info) {
  constexpr const char* kCall = "frothReplaceAsset";
  if (const FrothResult result = checkSource(messages, kCall, info); result != FROTH_OK) return result;
  const Asset* old = assets_.find(handle);
  if (!old) {
    return messages.fail(FROTH_ERROR_HANDLE, kCall, "asset {%u, %u}: closed or never opened", handle.index,
                         handle.generation);
  }
  if (stateOf(*old) != FROTH_ASSET_READY) {
    return messages.fail(FROTH_ERROR_STATE, old->name().c_str(),
                         "it is not READY, so there is nothing to draw meanwhile; close it and open the other file");
  }
  std::shared_ptr<Asset> successor = makeAsset(info);
  endReplacement(handle);
  replacements_.push_back({handle, std::move(successor), FROTH_OK});
  return FROTH_OK;
}

FrothResult Context::describeReplacement(FrothAsset handle, FrothReplacementStatus& status) {
  if (!assets_.find(handle)) {
    return messages.fail(FROTH_ERROR_HANDLE, "frothGetReplacement", "asset {%u, %u}: closed or never opened",
                         handle.index, handle.generation);
  }
  const Replacement* replacement = findReplacement(handle);
  if (!replacement) return FROTH_OK;
  status.error = replacement->error;
  status.state = replacement->successor           ? FROTH_REPLACEMENT_LOADING
                 : replacement->error == FROTH_OK ? FROTH_REPLACEMENT_DONE
                                                  : FROTH_REPLACEMENT_FAILED;
  return FROTH_OK;
}

// Forgets it; one that is loading ends.
void Context::endReplacement(FrothAsset handle) {
  Replacement* replacement = findReplacement(handle);
  if (!replacement) return;
  retired_.reserve(retired_.size() + 1);
  if (replacement->successor) dropAsset(std::move(replacement->successor));
  replacements_.erase(replacements_.begin() + (replacement - replacements_.data()));
}

// Frames in flight, and jobs, may use it. retired_ has room for it.
void Context::dropAsset(std::shared_ptr<Asset> asset) {
  asset->stop();
  if (ring_) asset->forgetCopies(*ring_, asset);
  retire(std::move(asset));
}

// A failure is a warning: the old asset stays as it is.
void Context::loadReplacements(LoadLimit& limit, const Asset::Preparation& prepare) {
  const Messages warnings{[](void* user, FrothSeverity, FrothResult code, const char* object, const char* text) {
                            static_cast<const Messages*>(user)->warn(
                                code, object, "it does not replace the asset that is drawn: %s", text);
                          },
                          &messages};
  for (Replacement& replacement : replacements_) {
    if (!replacement.successor) continue;
    replacement.successor->load(jobs_, reads_, limit, prepare, warnings);
    if (!replacement.successor->hasFailed()) continue;
    retired_.reserve(retired_.size() + 1);
    replacement.error = replacement.successor->describe().error;
    dropAsset(std::move(replacement.successor));
  }
}

// Copies of the new one are complete, so that no dropped frame takes them back.
void Context::finishReplacements() {
  for (Replacement& replacement : replacements_) {
    if (!replacement.successor) continue;
    Asset& successor = *replacement.successor;
    const bool isUploaded =
        successor.queuedBytes() == 0 && (!ring_ || ring_->isWithin(&successor, completedUploadSerial_));
    if (!successor.isDecoded() || !isUploaded) continue;
    retired_.reserve(retired_.size() + 1);
    if (exchange_ && isSame(exchange_->asset, replacement.asset)) abandonExchange();
    std::erase_if(cuts_, [&](const auto& cut) { return isSame(cut.first, replacement.asset); });
    levels_.remove(replacement.asset);
    dropAsset(assets_.replace(replacement.asset, std::move(replacement.successor)));
  }
}

}  // namespace froth
