#include "baker/appearance/appearance.h"
namespace froth {
[[gnu::weak]] Result<AppearanceCoder> AppearanceCoder::create(const Foam&, const Visibility*, const AppearanceOptions&, const Progress&) {
  return makeError(ErrorKind::kUnsupported, "colours cannot be compressed yet; use preset exact");
}
[[gnu::weak]] CellAppearance AppearanceCoder::compress(std::span<const uint32_t>) const {
  return {};
}
}  // namespace froth
