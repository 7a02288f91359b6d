// Any bytes as a checkpoint: a consistent foam or an error; no crash, no leak, no hang, no more memory than
// twice what the file declares. Checksums are not compared in this build, so that edits of a real file get
// past them.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>
#include <string>

#include "foam/checkpoint/checkpoint.h"
#include "tests/checkpoint/checkpoint_builder.h"
#include "tests/fuzz/memory_watch.h"

namespace {

using Bytes = std::span<const uint8_t>;

// Triples: place (16 bits), new byte.
std::string editZip64(Bytes edits) {
  static const std::string sample = buildZip(zipEntries(froth::sampleCheckpoint()), /*isZip64=*/true);
  std::string file = sample;
  for (; edits.size() >= 3; edits = edits.subspan(3)) {
    file[(edits[0] | edits[1] << 8) % file.size()] = static_cast<char>(edits[2]);
  }
  return file;
}

// Of any length, which an edit of an archive does not survive.
std::string replacePickle(Bytes pickle) {
  static const froth::CheckpointSpec sample = froth::sampleCheckpoint();
  froth::CheckpointSpec checkpoint = sample;
  checkpoint.pickle = std::string(pickle.begin(), pickle.end());
  return buildCheckpoint(checkpoint);
}

// A real checkpoint stands for itself: it begins with a P.
std::string makeFile(Bytes data) {
  if (!data.empty() && data[0] == 'E') return editZip64(data.subspan(1));
  if (!data.empty() && data[0] == 'I') return replacePickle(data.subspan(1));
  return {data.begin(), data.end()};
}

bool isConsistent(const froth::Foam& foam) {
  const size_t cells = foam.cellCount, details = cells * foam.detailCount, lobes = details * foam.lobeCount;
  bool ok = cells > 0 && foam.sites.size() == cells && foam.radii.size() == cells && foam.densities.size() == cells &&
            foam.orientations.size() == cells && foam.detailSites.size() == details &&
            foam.detailHeights.size() == details && foam.lobeAxes.size() == lobes && foam.lobeColours.size() == lobes;
  for (const float radius : foam.radii) ok = ok && radius > 0 && std::isfinite(radius);
  for (const float density : foam.densities) ok = ok && density >= 0 && std::isfinite(density);
  for (const glm::vec4& q : foam.orientations) ok = ok && std::abs(glm::length(q) - 1) < 1e-5f;
  return ok;
}

size_t bytesOf(const froth::Foam& foam) {
  const size_t details = size_t{foam.cellCount} * foam.detailCount;
  return (9 * size_t{foam.cellCount} + 3 * details + 6 * details * foam.lobeCount) * sizeof(float);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string file = makeFile({data, size});
  constexpr size_t kMaxFoamPerByte = 256;  // of a file whose tensors repeat elements
  constexpr size_t kWorkPerByte = 512;     // an opcode of one byte makes one value
  constexpr size_t kMessages = 64 << 10;
  const froth::MemoryWatch memory;
  const auto foam =
      froth::importCheckpointBytes({reinterpret_cast<const uint8_t*>(file.data()), file.size()}, "fuzz.pt");
  if (foam && !isConsistent(*foam)) std::abort();
  const size_t declared = foam ? bytesOf(*foam) : kMaxFoamPerByte * file.size();
  memory.expectAtMost(2 * declared + kWorkPerByte * file.size() + kMessages);
  return 0;
}
