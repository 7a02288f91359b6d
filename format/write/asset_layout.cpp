#include "format/write/asset_layout.h"

#include <algorithm>
#include <cstring>

#include "format/container.h"
#include "format/write/manifest_write.h"

namespace froth {

size_t streamOf(const SectionRecord& record) {
  return record.chunk == kSharedChunk ? 0
                                      : 1 + static_cast<size_t>(sectionLayer(static_cast<SectionType>(record.type)));
}

void AssetLayout::addSection(const SectionRecord& record) {
  const size_t stream = streamOf(record);
  streams_[stream].push_back(record);
  streams_[stream].back().offset = sizes_[stream];
  sizes_[stream] += record.storedSize;
}

AssetLayout::Head AssetLayout::buildHead(const AssetContents& contents) const {
  std::vector<SectionRecord> records;
  for (const std::vector<SectionRecord>& stream : streams_) records.insert(records.end(), stream.begin(), stream.end());

  FileHeader header;
  header.magic = kFileMagic;
  header.versionMajor = kVersionMajor;
  header.versionMinor = kVersionMinor;
  header.manifestOffset = sizeof(FileHeader);
  header.manifestSize = buildManifest(contents, chunks_, records).size();
  header.fileSize = header.manifestOffset + header.manifestSize;
  for (SectionRecord& record : records) {  // in the order of the file
    record.offset = header.fileSize;
    header.fileSize += record.storedSize;
  }
  const std::vector<uint8_t> manifest = buildManifest(contents, chunks_, records);
  header.manifestHash = hashBytes(manifest);
  header.headerHash = hashHeader(header);

  Head head;
  head.fileSize = header.fileSize;
  head.bytes.resize(sizeof(header) + manifest.size());
  std::memcpy(head.bytes.data(), &header, sizeof(header));
  std::copy(manifest.begin(), manifest.end(), head.bytes.begin() + sizeof(header));
  return head;
}

}  // namespace froth
