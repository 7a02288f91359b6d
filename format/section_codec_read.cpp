#include "format/section_codec_read.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

#include <zstd.h>

#include "format/container.h"

namespace froth {
namespace {

constexpr char kRemedy[] = "the file is damaged, copy it or bake the scene again";

// One zstd frame, followed by nothing but zeros, whose content is taken in pieces.
class FrameReader {
 public:
  FrameReader(std::span<const uint8_t> stored, const std::string& place)
      : context_(ZSTD_createDCtx(), ZSTD_freeDCtx), input_{stored.data(), stored.size(), 0}, place_(place) {}

  Status start(uint64_t contentSize) {
    if (!context_) return makeError(ErrorKind::kIo, "%s: no memory for zstd", place_.c_str());
    ZSTD_DCtx_setParameter(context_.get(), ZSTD_d_windowLogMax, kMaxWindowLog);
    const unsigned long long found = ZSTD_getFrameContentSize(input_.src, input_.size);
    if (found == contentSize) return {};
    if (found == ZSTD_CONTENTSIZE_ERROR || found == ZSTD_CONTENTSIZE_UNKNOWN)
      return makeError(ErrorKind::kBadInput, "%s: no zstd frame of known size; %s", place_.c_str(), kRemedy);
    return makeError(ErrorKind::kBadInput, "%s: the zstd frame holds %llu bytes, the manifest says %llu; %s",
                     place_.c_str(), found, static_cast<unsigned long long>(contentSize), kRemedy);
  }

  // Fills `out` whole.
  Status read(std::span<uint8_t> out) {
    ZSTD_outBuffer output{out.data(), out.size(), 0};
    while (output.pos < output.size) {
      if (Status step = advance(output); !step) return step;
      if (output.pos < output.size && (atEnd_ || input_.pos == input_.size))
        return makeError(ErrorKind::kBadInput, "%s: the zstd frame ends early; %s", place_.c_str(), kRemedy);
    }
    return {};
  }

  // The frame must end here (its checksum is read now), and zeros must follow.
  Status finish() {
    ZSTD_outBuffer none{nullptr, 0, 0};
    while (!atEnd_) {
      const size_t before = input_.pos;
      if (Status step = advance(none); !step) return step;
      if (!atEnd_ && input_.pos == before)
        return makeError(ErrorKind::kBadInput, "%s: the zstd frame does not end; %s", place_.c_str(),
                         kRemedy);
    }
    const uint8_t* bytes = static_cast<const uint8_t*>(input_.src);
    if (std::all_of(bytes + input_.pos, bytes + input_.size, [](uint8_t byte) { return byte == 0; }))
      return {};
    return makeError(ErrorKind::kBadInput, "%s: bytes after the zstd frame are not zero; %s", place_.c_str(),
                     kRemedy);
  }

 private:
  Status advance(ZSTD_outBuffer& output) {
    const size_t result = ZSTD_decompressStream(context_.get(), &output, &input_);
    if (ZSTD_isError(result))
      return makeError(ErrorKind::kBadInput, "%s: zstd: %s; %s", place_.c_str(), ZSTD_getErrorName(result),
                       kRemedy);
    atEnd_ = result == 0;
    return {};
  }

  std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context_;
  ZSTD_inBuffer input_;
  bool atEnd_ = false;
  const std::string& place_;
};

// Takes plane after plane from the frame and deals its bytes to the words.
Status readBytePlanes(FrameReader& frame, std::span<uint8_t> raw) {
  std::array<uint8_t, 1 << 16> buffer;
  const size_t words = raw.size() / kWordSize;
  for (size_t plane = 0; plane < kWordSize; ++plane) {
    for (size_t first = 0; first < words; first += buffer.size()) {
      const size_t count = std::min(buffer.size(), words - first);
      if (Status status = frame.read({buffer.data(), count}); !status) return status;
      uint8_t* target = raw.data() + first * kWordSize + plane;
      for (size_t i = 0; i < count; ++i) target[i * kWordSize] = buffer[i];
    }
  }
  return {};
}

}  // namespace

Status decodeSection(const SectionRecord& record, std::span<const uint8_t> stored, std::span<uint8_t> raw,
                     const std::string& place, SectionShape) {
  if (!hashMatches(stored, record.hash))
    return makeError(ErrorKind::kBadInput, "%s: hash %016llx instead of %016llx; %s", place.c_str(),
                     static_cast<unsigned long long>(hashBytes(stored)),
                     static_cast<unsigned long long>(record.hash), kRemedy);
  if (record.codec == static_cast<uint16_t>(SectionCodec::kStored)) {
    std::memcpy(raw.data(), stored.data(), raw.size());  // sizes were compared when the manifest was read
    return {};
  }
  FrameReader frame(stored, place);
  if (Status status = frame.start(raw.size()); !status) return status;
  const bool planes = record.codec == static_cast<uint16_t>(SectionCodec::kBytePlanes);
  if (Status status = planes ? readBytePlanes(frame, raw) : frame.read(raw); !status) return status;
  return frame.finish();
}

}  // namespace froth
