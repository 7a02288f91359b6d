#include "asset_dump.h"

#include <fstream>
#include <span>

namespace froth {
namespace {

class Dump {
 public:
  explicit Dump(const std::filesystem::path& path) : file_(path, std::ios::binary) {}

  void write(size_t index, const ChunkContents& chunk) {
    index_ = index;
    write("origin", chunk.origin);
    write("sites", chunk.sites);
    write("radii", chunk.radii);
    write("ghostRefs", chunk.ghostRefs);
    write("borderCells", chunk.borderCells);
    write("borderNumbers", chunk.borderNumbers);
    write("neighbourOffsets", chunk.neighbourOffsets);
    write("neighbours", chunk.neighbours);
    write("alphaCounts", chunk.alphaCounts);
    write("densities", chunk.densities);
    write("orientations", chunk.orientations);
    write("cellColours", chunk.cellColours);
    write("cellHeights", chunk.cellHeights);
    write("solidBalls", chunk.solidBalls);
    write("detailSites", chunk.detailSites);
    write("detailHeights", chunk.detailHeights);
    write("baseColours", chunk.baseColours);
    write("detailScales", chunk.detailScales);
    write("colourScales", chunk.colourScales);
    write("lobeCounts", chunk.lobeCounts);
    write("lobeAxes", chunk.lobeAxes);
    write("lobeColours", chunk.lobeColours);
  }

 private:
  template <class Array>
  void write(const char* name, const Array& values) {
    if (values.empty()) return;
    const auto bytes = std::as_bytes(std::span(values));
    file_ << index_ << ' ' << name << ' ' << bytes.size() << '\n';
    file_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }

  std::ofstream file_;
  size_t index_ = 0;
};

}  // namespace

void writeDump(const std::filesystem::path& path, const AssetContents& contents) {
  Dump dump(path);
  for (size_t i = 0; i < contents.chunks.size(); ++i) dump.write(i, contents.chunks[i]);
}

}  // namespace froth
