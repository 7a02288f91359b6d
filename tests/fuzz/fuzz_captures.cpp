// Any bytes as a COLMAP model, a transforms.json or a PLY file: views within their limits, or an error; no crash, no
// leak, no hang, memory in proportion. The first byte: T a transforms.json, P a PLY, B or X a model in binary or text.
// Of a model four bytes follow: the lengths of its cameras and of its images, little-endian; what is left are its
// points.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "reference/capture/colmap.h"
#include "reference/capture/ply_points.h"
#include "reference/capture/transforms.h"
#include "tests/fuzz/memory_watch.h"

namespace {

constexpr size_t kModelHeader = 5;

using Bytes = std::span<const uint8_t>;

bool isSound(const froth::Capture& capture) {
  bool ok = !capture.views.empty();
  for (const froth::CapturedView& view : capture.views) {
    ok = ok && view.view.width > 0 && view.view.height > 0 && view.view.fx > 0 && view.view.fy > 0;
    for (const double entry : view.view.worldFromCamera) ok = ok && std::isfinite(entry);
  }
  for (const froth::CapturedPoint& point : capture.points) {
    ok = ok && std::isfinite(point.position.x) && std::isfinite(point.position.y) && std::isfinite(point.position.z);
    ok = ok && point.firstObserver + point.observerCount <= capture.observers.size();
  }
  for (const uint32_t observer : capture.observers) ok = ok && observer < capture.views.size();
  return ok;
}

// With a view, for there is no capture without.
froth::Result<froth::Capture> parsePly(Bytes bytes) {
  auto points = froth::parsePlyPoints({bytes, "fuzz.ply"});
  if (!points) return points.error();
  froth::Capture capture;
  capture.points = std::move(*points);
  froth::View& view = capture.views.emplace_back().view;
  view.width = view.height = 1;
  view.fx = view.fy = 1;
  return capture;
}

froth::Result<froth::Capture> parse(Bytes bytes) {
  const uint8_t form = bytes[0];
  if (form == 'P') return parsePly(bytes.subspan(1));
  if (form != 'B' && form != 'X') {
    return froth::parseTransforms(bytes.subspan(1), "fuzz.json", [](const std::string&) {
      return froth::ImageSize{64, 48};
    });
  }
  const auto lengthAt = [&](size_t at) { return size_t{bytes[at]} | size_t{bytes[at + 1]} << 8; };
  const Bytes all = bytes.subspan(kModelHeader);
  const size_t cameras = std::min(lengthAt(1), all.size()), images = std::min(lengthAt(3), all.size() - cameras);
  return froth::parseColmap({{all.subspan(0, cameras), "cameras"},
                             {all.subspan(cameras, images), "images"},
                             {all.subspan(cameras + images), "points3D"},
                             form == 'B'});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  constexpr size_t kMessages = 64 << 10;
  constexpr size_t kTreePerByte = 160;  // as of cameras.json; records of a model take less
  if (size < kModelHeader) return 0;
  const froth::MemoryWatch memory;
  const auto capture = parse({data, size});
  memory.expectAtMost(kTreePerByte * size + kMessages);
  if (capture && !isSound(*capture)) std::abort();
  return 0;
}
