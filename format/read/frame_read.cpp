#define ZSTD_STATIC_LINKING_ONLY  // ZSTD_customMem, ZSTD_getFrameHeader; shared libraries of zstd export them, too
#include "format/read/frame_read.h"

#include <algorithm>
#include <array>
#include <new>

#include <zstd_errors.h>

#include "format/section_codec.h"

namespace froth {
namespace {

// So that zstd's memory comes from where all other does. It is C, which no exception may cross.
constexpr ZSTD_customMem kMemory{[](void*, size_t size) { return operator new(size, std::nothrow); },
                                 [](void*, void* block) { operator delete(block); }, nullptr};

}  // namespace

FrameReader::FrameReader(std::span<const uint8_t> stored, const std::string& place)
    : context_(ZSTD_createDCtx_advanced(kMemory), ZSTD_freeDCtx),
      input_{stored.data(), stored.size(), 0},
      place_(place) {}

Status FrameReader::start(uint64_t contentSize) {
  if (!context_) throw std::bad_alloc();
  ZSTD_DCtx_setParameter(context_.get(), ZSTD_d_windowLogMax, kMaxWindowLog);
  atEnd_ = false;
  const uint8_t* next = static_cast<const uint8_t*>(input_.src) + input_.pos;
  // Of what zstd reads, this knows frames of RFC 8878 alone: no limit of windows holds for those from before.
  ZSTD_frameHeader header{};
  const bool isFrame = ZSTD_getFrameHeader(&header, next, input_.size - input_.pos) == 0;
  if (!isFrame || header.frameType != ZSTD_frame || header.frameContentSize == ZSTD_CONTENTSIZE_UNKNOWN) {
    return makeError(ErrorKind::kBadInput, "%s: no zstd frame of known size; %s", place_.c_str(), kSectionRemedy);
  }
  if (header.frameContentSize == contentSize) return {};
  return makeError(ErrorKind::kBadInput, "%s: the zstd frame holds %llu bytes instead of %llu; %s", place_.c_str(),
                   header.frameContentSize, static_cast<unsigned long long>(contentSize), kSectionRemedy);
}

Status FrameReader::read(std::span<uint8_t> out) {
  ZSTD_outBuffer output{out.data(), out.size(), 0};
  while (output.pos < output.size) {
    if (Status step = advance(output); !step) return step;
    if (output.pos < output.size && (atEnd_ || input_.pos == input_.size)) {
      return makeError(ErrorKind::kBadInput, "%s: the zstd frame ends early; %s", place_.c_str(), kSectionRemedy);
    }
  }
  return {};
}

Status FrameReader::readPlanes(std::span<uint8_t> elements, uint32_t elementSize) {
  std::array<uint8_t, 1 << 16> buffer;
  const size_t elementCount = elements.size() / elementSize;
  for (uint32_t plane = 0; plane < elementSize; ++plane) {
    if (Status status = start(elementCount); !status) return status;
    for (size_t first = 0; first < elementCount; first += buffer.size()) {
      const size_t count = std::min(buffer.size(), elementCount - first);
      if (Status status = read({buffer.data(), count}); !status) return status;
      uint8_t* target = elements.data() + first * elementSize + plane;
      for (size_t i = 0; i < count; ++i) target[i * elementSize] = buffer[i];
    }
    if (Status status = end(); !status) return status;
  }
  return {};
}

Status FrameReader::end() {
  ZSTD_outBuffer none{nullptr, 0, 0};
  while (!atEnd_) {
    const size_t before = input_.pos;
    if (Status step = advance(none); !step) return step;
    if (!atEnd_ && input_.pos == before) {
      return makeError(ErrorKind::kBadInput, "%s: the zstd frame does not end; %s", place_.c_str(), kSectionRemedy);
    }
  }
  return {};
}

Status FrameReader::finish() const {
  const uint8_t* bytes = static_cast<const uint8_t*>(input_.src);
  if (std::all_of(bytes + input_.pos, bytes + input_.size, [](uint8_t byte) { return byte == 0; })) return {};
  return makeError(ErrorKind::kBadInput, "%s: bytes after the last zstd frame are not zero; %s", place_.c_str(),
                   kSectionRemedy);
}

Status FrameReader::advance(ZSTD_outBuffer& output) {
  const size_t result = ZSTD_decompressStream(context_.get(), &output, &input_);
  if (ZSTD_getErrorCode(result) == ZSTD_error_memory_allocation) throw std::bad_alloc();
  if (ZSTD_isError(result)) {
    return makeError(ErrorKind::kBadInput, "%s: zstd: %s; %s", place_.c_str(), ZSTD_getErrorName(result),
                     kSectionRemedy);
  }
  atEnd_ = result == 0;
  return {};
}

}  // namespace froth
