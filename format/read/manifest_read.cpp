#include "format/read/manifest_read.h"

#include <algorithm>
#include <tuple>

#include <format/froth_generated.h>

#include "base/text.h"
#include "format/checks.h"
#include "format/container.h"
#include "format/graph_rows.h"

namespace froth {
namespace {

constexpr char kRemedy[] = "the file is damaged, copy it or bake the scene again";
constexpr char kTooNew[] = "the file is newer than this program, update it";

// Manifests of version 2.0 have four tables and one per attribute error; later ones may add some.
constexpr flatbuffers::uoffset_t kMaxDepth = 16, kMaxTables = 1000;

using ull = unsigned long long;

std::array<double, 3> unpack(const fb::Double3& v) { return {v.x(), v.y(), v.z()}; }

StoredCamera unpack(const fb::Camera& camera) {
  StoredCamera result;
  for (uint16_t i = 0; i < result.worldFromCamera.size(); ++i) {
    result.worldFromCamera[i] = camera.world_from_camera()->Get(i);
  }
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
  result.unseenCulled = s.unseen_culled();
  result.steinerCells = s.steiner_cells();
  result.walkPairs = s.walk_pairs();
  result.alphaPairs = s.alpha_pairs();
  return result;
}

Quantization unpack(const fb::Quantization& q) {
  Quantization result;
  result.positionStep = q.position_step();
  result.radiusBits = q.radius_bits();
  result.densityBits = q.density_bits();
  result.normalBits = q.normal_bits();
  result.detailSiteStep = q.detail_site_step();
  result.heightStep = q.height_step();
  result.colourStep = q.colour_step();
  result.lobeAxisStep = q.lobe_axis_step();
  return result;
}

Box unpack(const fb::Box& box) { return {unpack(box.min()), unpack(box.max())}; }

EyeRegion unpack(const fb::EyeRegion& eyes) {
  EyeRegion result;
  result.radius = eyes.radius();
  result.worstPsnr = eyes.worst_psnr();
  result.meanPsnr = eyes.mean_psnr();
  for (const fb::Box* box : *eyes.boxes()) result.boxes.push_back(unpack(*box));
  return result;
}

ChunkLevel unpack(const fb::ChunkLevel& chunk) { return {chunk.level(), chunk.made_by(), chunk.in_group()}; }

LevelGroup unpack(const fb::Group& group) {
  return {unpack(group.centre()), group.radius(), group.error(), group.level()};
}

ChunkIndex unpack(const fb::Chunk& c) {
  return {unpack(c.origin()),
          {c.cell_count(), c.live_count(), c.ghost_count(), c.pair_count(), c.lobe_count(), 0},
          unpack(c.live_bounds())};
}

SectionRecord unpack(const fb::Section& s) {
  return {s.type(), s.chunk(),  s.flags(),       s.codec(),    s.element_size(),
          s.base(), s.offset(), s.stored_size(), s.raw_size(), s.hash()};
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
  return isAligned(manifest.flight_path()) && isAligned(manifest.chunks()) && isAligned(manifest.sections()) &&
         isAligned(manifest.levels()) && isAligned(manifest.groups()) &&
         (!manifest.eyes() || isAligned(manifest.eyes()->boxes()));
}

// Strings may lie in each other: each counts as often as a field refers to it, so that unpacking them takes no more
// memory than the manifest.
bool areStringsWithin(const fb::Manifest& manifest, uint64_t size) {
  uint64_t sum = uint64_t{manifest.colour_space()->size()} + manifest.preset()->size();
  if (manifest.source()) sum += manifest.source()->size();
  if (manifest.errors()) {
    for (const fb::AttributeError* error : *manifest.errors()) {
      sum += uint64_t{error->name()->size()} + error->unit()->size();
    }
  }
  return sum <= size;
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
  contents.quantization = unpack(*manifest.quantization());
  contents.preset = manifest.preset()->str();
  contents.psnr = manifest.psnr();
  if (manifest.errors()) {
    for (const fb::AttributeError* error : *manifest.errors()) {
      contents.errors.push_back({error->name()->str(), error->unit()->str(), error->rms(), error->max()});
    }
  }
  if (manifest.source()) contents.source = manifest.source()->str();
  if (manifest.eyes()) contents.eyes = unpack(*manifest.eyes());
  if (manifest.statistics()) contents.statistics = unpack(*manifest.statistics());
  contents.hasStartView = manifest.start_view() != nullptr;
  if (contents.hasStartView) contents.startView = unpack(*manifest.start_view());
  if (manifest.flight_path()) {
    for (const fb::Camera* camera : *manifest.flight_path()) contents.flightPath.push_back(unpack(*camera));
  }
  return contents;
}

// Of all chunks, which are there.
Status unpackLevels(const fb::Manifest& packed, const std::string& file, Manifest& manifest) {
  const size_t count = packed.levels() ? packed.levels()->size() : 0;
  if (count > 0 && count != manifest.chunks.size()) {
    return makeError(ErrorKind::kBadInput, "%s: levels of %zu chunks, there are %zu; %s", file.c_str(), count,
                     manifest.chunks.size(), kRemedy);
  }
  manifest.contents.borderCount = packed.border_count();
  for (size_t i = 0; i < count; ++i) {
    const fb::ChunkLevel& level = *packed.levels()->Get(static_cast<flatbuffers::uoffset_t>(i));
    manifest.contents.levels.push_back(unpack(level));
    manifest.chunks[i].counts.borders = level.border_count();
  }
  if (!packed.groups()) return {};
  for (const fb::Group* group : *packed.groups()) {
    if (group->reserved0() != 0) {
      return makeError(ErrorKind::kUnsupported, "%s: group %zu: reserved bits are set; %s", file.c_str(),
                       manifest.contents.groups.size(), kTooNew);
    }
    manifest.contents.groups.push_back(unpack(*group));
  }
  return {};
}

Status unpackChunks(const fb::Manifest& packed, const std::string& file, Manifest& manifest) {
  for (const fb::Chunk* chunk : *packed.chunks()) manifest.chunks.push_back(unpack(*chunk));
  if (Status status = unpackLevels(packed, file, manifest); !status) return status;
  if (Status status = checkChunkIndices(manifest.contents, manifest.chunks, file); !status) return status;
  for (const ChunkIndex& chunk : manifest.chunks) {
    ChunkContents contents;
    contents.origin = chunk.origin;
    contents.cellCount = static_cast<uint32_t>(chunk.counts.cells);
    contents.liveCount = static_cast<uint32_t>(chunk.counts.live);
    contents.ghostCount = static_cast<uint32_t>(chunk.counts.ghosts);
    manifest.contents.chunks.push_back(std::move(contents));
  }
  return {};
}

bool isKnown(const SectionRecord& record) { return sectionName(record.type) != nullptr; }

// For messages: to name each section of a scene of millions of cells takes longer than to check them.
std::string placeOf(const SectionRecord& record, const std::string& file) {
  return sectionPlace(chunkPlace(file, record.chunk), record.type);
}

// What the record says about itself and its place in the file.
Status checkRecord(const SectionRecord& record, bool hasReserved, uint64_t fileSize, const std::string& file) {
  if (hasReserved || (record.flags & kSectionReservedFlags) != 0) {
    return makeError(ErrorKind::kUnsupported, "%s: reserved bits are set (flags 0x%04x); %s",
                     placeOf(record, file).c_str(), record.flags, kTooNew);
  }
  if (record.offset > fileSize || record.storedSize > fileSize - record.offset) {
    return makeError(ErrorKind::kBadInput, "%s: offset %llu + size %llu lies beyond the file's %llu bytes; %s",
                     placeOf(record, file).c_str(), ull{record.offset}, ull{record.storedSize}, ull{fileSize}, kRemedy);
  }
  if (!isKnown(record) && (record.flags & kSectionCritical) != 0) {
    return makeError(ErrorKind::kUnsupported, "%s: unknown and critical; %s", placeOf(record, file).c_str(), kTooNew);
  }
  return {};
}

// Elements and entries of a known section; 0 entries: there must be no such section.
uint64_t demandedEntries(const SectionRecord& record, const Manifest& manifest) {
  const SectionType type = static_cast<SectionType>(record.type);
  if (type == SectionType::kAxisCodebook) return manifest.codebookSize;
  const ChunkCounts& counts = manifest.chunks[record.chunk].counts;
  const bool hasCodebook = manifest.codebookSize > 0;
  if (sectionPresence(type, manifest.contents, hasCodebook, counts) == Presence::kForbidden) return 0;
  return sectionEntries(type, counts, manifest.contents.detailCount);
}

Status checkElements(const SectionRecord& record, const Manifest& manifest, const std::string& file) {
  const ElementKind kind = sectionKind(static_cast<SectionType>(record.type), manifest.contents.quantization);
  const bool isGraph = kind == ElementKind::kGraph;
  if (!isElementSize(kind, record.elementSize) ||
      (isGraph && record.elementSize != graphElementSize(manifest.contents.chunks[record.chunk]))) {
    return makeError(ErrorKind::kBadInput, "%s: elements of %u bytes cannot be; %s", placeOf(record, file).c_str(),
                     record.elementSize, kRemedy);
  }
  if (record.base != 0 && kind != ElementKind::kUnsigned) {
    return makeError(ErrorKind::kBadInput, "%s: base is %u, these elements have none; %s",
                     placeOf(record, file).c_str(), record.base, kRemedy);
  }
  return {};
}

// What the record of a known section says, against the counts of its chunk.
Status checkKnownRecord(const SectionRecord& record, const Manifest& manifest, const std::string& file) {
  const SectionType type = static_cast<SectionType>(record.type);
  const bool isShared = type == SectionType::kAxisCodebook;
  if (isShared ? record.chunk != kSharedChunk : record.chunk >= manifest.chunks.size()) {
    return makeError(ErrorKind::kBadInput, "%s: belongs to no such chunk, there are %zu; %s",
                     placeOf(record, file).c_str(), manifest.chunks.size(), kRemedy);
  }
  if (record.codec > kLastSectionCodec) {
    return makeError(ErrorKind::kUnsupported, "%s: unknown codec %u; %s", placeOf(record, file).c_str(), record.codec,
                     kTooNew);
  }
  const uint64_t entries = demandedEntries(record, manifest);
  if (entries == 0) {
    return makeError(ErrorKind::kBadInput, "%s: must not be there; %s", placeOf(record, file).c_str(), kRemedy);
  }
  if (Status status = checkElements(record, manifest, file); !status) return status;
  const uint64_t rawSize = entries * sectionComponents(type, manifest.contents.quantization) * record.elementSize;
  if (record.rawSize != rawSize) {
    return makeError(ErrorKind::kBadInput, "%s: raw size %llu, but the counts demand %llu bytes; %s",
                     placeOf(record, file).c_str(), ull{record.rawSize}, ull{rawSize}, kRemedy);
  }
  const bool isStored = record.codec == static_cast<uint16_t>(SectionCodec::kStored);
  if (isStored ? record.storedSize != record.rawSize : record.rawSize > record.storedSize * kMaxExpansion) {
    return makeError(ErrorKind::kBadInput, "%s: %llu stored bytes cannot hold %llu; %s", placeOf(record, file).c_str(),
                     ull{record.storedSize}, ull{record.rawSize}, kRemedy);
  }
  return {};
}

// `occupied`: ranges [offset, end) of all sections, and of the manifest with the header before it.
Status checkOverlaps(std::vector<std::pair<uint64_t, uint64_t>> occupied, const std::string& file) {
  if (!std::ranges::is_sorted(occupied)) std::ranges::sort(occupied);
  for (size_t i = 1; i < occupied.size(); ++i) {
    if (occupied[i].first < occupied[i - 1].second) {
      return makeError(ErrorKind::kBadInput, "%s: the section at byte %llu overlaps what ends at byte %llu; %s",
                       file.c_str(), ull{occupied[i].first}, ull{occupied[i - 1].second}, kRemedy);
    }
  }
  return {};
}

Status checkKeys(const std::vector<SectionRecord>& sorted, const std::string& file) {
  for (size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i].chunk == sorted[i - 1].chunk && sorted[i].type == sorted[i - 1].type) {
      return makeError(ErrorKind::kBadInput, "%s: exists twice; %s", placeOf(sorted[i], file).c_str(), kRemedy);
    }
  }
  return {};
}

Status unpackSections(const fb::Manifest& packed, uint64_t manifestEnd, uint64_t fileSize, const std::string& file,
                      Manifest& manifest) {
  std::vector<SectionRecord> all;
  std::vector<std::pair<uint64_t, uint64_t>> occupied{{0, manifestEnd}};
  all.reserve(packed.sections()->size());
  occupied.reserve(all.capacity() + 1);
  for (const fb::Section* section : *packed.sections()) {
    const SectionRecord record = unpack(*section);
    const bool hasReserved = section->reserved0() != 0 || section->reserved1() != 0;
    if (Status status = checkRecord(record, hasReserved, fileSize, file); !status) return status;
    occupied.emplace_back(record.offset, record.offset + record.storedSize);
    all.push_back(record);
    if (!isKnown(record)) continue;
    if (Status status = checkKnownRecord(record, manifest, file); !status) return status;
  }
  std::sort(all.begin(), all.end(), hasLowerKey);
  if (Status status = checkKeys(all, file); !status) return status;
  if (Status status = checkOverlaps(std::move(occupied), file); !status) return status;
  std::erase_if(all, [](const SectionRecord& record) { return !isKnown(record); });
  manifest.sections = std::move(all);
  return {};
}

Status missing(const std::string& chunkPlace, SectionType type) {
  return makeError(ErrorKind::kBadInput, "%s: is missing; %s", sectionPlace(chunkPlace, type).c_str(), kRemedy);
}

Status checkPresence(const Manifest& manifest, const std::string& file) {
  const bool hasCodebook = manifest.codebookSize > 0;
  if (hasCodebook && !manifest.findSection(kSharedChunk, SectionType::kAxisCodebook)) {
    return missing(chunkPlace(file, kSharedChunk), SectionType::kAxisCodebook);
  }
  for (uint32_t index = 0; index < manifest.chunks.size(); ++index) {
    for (const SectionType type : allSectionTypes()) {
      const Presence presence = sectionPresence(type, manifest.contents, hasCodebook, manifest.chunks[index].counts);
      if (presence == Presence::kRequired && !manifest.findSection(index, type)) {
        return missing(chunkPlace(file, index), type);
      }
    }
  }
  return {};
}

}  // namespace

const SectionRecord* Manifest::findSection(uint32_t chunk, SectionType type) const {
  SectionRecord key;
  key.chunk = chunk;
  key.type = static_cast<uint32_t>(type);
  const auto found = std::lower_bound(sections.begin(), sections.end(), key, hasLowerKey);
  return found != sections.end() && found->chunk == key.chunk && found->type == key.type ? &*found : nullptr;
}

Result<Manifest> parseManifest(std::span<const uint8_t> bytes, uint64_t manifestEnd, uint64_t fileSize,
                               const std::string& file) {
  flatbuffers::Verifier::Options limits;
  limits.max_depth = kMaxDepth;
  limits.max_tables = kMaxTables;
  flatbuffers::Verifier verifier(bytes.data(), bytes.size(), limits);
  if (!fb::VerifyManifestBuffer(verifier) || !areStructsAligned(*fb::GetManifest(bytes.data()))) {
    return makeError(ErrorKind::kBadInput, "%s: the manifest's %zu bytes are no FlatBuffers manifest; %s", file.c_str(),
                     bytes.size(), kRemedy);
  }
  const fb::Manifest& packed = *fb::GetManifest(bytes.data());
  if (!areStringsWithin(packed, bytes.size())) {
    return makeError(ErrorKind::kBadInput, "%s: the manifest's strings together are longer than its %zu bytes; %s",
                     file.c_str(), bytes.size(), kRemedy);
  }
  if (packed.eyes() && packed.eyes()->boxes()->size() == 0) {
    return makeError(ErrorKind::kBadInput, "%s: eyes: no box; %s", file.c_str(), kRemedy);
  }
  if (packed.colour_space()->string_view() != kColourSpace) {
    return makeError(ErrorKind::kUnsupported, "%s: colour_space is '%.32s', not '%s'; %s", file.c_str(),
                     printable(packed.colour_space()->string_view()).c_str(), kColourSpace, kTooNew);
  }

  Manifest manifest;
  manifest.contents = unpackParameters(packed);
  manifest.codebookSize = packed.codebook_size();
  if (Status status = checkParameters(manifest.contents, file); !status) return status.error();
  if (Status status = checkCodebookSize(manifest.contents, manifest.codebookSize, file); !status) return status.error();
  if (Status status = unpackChunks(packed, file, manifest); !status) return status.error();
  if (Status status = unpackSections(packed, manifestEnd, fileSize, file, manifest); !status) return status.error();
  if (Status status = checkPresence(manifest, file); !status) return status.error();
  return manifest;
}

}  // namespace froth
