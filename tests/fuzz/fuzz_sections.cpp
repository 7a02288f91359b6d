// Any bytes as a section in any codec: no crash, no leak, no hang, no more memory than the header of the
// codec promises.
#include "codec_inputs.h"
#include "format/read/section_codec_read.h"
#include "memory_watch.h"

namespace froth {
namespace {

void decode(std::span<const uint8_t> data) {
  InputBytes bytes(data);
  const SectionInput input = bytes.take<SectionInput>();
  const SectionShape shape{1u << input.elementSizeLog % 3, input.components % 8 + 1u};
  const std::span<const uint8_t> stored = bytes.left();
  const size_t rawSize = size_t{input.entries % (1u << 12)} * shape.elementSize * shape.components;
  if (rawSize > kMaxExpansion * stored.size()) return;  // the manifest's check
  std::vector<uint8_t> raw(rawSize);
  SectionRecord record;
  record.codec = input.codec % (kLastSectionCodec + 2);

  constexpr size_t kZstdState = size_t{1} << 20;  // contexts and buffers beside the window
  const MemoryWatch watch;
  (void)decodeSection(record, stored, raw, "section", shape);
  watch.expectAtMost((size_t{1} << kMaxWindowLog) + kZstdState + 2 * rawSize + 2 * stored.size());
}

}  // namespace
}  // namespace froth

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  froth::decode({data, size});
  return 0;
}
