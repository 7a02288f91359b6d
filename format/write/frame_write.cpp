#include "format/write/frame_write.h"

#include <memory>

#include <zstd.h>

namespace froth {

Status appendFrame(std::span<const uint8_t> content, int level, std::vector<uint8_t>& stored) {
  // Of many small sections most of the time would go into contexts. What was compressed before changes no byte.
  thread_local const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(), ZSTD_freeCCtx);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, level);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  const size_t before = stored.size();
  stored.resize(before + ZSTD_compressBound(content.size()));
  const size_t size =
      ZSTD_compress2(context.get(), stored.data() + before, stored.size() - before, content.data(), content.size());
  if (ZSTD_isError(size)) return makeError(ErrorKind::kIo, "zstd: %s", ZSTD_getErrorName(size));
  stored.resize(before + size);
  return {};
}

Status appendPlanes(std::span<const uint8_t> elements, uint32_t elementSize, int level, std::vector<uint8_t>& stored) {
  std::vector<uint8_t> content(elements.size() / elementSize);
  for (uint32_t plane = 0; plane < elementSize; ++plane) {
    for (size_t i = 0; i < content.size(); ++i) content[i] = elements[i * elementSize + plane];
    if (Status status = appendFrame(content, level, stored); !status) return status;
  }
  return {};
}

}  // namespace froth
