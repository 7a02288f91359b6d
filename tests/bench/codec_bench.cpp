// Decoding, in bytes of raw output per second and core:
//   froth_bench_codecs ASSET [--benchmark_...]
// Every section codec on lattice indices of the asset's sites, on its radii and on its base colours; the
// graph; whole chunks, all layers, as they are read and as the runtime's jobs make them ready for the GPU.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include <benchmark/benchmark.h>

#include "base/morton_code.h"
#include "format/container.h"
#include "format/draco_positions.h"
#include "format/graph_rows.h"
#include "format/position_order.h"
#include "format/read/asset_reader.h"
#include "format/read/section_codec_read.h"
#include "format/write/section_codec_write.h"
#include "runtime/asset/loaded_chunk.h"

namespace froth {
namespace {

template <class T>
std::span<const uint8_t> bytesOf(const std::vector<T>& values) {
  return {reinterpret_cast<const uint8_t*>(values.data()), values.size() * sizeof(T)};
}

void setRates(benchmark::State& state, size_t rawSize, size_t storedSize) {
  state.SetBytesProcessed(static_cast<int64_t>(state.iterations() * rawSize));
  state.counters["stored/raw"] = static_cast<double>(storedSize) / static_cast<double>(rawSize);
}

void benchSection(const std::string& name, EncodedSection section, size_t rawSize, SectionShape shape) {
  const std::string title = "codec " + std::to_string(static_cast<int>(section.codec)) + ", " + name;
  benchmark::RegisterBenchmark(title.c_str(), [section = std::move(section), rawSize, shape](benchmark::State& state) {
    SectionRecord record;
    record.codec = static_cast<uint16_t>(section.codec);
    record.hash = hashBytes(section.stored);
    std::vector<uint8_t> raw(rawSize);
    for (auto _ : state) {
      if (!decodeSection(record, section.stored, raw, "section", shape)) return state.SkipWithError("not decoded");
    }
    setRates(state, rawSize, section.stored.size());
  });
}

// Indices of the live cells' sites on a grid of `bits` bits over the chunk.
std::vector<LatticePoint> latticePoints(const ChunkContents& chunk, int bits) {
  glm::vec3 low = chunk.sites[0], high = low;
  for (uint32_t cell = 0; cell < chunk.liveCount; ++cell) {
    low = glm::min(low, chunk.sites[cell]);
    high = glm::max(high, chunk.sites[cell]);
  }
  const float scale = std::ldexp(0.999f, bits) / std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  std::vector<LatticePoint> points;
  for (uint32_t cell = 0; cell < chunk.liveCount; ++cell) {
    const glm::ivec3 index((chunk.sites[cell] - low) * scale);
    points.push_back({index.x, index.y, index.z});
  }
  const auto codeOf = [](const LatticePoint& point) {
    return mortonCode(
        {static_cast<uint32_t>(point[0]), static_cast<uint32_t>(point[1]), static_cast<uint32_t>(point[2])});
  };
  std::sort(points.begin(), points.end(), [&](const auto& a, const auto& b) { return codeOf(a) < codeOf(b); });
  return points;
}

void benchPositions(const ChunkContents& chunk) {
  const std::vector<LatticePoint> points = latticePoints(chunk, 14);
  const uint32_t run = static_cast<uint32_t>(points.size());
  const size_t rawSize = bytesOf(points).size();
  if (Result<EncodedSection> section = encodePositions(bytesOf(points), {&run, 1})) {
    benchSection("sites", std::move(*section), rawSize, kPositionShape);
  }
  const Result<std::vector<uint32_t>> order = dracoOrder(points);
  if (!order) return;
  std::vector<LatticePoint> ordered;
  for (const uint32_t i : *order) ordered.push_back(points[i]);
  if (Result<std::vector<uint8_t>> draco = writeDracoPositions(ordered, {&run, 1})) {
    benchSection("sites", {SectionCodec::kDraco, std::move(*draco)}, rawSize, kPositionShape);
  }
}

void benchNumbers(const ChunkContents& chunk) {
  const auto add = [](const char* name, std::span<const uint8_t> raw, SectionShape shape) {
    if (raw.empty()) return;
    if (Result<EncodedSection> section = encodeSection(raw, shape)) {
      benchSection(name, std::move(*section), raw.size(), shape);
    }
  };
  std::vector<uint8_t> bytes;
  for (const glm::vec3& colour : chunk.baseColours) {
    for (int c = 0; c < 3; ++c) bytes.push_back(static_cast<uint8_t>(std::lround(colour[c] * 100.0f)));
  }
  std::vector<uint16_t> heights;
  for (const glm::vec2& site : chunk.detailSites) {
    heights.push_back(static_cast<uint16_t>(std::lround(site.x * 4096.0f)));
  }
  add("radii, float", bytesOf(chunk.radii), {4, 1});
  add("lobe colours, float", bytesOf(chunk.lobeColours), {4, 3});
  add("base colours, 1 byte", bytes, {1, 3});
  add("detail sites, 2 bytes", bytesOf(heights), {2, 1});
}

void benchGraph(const ChunkContents& chunk, bool hasWalkGraph) {
  Result<PackedGraph> packed = packGraph(chunk, hasWalkGraph);
  if (!packed) return;
  benchmark::RegisterBenchmark(
      "rows from a packed graph", [chunk, packed = std::move(*packed), hasWalkGraph](benchmark::State& state) {
        ChunkContents unpacked = chunk;
        for (auto _ : state) {
          if (!unpackGraph({packed.counts, packed.deltas, packed.alphaBits}, hasWalkGraph, unpacked, "chunk")) {
            return state.SkipWithError("not unpacked");
          }
        }
        const size_t rawSize = bytesOf(chunk.neighbours).size() + bytesOf(chunk.neighbourOffsets).size() +
                               bytesOf(chunk.alphaCounts).size();
        setRates(state, rawSize, packed.counts.size() + packed.deltas.size() + packed.alphaBits.size());
      });
}

size_t decodedSize(const ChunkContents& c) {
  return bytesOf(c.sites).size() + bytesOf(c.radii).size() + bytesOf(c.ghostRefs).size() +
         bytesOf(c.neighbourOffsets).size() + bytesOf(c.neighbours).size() + bytesOf(c.alphaCounts).size() +
         bytesOf(c.densities).size() + bytesOf(c.orientations).size() + bytesOf(c.cellColours).size() +
         bytesOf(c.cellHeights).size() + bytesOf(c.solidBalls).size() + bytesOf(c.detailSites).size() +
         bytesOf(c.detailHeights).size() + bytesOf(c.baseColours).size() + bytesOf(c.colourScales).size() +
         bytesOf(c.lobeCounts).size() + bytesOf(c.lobeAxes).size() + bytesOf(c.lobeColours).size();
}

void benchChunk(const AssetReader& reader, const ChunkContents& chunk, size_t storedSize) {
  benchmark::RegisterBenchmark("whole chunk",
                               [&reader, rawSize = decodedSize(chunk), storedSize](benchmark::State& state) {
                                 for (auto _ : state) {
                                   if (!reader.readChunk(0)) return state.SkipWithError("not read");
                                 }
                                 setRates(state, rawSize, storedSize);
                               });
  benchmark::RegisterBenchmark("whole chunk for the GPU",
                               [&reader, rawSize = decodedSize(chunk), storedSize](benchmark::State& state) {
                                 const std::shared_ptr<const ByteSource> bytes = reader.source();
                                 for (auto _ : state) {
                                   if (!loadChunk(reader, *bytes, 0, "asset", {.drawing = true})) {
                                     return state.SkipWithError("not loaded");
                                   }
                                 }
                                 setRates(state, rawSize, storedSize);
                               });
}

int run(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  const Result<AssetReader> reader = AssetReader::open(argc == 2 ? argv[1] : "");
  if (!reader) return std::fprintf(stderr, "%s\n", reader.error().message.c_str()), 3;
  const Result<ChunkContents> chunk = reader->readChunk(0);
  if (!chunk) return std::fprintf(stderr, "%s\n", chunk.error().message.c_str()), 3;
  benchPositions(*chunk);
  benchNumbers(*chunk);
  benchGraph(*chunk, reader->manifest().hasWalkGraph);
  const size_t chunks = reader->manifest().chunks.size();
  benchChunk(*reader, *chunk, std::filesystem::file_size(argv[1]) / chunks);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace
}  // namespace froth

int main(int argc, char** argv) { return froth::run(argc, argv); }
