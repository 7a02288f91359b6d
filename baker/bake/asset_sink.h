// Where the chunks of a bake go: a file, encoded on all cores.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "baker/bake/bake.h"
#include "base/result.h"
#include "format/write/asset_writer.h"

namespace froth {

class AssetFileSink {
 public:
  AssetFileSink(std::filesystem::path path, WriteProtected isProtected)
      : path_(std::move(path)), isProtected_(isProtected) {}

  ChunkSink sink();  // refers to this object
  // After the bake; `contents` as the bake gave them. Returns the file's size [bytes].
  Result<uint64_t> finish(const AssetContents& contents);

 private:
  Status append(std::vector<ChunkContents>&& batch);

  std::filesystem::path path_;
  WriteProtected isProtected_;
  std::optional<AssetStreamWriter> writer_;
};

}  // namespace froth
