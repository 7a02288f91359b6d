// Reads the head of an asset: header, manifest, and the codebook that all chunks share.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "format/asset_contents.h"
#include "format/read/byte_source.h"
#include "format/read/manifest_read.h"

namespace froth {

// What an asset's head tells.
struct AssetHead {
  std::string name;        // stands for the asset in messages
  uint64_t size = 0;       // [bytes] of the whole asset
  Layer last{};            // layers behind it are left alone
  Manifest manifest;       // of the file
  AssetContents contents;  // what the layers up to `last` make of it
};

// Takes the head's bytes as they come, so that whoever fetches them need not wait for them here: while something is
// wanted(), fetch it and take() it; then finish(). One thread at a time.
class AssetOpener {
 public:
  AssetOpener(std::string name, uint64_t size, Layer last);

  const std::optional<ByteRange>& wanted() const { return wanted_; }
  Status take(std::span<const uint8_t> bytes);  // of wanted()
  AssetHead finish() { return std::move(head_); }

 private:
  Status takeStart();
  Status takeManifest(uint64_t manifestEnd, uint64_t expectedHash);
  Status takeCodebook(const SectionRecord& record, std::span<const uint8_t> stored);

  AssetHead head_;
  std::optional<ByteRange> wanted_;
  std::vector<uint8_t> start_;                // of the asset, until the manifest is whole
  std::optional<SectionRecord> awaitedBook_;  // wanted_ is this section
};

// Decodes a section of an asset with this manifest, from its stored bytes. `place` names its chunk in messages.
Status decodeStored(const Manifest& manifest, const SectionRecord& record, std::span<const uint8_t> stored,
                    std::span<uint8_t> raw, const std::string& place);

}  // namespace froth
