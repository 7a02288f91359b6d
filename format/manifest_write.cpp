#include "format/manifest_write.h"

#include <format/froth_generated.h>

#include "format/checks.h"
#include "format/container.h"

namespace froth {
namespace {

fb::Double3 pack(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

fb::Camera pack(const StoredCamera& camera) {
  return fb::Camera(flatbuffers::make_span(camera.worldFromCamera), camera.tanHalfFovY);
}

fb::Chunk pack(const ChunkContents& chunk) {
  const Box bounds = liveBoundsOf(chunk);
  return fb::Chunk(pack(chunk.origin), chunk.cellCount, chunk.liveCount, chunk.neighbours.size(),
                   fb::Box(pack(bounds.min), pack(bounds.max)));
}

fb::Section pack(const SectionRecord& record) {
  return fb::Section(record.type, record.chunk, record.flags, record.codec, 0, record.offset,
                     record.storedSize, record.rawSize, record.hash);
}

template <class Packed, class Source>
flatbuffers::Offset<flatbuffers::Vector<const Packed*>> packAll(flatbuffers::FlatBufferBuilder& builder,
                                                                const Source& source) {
  std::vector<Packed> packed;
  for (const auto& element : source) packed.push_back(pack(element));
  return builder.CreateVectorOfStructs(packed);
}

flatbuffers::Offset<fb::Statistics> packStatistics(flatbuffers::FlatBufferBuilder& builder,
                                                   const BakeStatistics& s) {
  return fb::CreateStatistics(builder, s.inputCells, s.hiddenDropped, s.duplicatesMerged, s.emptyCells,
                              s.deadCells, s.walkPairs, s.alphaPairs);
}

}  // namespace

std::vector<uint8_t> buildManifest(const AssetContents& contents, std::span<const SectionRecord> sections) {
  flatbuffers::FlatBufferBuilder builder;
  const auto colourSpace = builder.CreateString(kColourSpace);
  const auto preset = builder.CreateString(contents.preset);
  const auto source = builder.CreateString(contents.source);
  const auto statistics = packStatistics(builder, contents.statistics);
  const auto flightPath = packAll<fb::Camera>(builder, contents.flightPath);
  const auto chunks = packAll<fb::Chunk>(builder, contents.chunks);
  const auto records = packAll<fb::Section>(builder, sections);
  const fb::Camera startView = pack(contents.startView);

  fb::ManifestBuilder manifest(builder);
  manifest.add_detail_count(contents.detailCount);
  manifest.add_lobe_count(contents.lobeCount);
  manifest.add_local_bits(contents.localBits);
  manifest.add_has_walk_graph(contents.hasWalkGraph);
  manifest.add_detail_sharpness(contents.detailSharpness);
  manifest.add_near_ratio(contents.nearRatio);
  manifest.add_near_depth(contents.nearDepth);
  manifest.add_colour_space(colourSpace);
  manifest.add_preset(preset);
  manifest.add_source(source);
  manifest.add_statistics(statistics);
  if (contents.hasStartView) manifest.add_start_view(&startView);
  manifest.add_flight_path(flightPath);
  manifest.add_chunks(chunks);
  manifest.add_sections(records);
  fb::FinishManifestBuffer(builder, manifest.Finish());
  return {builder.GetBufferPointer(), builder.GetBufferPointer() + builder.GetSize()};
}

}  // namespace froth
