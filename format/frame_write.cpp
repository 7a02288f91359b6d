#include "format/frame_write.h"

#include <algorithm>
#include <array>

#include "format/section_codec.h"

namespace froth {

FrameWriter::FrameWriter(uint64_t contentSize, int level)
    : context_(ZSTD_createCCtx(), ZSTD_freeCCtx), buffer_(ZSTD_CStreamOutSize()) {
  ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_compressionLevel, level);
  ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_checksumFlag, 1);
  ZSTD_CCtx_setPledgedSrcSize(context_.get(), contentSize);
  frame_.reserve(contentSize);  // address space; only what is written becomes memory
}

Status FrameWriter::write(std::span<const uint8_t> piece, bool isLast) {
  ZSTD_inBuffer input{piece.data(), piece.size(), 0};
  for (;;) {
    ZSTD_outBuffer output{buffer_.data(), buffer_.size(), 0};
    const size_t left =
        ZSTD_compressStream2(context_.get(), &output, &input, isLast ? ZSTD_e_end : ZSTD_e_continue);
    if (ZSTD_isError(left)) return makeError(ErrorKind::kIo, "zstd: %s", ZSTD_getErrorName(left));
    frame_.insert(frame_.end(), buffer_.begin(), buffer_.begin() + static_cast<ptrdiff_t>(output.pos));
    if (isLast ? left == 0 : input.pos == input.size) return {};
  }
}

Status FrameWriter::writePlanes(std::span<const uint8_t> elements, uint32_t elementSize) {
  std::array<uint8_t, 1 << 16> buffer;
  const size_t elementCount = elements.size() / elementSize;
  for (uint32_t plane = 0; plane < elementSize; ++plane) {
    for (size_t first = 0; first < elementCount; first += buffer.size()) {
      const size_t count = std::min(buffer.size(), elementCount - first);
      const uint8_t* source = elements.data() + first * elementSize + plane;
      for (size_t i = 0; i < count; ++i) buffer[i] = source[i * elementSize];
      const bool isLast = plane + 1 == elementSize && first + count == elementCount;
      if (Status status = write({buffer.data(), count}, isLast); !status) return status;
    }
  }
  return {};
}

}  // namespace froth
