// Seeds of fuzz_sections and fuzz_graph_rows: one section of each codec, and packed graphs.
// Usage: make_codec_seeds FOLDER, which gets a folder per target
#include <filesystem>
#include <fstream>
#include <numeric>
#include <string>

#include "base/morton_code.h"
#include "codec_inputs.h"
#include "format/draco_positions.h"
#include "format/graph_rows.h"
#include "format/position_order.h"
#include "format/write/section_codec_write.h"
#include "tests/format/codec_samples.h"

namespace froth {
namespace {

template <class Header>
void writeSeed(const std::filesystem::path& path, const Header& header,
               std::initializer_list<std::span<const uint8_t>> parts) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(&header), sizeof(header));
  for (const std::span<const uint8_t> part : parts) {
    file.write(reinterpret_cast<const char*>(part.data()), static_cast<std::streamsize>(part.size()));
  }
}

void writeSection(const std::filesystem::path& folder, const EncodedSection& section, SectionShape shape,
                  size_t rawSize) {
  SectionInput input;
  input.codec = static_cast<uint8_t>(section.codec);
  input.elementSizeLog = static_cast<uint8_t>(shape.elementSize / 2);
  input.components = static_cast<uint8_t>(shape.components - 1);
  input.entries = static_cast<uint32_t>(rawSize / shape.elementSize / shape.components);
  writeSeed(folder / ("codec" + std::to_string(input.codec)), input, {section.stored});
}

void writeSections(const std::filesystem::path& folder) {
  const std::vector<uint8_t> noise = randomBytes(30);
  std::vector<uint8_t> pattern(240);
  for (size_t i = 0; i < pattern.size(); ++i) pattern[i] = noise[i % 24];
  std::vector<uint16_t> ramp(90);
  std::iota(ramp.begin(), ramp.end(), uint16_t{1000});
  std::vector<uint32_t> counts(90);
  for (size_t i = 0; i < counts.size(); ++i) counts[i] = noise[i % 30] + 70000u;
  for (const auto& [raw, shape] :
       {std::pair{bytesOf(noise), SectionShape{1, 1}}, std::pair{bytesOf(pattern), SectionShape{1, 3}},
        std::pair{bytesOf(ramp), SectionShape{2, 1}}, std::pair{bytesOf(counts), SectionShape{4, 1}}}) {
    if (const Result<EncodedSection> section = encodeSection(raw, shape)) {
      writeSection(folder, *section, shape, raw.size());
    }
  }
  std::vector<LatticePoint> points = randomPoints(200, 9);
  const auto codeOf = [](const LatticePoint& point) {  // the points lie in -1000 .. -489
    return mortonCode({point[0] + 1000u, point[1] + 1000u, point[2] + 1000u});
  };
  std::sort(points.begin(), points.end(), [&](const auto& a, const auto& b) { return codeOf(a) < codeOf(b); });
  const uint32_t run = static_cast<uint32_t>(points.size());
  if (const Result<EncodedSection> section = encodePositions(bytesOf(points), {&run, 1})) {
    writeSection(folder, *section, kPositionShape, bytesOf(points).size());
  }
  const Result<std::vector<uint32_t>> order = dracoOrder(points);
  if (!order) return;
  std::vector<LatticePoint> ordered;
  for (const uint32_t i : *order) ordered.push_back(points[i]);
  if (Result<std::vector<uint8_t>> draco = writeDracoPositions(ordered, {&run, 1})) {
    writeSection(folder, {SectionCodec::kDraco, std::move(*draco)}, kPositionShape, bytesOf(points).size());
  }
}

void writeGraph(const std::filesystem::path& path, bool hasWalkGraph) {
  const ChunkContents chunk = randomGraph(16, hasWalkGraph);
  const Result<PackedGraph> packed = packGraph(chunk, hasWalkGraph);
  if (!packed) return;
  GraphInput input;
  input.hasWalkGraph = hasWalkGraph;
  input.cells = static_cast<uint16_t>(chunk.cellCount);
  input.live = static_cast<uint16_t>(chunk.liveCount);
  input.ghosts = static_cast<uint16_t>(chunk.ghostCount);
  input.deltasSize = static_cast<uint32_t>(packed->deltas.size());
  std::vector<glm::vec4> balls;
  for (size_t i = 0; i < chunk.sites.size(); ++i) balls.emplace_back(chunk.sites[i], chunk.radii[i]);
  writeSeed(path, input, {bytesOf(balls), packed->counts, packed->deltas, packed->alphaBits});
}

}  // namespace
}  // namespace froth

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::filesystem::path folder = argv[1], sections = folder / "fuzz_sections",
                              graphs = folder / "fuzz_graph_rows";
  std::filesystem::create_directories(sections);
  std::filesystem::create_directories(graphs);
  froth::writeSections(sections);
  froth::writeGraph(graphs / "walk", true);
  froth::writeGraph(graphs / "alpha", false);
  return 0;
}
