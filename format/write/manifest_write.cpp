#include "format/write/manifest_write.h"

#include <format/froth_generated.h>

#include "format/container.h"

namespace froth {
namespace {

fb::Double3 pack(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

fb::Box pack(const Box& box) { return {pack(box.min), pack(box.max)}; }

fb::Camera pack(const StoredCamera& camera) {
  return fb::Camera(flatbuffers::make_span(camera.worldFromCamera), camera.tanHalfFovY);
}

fb::Chunk pack(const ChunkIndex& chunk) {
  const ChunkCounts& n = chunk.counts;
  return fb::Chunk(pack(chunk.origin), n.cells, n.live, n.ghosts, n.pairs, n.lobes, pack(chunk.liveBounds));
}

fb::Section pack(const SectionRecord& record) {
  return fb::Section(record.type, record.chunk, record.flags, record.codec, static_cast<uint16_t>(record.elementSize),
                     0, record.base, 0, record.offset, record.storedSize, record.rawSize, record.hash);
}

fb::Group pack(const LevelGroup& group) {
  return fb::Group(pack(group.centre), group.radius, group.error, group.level, 0);
}

template <class Packed, class Source>
flatbuffers::Offset<flatbuffers::Vector<const Packed*>> packAll(flatbuffers::FlatBufferBuilder& builder,
                                                                const Source& source) {
  std::vector<Packed> packed;
  for (const auto& element : source) packed.push_back(pack(element));
  return builder.CreateVectorOfStructs(packed);
}

flatbuffers::Offset<fb::Statistics> packStatistics(flatbuffers::FlatBufferBuilder& builder, const BakeStatistics& s) {
  return fb::CreateStatistics(builder, s.inputCells, s.hiddenDropped, s.duplicatesMerged, s.emptyCells, s.deadCells,
                              s.unseenCulled, s.steinerCells, s.walkPairs, s.alphaPairs);
}

flatbuffers::Offset<fb::Quantization> packQuantization(flatbuffers::FlatBufferBuilder& builder, const Quantization& q) {
  return fb::CreateQuantization(builder, q.positionStep, q.radiusBits, q.densityBits, q.normalBits, q.detailSiteStep,
                                q.heightStep, q.colourStep, q.lobeAxisStep);
}

auto packErrors(flatbuffers::FlatBufferBuilder& builder, const std::vector<AttributeError>& errors) {
  std::vector<flatbuffers::Offset<fb::AttributeError>> packed;
  for (const AttributeError& error : errors) {
    packed.push_back(fb::CreateAttributeError(builder, builder.CreateString(error.name),
                                              builder.CreateString(error.unit), error.rms, error.max));
  }
  return builder.CreateVector(packed);
}

flatbuffers::Offset<fb::EyeRegion> packEyes(flatbuffers::FlatBufferBuilder& builder, const EyeRegion& eyes) {
  if (eyes.boxes.empty()) return 0;
  return fb::CreateEyeRegion(builder, packAll<fb::Box>(builder, eyes.boxes), eyes.radius, eyes.worstPsnr,
                             eyes.meanPsnr);
}

// None without levels.
flatbuffers::Offset<flatbuffers::Vector<const fb::ChunkLevel*>> packLevels(flatbuffers::FlatBufferBuilder& builder,
                                                                           const std::vector<ChunkLevel>& levels,
                                                                           std::span<const ChunkIndex> chunks) {
  if (levels.empty()) return 0;
  std::vector<fb::ChunkLevel> packed;
  for (size_t i = 0; i < levels.size(); ++i) {
    packed.emplace_back(levels[i].level, levels[i].madeBy, levels[i].in,
                        static_cast<uint32_t>(chunks[i].counts.borders));
  }
  return builder.CreateVectorOfStructs(packed);
}

}  // namespace

std::vector<uint8_t> buildManifest(const AssetContents& contents, std::span<const ChunkIndex> chunkIndices,
                                   std::span<const SectionRecord> sections) {
  flatbuffers::FlatBufferBuilder builder;
  const auto colourSpace = builder.CreateString(kColourSpace);
  const auto preset = builder.CreateString(contents.preset);
  const auto source = builder.CreateString(contents.source);
  const auto statistics = packStatistics(builder, contents.statistics);
  const auto quantization = packQuantization(builder, contents.quantization);
  const auto errors = packErrors(builder, contents.errors);
  const auto flightPath = packAll<fb::Camera>(builder, contents.flightPath);
  const auto chunks = packAll<fb::Chunk>(builder, chunkIndices);
  const auto records = packAll<fb::Section>(builder, sections);
  const auto eyes = packEyes(builder, contents.eyes);
  const auto levels = packLevels(builder, contents.levels, chunkIndices);
  const auto groups = contents.groups.empty() ? 0 : packAll<fb::Group>(builder, contents.groups);
  const fb::Camera startView = pack(contents.startView);

  fb::ManifestBuilder manifest(builder);
  manifest.add_detail_count(contents.detailCount);
  manifest.add_lobe_count(contents.lobeCount);
  manifest.add_local_bits(contents.localBits);
  manifest.add_has_walk_graph(contents.hasWalkGraph);
  manifest.add_detail_sharpness(contents.detailSharpness);
  manifest.add_near_ratio(contents.nearRatio);
  manifest.add_near_depth(contents.nearDepth);
  manifest.add_codebook_size(static_cast<uint32_t>(contents.axisCodebook.size()));
  manifest.add_colour_space(colourSpace);
  manifest.add_quantization(quantization);
  manifest.add_preset(preset);
  manifest.add_source(source);
  manifest.add_statistics(statistics);
  manifest.add_errors(errors);
  manifest.add_psnr(contents.psnr);
  if (contents.hasStartView) manifest.add_start_view(&startView);
  manifest.add_flight_path(flightPath);
  manifest.add_chunks(chunks);
  manifest.add_sections(records);
  if (!eyes.IsNull()) manifest.add_eyes(eyes);
  if (!levels.IsNull()) manifest.add_levels(levels);
  if (!groups.IsNull()) manifest.add_groups(groups);
  manifest.add_border_count(contents.borderCount);
  fb::FinishManifestBuffer(builder, manifest.Finish());
  return {builder.GetBufferPointer(), builder.GetBufferPointer() + builder.GetSize()};
}

}  // namespace froth
