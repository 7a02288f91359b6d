// Any bytes as a checkpoint: a consistent foam or an error; no crash, no leak, no hang, no allocation beyond
// the limit that libFuzzer sets. From nothing a fuzzer hardly finds an archive with a right checksum, so most
// inputs are edits of one.
#include <cmath>
#include <cstdlib>
#include <span>
#include <string>

#include "baker/checkpoint/checkpoint.h"
#include "tests/checkpoint/checkpoint_builder.h"

namespace {

using Edits = std::span<const uint8_t>;

// Triples: place (16 bits), new byte.
void applyEdits(Edits edits, std::string& bytes) {
  for (; edits.size() >= 3 && !bytes.empty(); edits = edits.subspan(3)) {
    bytes[(edits[0] | edits[1] << 8) % bytes.size()] = static_cast<char>(edits[2]);
  }
}

// A different member for each input, chosen by its first byte; all checksums are right.
std::string editMember(Edits edits) {
  std::vector<froth::ZipEntrySpec> entries = zipEntries(froth::sampleCheckpoint());
  if (!edits.empty()) applyEdits(edits.subspan(1), entries[edits[0] % entries.size()].bytes);
  return buildZip(entries);
}

std::string editFile(Edits edits) {
  std::string bytes = buildZip(zipEntries(froth::sampleCheckpoint()), /*isZip64=*/edits.size() % 2 == 0);
  applyEdits(edits, bytes);
  return bytes;
}

std::string replacePickle(Edits pickle) {
  froth::CheckpointSpec checkpoint = froth::sampleCheckpoint();
  checkpoint.pickle = froth::join("\x80\x04", std::string(pickle.begin(), pickle.end()));
  return buildCheckpoint(checkpoint);
}

std::string makeFile(Edits data) {
  if (data.empty()) return {};
  const Edits rest = data.subspan(1);
  switch (data[0] % 4) {
    case 0:
      return editMember(rest);
    case 1:
      return editFile(rest);
    case 2:
      return replacePickle(rest);
    default:
      return {rest.begin(), rest.end()};
  }
}

bool isConsistent(const froth::Foam& foam) {
  const size_t cells = foam.cellCount, details = cells * foam.detailCount, lobes = details * foam.lobeCount;
  bool ok = cells > 0 && foam.sites.size() == cells && foam.radii.size() == cells &&
            foam.densities.size() == cells && foam.orientations.size() == cells &&
            foam.detailSites.size() == details && foam.detailHeights.size() == details &&
            foam.lobeAxes.size() == lobes && foam.lobeColours.size() == lobes;
  for (const float radius : foam.radii) ok = ok && radius > 0 && std::isfinite(radius);
  for (const float density : foam.densities) ok = ok && density >= 0 && std::isfinite(density);
  for (const glm::vec4& q : foam.orientations) ok = ok && std::abs(glm::length(q) - 1) < 1e-5f;
  return ok;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string bytes = makeFile({data, size});
  const auto foam =
      froth::importCheckpointBytes({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, "fuzz.pt");
  if (foam && !isConsistent(*foam)) std::abort();
  return 0;
}
