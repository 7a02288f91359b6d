#include "format/write/asset_layout.h"

#include <algorithm>
#include <cstring>

#include "format/container.h"
#include "format/write/manifest_write.h"

namespace froth {

void AssetLayout::add(const SectionRecord& record, std::vector<SectionRecord>& records) {
  records.push_back(record);
  records.back().offset = size_;
  size_ += record.storedSize;
}

void AssetLayout::addChunk(const ChunkIndex& chunk, std::span<const SectionRecord> records) {
  Chunk& added = chunks_.emplace_back();
  added.index = chunk;
  for (const SectionRecord& record : records) add(record, added.records);
}

std::vector<ChunkIndex> AssetLayout::chunks(std::span<const uint32_t> order) const {
  std::vector<ChunkIndex> chunks;
  for (const uint32_t appended : order) chunks.push_back(chunks_[appended].index);
  return chunks;
}

// Offsets as appended. Without levels all chunks are the floor.
std::vector<SectionRecord> AssetLayout::recordsInOrder(std::span<const ChunkLevel> levels,
                                                       std::span<const uint32_t> order) const {
  const auto inFloor = [](const ChunkLevel& chunk) { return chunk.in == kNoGroup; };
  const size_t floorCount =
      levels.empty() ? order.size() : static_cast<size_t>(std::count_if(levels.begin(), levels.end(), inFloor));
  std::vector<SectionRecord> records = shared_;
  const auto take = [&](uint32_t chunk, auto wants) {
    for (SectionRecord record : chunks_[order[chunk]].records) {
      record.chunk = chunk;
      if (wants(sectionLayer(static_cast<SectionType>(record.type)))) records.push_back(record);
    }
  };
  for (const Layer layer : {Layer::kGeometry, Layer::kDetails, Layer::kViewDependence}) {
    for (uint32_t chunk = 0; chunk < floorCount; ++chunk) {
      take(chunk, [layer](Layer found) { return found == layer; });
    }
  }
  for (uint32_t chunk = static_cast<uint32_t>(floorCount); chunk < order.size(); ++chunk) {
    take(chunk, [](Layer) { return true; });
  }
  return records;
}

AssetLayout::Plan AssetLayout::plan(const AssetContents& contents, std::span<const uint32_t> order) const {
  const std::vector<ChunkIndex> indices = chunks(order);
  std::vector<SectionRecord> records = recordsInOrder(contents.levels, order);
  FileHeader header;
  header.magic = kFileMagic;
  header.versionMajor = kVersionMajor;
  header.versionMinor = kVersionMinor;
  header.manifestOffset = sizeof(FileHeader);
  header.manifestSize = buildManifest(contents, indices, records).size();
  header.fileSize = header.manifestOffset + header.manifestSize;

  Plan plan;
  for (SectionRecord& record : records) {
    const bool touches = !plan.parts.empty() && plan.parts.back().offset + plan.parts.back().size == record.offset;
    if (touches) {
      plan.parts.back().size += record.storedSize;
    } else {
      plan.parts.push_back({record.offset, record.storedSize});
    }
    record.offset = header.fileSize;
    header.fileSize += record.storedSize;
  }
  const std::vector<uint8_t> manifest = buildManifest(contents, indices, records);
  header.manifestHash = hashBytes(manifest);
  header.headerHash = hashHeader(header);
  plan.fileSize = header.fileSize;
  plan.head.resize(sizeof(header));
  std::memcpy(plan.head.data(), &header, sizeof(header));
  plan.head.insert(plan.head.end(), manifest.begin(), manifest.end());
  return plan;
}

}  // namespace froth
