// Any bytes as cameras.json: views within their limits, or an error; no crash, no leak, no hang, memory in
// proportion.
#include <cmath>
#include <cstdlib>
#include <string>

#include "reference/camera/camera.h"
#include "tests/fuzz/memory_watch.h"

namespace {

bool isSound(const froth::View& view) {
  bool ok = view.width > 0 && view.height > 0 && view.width <= 65536 && view.height <= 65536;
  if (view.lens.kind != froth::LensKind::kRayMap) ok = ok && view.fx > 0 && view.fy > 0;
  for (const double entry : view.worldFromCamera) ok = ok && std::isfinite(entry);
  return ok;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  constexpr size_t kMessages = 64 << 10;
  constexpr size_t kTreePerByte = 128;  // "[]," is an array, its place in another one, and what that grew from
  const froth::MemoryWatch memory;
  const auto cameras = froth::parseCameras({data, size}, "fuzz.json");
  memory.expectAtMost(kTreePerByte * size + kMessages);
  if (!cameras) return 0;
  for (const froth::View& view : cameras->views) {
    if (!isSound(view)) std::abort();
  }
  for (const froth::View& view : cameras->flight) {
    if (!isSound(view)) std::abort();
  }
  return 0;
}
