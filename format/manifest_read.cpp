#include "format/manifest_read.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <format/froth_generated.h>

#include "format/checks.h"
#include "format/container.h"

namespace froth {
namespace {

constexpr char kRemedy[] = "the file is damaged, copy it or bake the scene again";
constexpr char kTooNew[] = "the file is newer than this program, update it";

// Manifests of version 1 have two tables, one inside the other; later ones may add some.
constexpr flatbuffers::uoffset_t kMaxDepth = 16, kMaxTables = 1000;

using ull = unsigned long long;

std::array<double, 3> unpack(const fb::Double3& v) {
  return {v.x(), v.y(), v.z()};
}

StoredCamera unpack(const fb::Camera& camera) {
  StoredCamera result;
  for (uint16_t i = 0; i < result.worldFromCamera.size(); ++i)
    result.worldFromCamera[i] = camera.world_from_camera()->Get(i);
  result.tanHalfFovY = camera.tan_half_fov_y();
  return result;
}

BakeStatistics unpack(const fb::Statistics& s) {
  BakeStatistics result;
  result.inputCells = s.input_cells();
  result.hiddenDropped = s.hidden_dropped();
  result.duplicatesMerged = s.duplicates_merged();
  result.emptyCells = s.empty_cells();
  result.deadCells = s.dead_cells();
  result.walkPairs = s.walk_pairs();
  result.alphaPairs = s.alpha_pairs();
  return result;
}

SectionRecord unpack(const fb::Section& s) {
  return {s.type(), s.chunk(), s.flags(), s.codec(), s.offset(), s.stored_size(), s.raw_size(), s.hash()};
}

bool hasLowerKey(const SectionRecord& a, const SectionRecord& b) {
  return std::tie(a.chunk, a.type) < std::tie(b.chunk, b.type);
}

template <class Struct>
bool isAligned(const flatbuffers::Vector<const Struct*>* vector) {
  return !vector || vector->size() == 0 || reinterpret_cast<uintptr_t>(vector->Data()) % alignof(Struct) == 0;
}

// FlatBuffers' own verifier looks at the alignment of a vector's length only.
bool areStructsAligned(const fb::Manifest& manifest) {
  return isAligned(manifest.flight_path()) && isAligned(manifest.chunks()) && isAligned(manifest.sections());
}

// Everything of the manifest but chunks and sections.
AssetContents unpackParameters(const fb::Manifest& manifest) {
  AssetContents contents;
  contents.detailCount = manifest.detail_count();
  contents.lobeCount = manifest.lobe_count();
  contents.localBits = manifest.local_bits();
  contents.hasWalkGraph = manifest.has_walk_graph();
  contents.detailSharpness = manifest.detail_sharpness();
  contents.nearRatio = manifest.near_ratio();
  contents.nearDepth = manifest.near_depth();
  contents.preset = manifest.preset()->str();
  if (manifest.source()) contents.source = manifest.source()->str();
  if (manifest.statistics()) contents.statistics = unpack(*manifest.statistics());
  contents.hasStartView = manifest.start_view() != nullptr;
  if (contents.hasStartView) contents.startView = unpack(*manifest.start_view());
  if (manifest.flight_path())
    for (const fb::Camera* camera : *manifest.flight_path()) contents.flightPath.push_back(unpack(*camera));
  return contents;
}

// Counts are compared with what 32 bits hold here, and with each other in checkParameters.
Status unpackChunks(const fb::Manifest& packed, const std::string& file, Manifest& manifest) {
  constexpr uint64_t kMost = std::numeric_limits<uint32_t>::max();
  for (const fb::Chunk* chunk : *packed.chunks()) {
    const std::string place = file + ": chunk " + std::to_string(manifest.chunks.size());
    const std::pair<const char*, uint64_t> counts[] = {{"cell_count", chunk->cell_count()},
                                                       {"live_count", chunk->live_count()},
                                                       {"neighbour_count", chunk->neighbour_count()}};
    for (const auto& [field, count] : counts)
      if (count > kMost)
        return makeError(ErrorKind::kBadInput, "%s: %s is %llu, more than %llu; %s", place.c_str(), field,
                         ull{count}, ull{kMost}, kRemedy);
    const Box bounds{unpack(chunk->live_bounds().min()), unpack(chunk->live_bounds().max())};
    for (size_t axis = 0; axis < 3; ++axis)
      if (!std::isfinite(bounds.min[axis]) || !std::isfinite(bounds.max[axis]) ||
          bounds.min[axis] > bounds.max[axis])
        return makeError(ErrorKind::kBadInput, "%s: live_bounds: %g..%g is no interval; %s", place.c_str(),
                         bounds.min[axis], bounds.max[axis], kRemedy);
    ChunkContents contents;
    contents.origin = unpack(chunk->origin());
    contents.cellCount = static_cast<uint32_t>(chunk->cell_count());
    contents.liveCount = static_cast<uint32_t>(chunk->live_count());
    manifest.contents.chunks.push_back(std::move(contents));
    manifest.chunks.push_back({{chunk->cell_count(), chunk->live_count(), chunk->neighbour_count()}, bounds});
  }
  return {};
}

// What the record says about itself and its place in the file.
Status checkRecord(const SectionRecord& record, uint32_t reserved, uint64_t fileSize,
                   const std::string& place) {
  if (reserved != 0 || (record.flags & kSectionReservedFlags) != 0)
    return makeError(ErrorKind::kUnsupported, "%s: reserved bits are set (flags 0x%04x); %s", place.c_str(),
                     record.flags, kTooNew);
  if (record.offset > fileSize || record.storedSize > fileSize - record.offset)
    return makeError(ErrorKind::kBadInput,
                     "%s: offset %llu + size %llu lies beyond the file's %llu bytes; %s", place.c_str(),
                     ull{record.offset}, ull{record.storedSize}, ull{fileSize}, kRemedy);
  if (sectionName(record.type) == nullptr && (record.flags & kSectionCritical) != 0)
    return makeError(ErrorKind::kUnsupported, "%s: unknown and critical; %s", place.c_str(), kTooNew);
  return {};
}

// What the record of a known section says, against the counts of its chunk.
Status checkKnownRecord(const SectionRecord& record, const Manifest& manifest, const std::string& place) {
  if (record.chunk >= manifest.chunks.size())
    return makeError(ErrorKind::kBadInput, "%s: there are only %zu chunks; %s", place.c_str(),
                     manifest.chunks.size(), kRemedy);
  if (record.codec > kLastSectionCodec)
    return makeError(ErrorKind::kUnsupported, "%s: unknown codec %u; %s", place.c_str(), record.codec,
                     kTooNew);
  const uint64_t words =
      sectionWords(static_cast<SectionType>(record.type), manifest.chunks[record.chunk].counts,
                   manifest.contents.detailCount, manifest.contents.lobeCount);
  if (words == 0 || record.rawSize != words * kWordSize)
    return makeError(ErrorKind::kBadInput, "%s: raw size %llu, but the counts demand %llu bytes; %s",
                     place.c_str(), ull{record.rawSize}, ull{words * kWordSize}, kRemedy);
  const bool isStored = record.codec == static_cast<uint16_t>(SectionCodec::kStored);
  if (isStored ? record.storedSize != record.rawSize : record.rawSize > record.storedSize * kMaxExpansion)
    return makeError(ErrorKind::kBadInput, "%s: %llu stored bytes cannot hold %llu; %s", place.c_str(),
                     ull{record.storedSize}, ull{record.rawSize}, kRemedy);
  return {};
}

// `occupied`: ranges [offset, end) of all sections, and of the manifest with the header before it.
Status checkOverlaps(std::vector<std::pair<uint64_t, uint64_t>> occupied, const std::string& file) {
  std::sort(occupied.begin(), occupied.end());
  for (size_t i = 1; i < occupied.size(); ++i)
    if (occupied[i].first < occupied[i - 1].second)
      return makeError(ErrorKind::kBadInput,
                       "%s: the section at byte %llu overlaps what ends at byte %llu; %s", file.c_str(),
                       ull{occupied[i].first}, ull{occupied[i - 1].second}, kRemedy);
  return {};
}

Status checkKeys(const std::vector<SectionRecord>& sorted, const std::string& file) {
  for (size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i].chunk == sorted[i - 1].chunk && sorted[i].type == sorted[i - 1].type)
      return makeError(ErrorKind::kBadInput, "%s: exists twice; %s",
                       sectionPlace(file, sorted[i].chunk, sorted[i].type).c_str(), kRemedy);
  return {};
}

Status unpackSections(const fb::Manifest& packed, uint64_t manifestEnd, uint64_t fileSize,
                      const std::string& file, Manifest& manifest) {
  std::vector<SectionRecord> all;
  std::vector<std::pair<uint64_t, uint64_t>> occupied{{0, manifestEnd}};
  for (const fb::Section* section : *packed.sections()) {
    const SectionRecord record = unpack(*section);
    const std::string place = sectionPlace(file, record.chunk, record.type);
    if (Status status = checkRecord(record, section->reserved(), fileSize, place); !status) return status;
    occupied.emplace_back(record.offset, record.offset + record.storedSize);
    all.push_back(record);
    if (sectionName(record.type) == nullptr) continue;
    if (Status status = checkKnownRecord(record, manifest, place); !status) return status;
    manifest.sections.push_back(record);
  }
  std::sort(all.begin(), all.end(), hasLowerKey);
  if (Status status = checkKeys(all, file); !status) return status;
  std::sort(manifest.sections.begin(), manifest.sections.end(), hasLowerKey);
  return checkOverlaps(std::move(occupied), file);
}

// Every array that holds anything must be there; only detail_heights may be left out.
Status checkPresence(const Manifest& manifest, const std::string& file) {
  Status status;
  for (uint32_t index = 0; index < manifest.chunks.size() && status; ++index)
    visitSections(manifest.contents.chunks[index], [&](SectionType type, const auto&) {
      const uint64_t words = sectionWords(type, manifest.chunks[index].counts, manifest.contents.detailCount,
                                          manifest.contents.lobeCount);
      if (!status || words == 0 || type == SectionType::kDetailHeights) return;
      if (manifest.findSection(index, type)) return;
      status = makeError(ErrorKind::kBadInput, "%s: is missing; %s",
                         sectionPlace(file, index, static_cast<uint32_t>(type)).c_str(), kRemedy);
    });
  return status;
}

}  // namespace

const SectionRecord* Manifest::findSection(uint32_t chunk, SectionType type) const {
  SectionRecord key;
  key.chunk = chunk;
  key.type = static_cast<uint32_t>(type);
  const auto found = std::lower_bound(sections.begin(), sections.end(), key, hasLowerKey);
  return found != sections.end() && found->chunk == key.chunk && found->type == key.type ? &*found : nullptr;
}

Result<Manifest> parseManifest(const std::vector<uint8_t>& bytes, uint64_t manifestEnd, uint64_t fileSize,
                               const std::string& file) {
  flatbuffers::Verifier::Options limits;
  limits.max_depth = kMaxDepth;
  limits.max_tables = kMaxTables;
  flatbuffers::Verifier verifier(bytes.data(), bytes.size(), limits);
  if (!fb::VerifyManifestBuffer(verifier) || !areStructsAligned(*fb::GetManifest(bytes.data())))
    return makeError(ErrorKind::kBadInput, "%s: the manifest's %zu bytes are no FlatBuffers manifest; %s",
                     file.c_str(), bytes.size(), kRemedy);
  const fb::Manifest& packed = *fb::GetManifest(bytes.data());
  if (packed.colour_space()->string_view() != kColourSpace)
    return makeError(ErrorKind::kUnsupported, "%s: colour_space is '%.32s', not '%s'; %s", file.c_str(),
                     packed.colour_space()->c_str(), kColourSpace, kTooNew);

  Manifest manifest;
  manifest.contents = unpackParameters(packed);
  if (Status status = unpackChunks(packed, file, manifest); !status) return status.error();
  if (Status status = checkParameters(manifest.contents, file); !status) return status.error();
  if (Status status = unpackSections(packed, manifestEnd, fileSize, file, manifest); !status)
    return status.error();
  if (Status status = checkPresence(manifest, file); !status) return status.error();
  return manifest;
}

}  // namespace froth
