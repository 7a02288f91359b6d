// froth_bench_level_bake MODEL [options]: what levels of detail cost a bake, and what they are made of.
//
// For each level: chunks, live and other cells, ghosts, encoded bytes; what made the next one of it: groups, the share
// of locked cells, merges, merges undone. Then the stages of the bake.
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "baker/bake/bake.h"
#include "baker/input/foam_input.h"
#include "format/write/asset_writer.h"
#include "reference/camera/camera.h"

namespace froth {
namespace {

struct Options {
  std::string model, cameras, preset = "default", scratch = "froth_bench_level_bake.froth";
  uint32_t chunkCells = 8192;
  bool noSteiner = false;
};

template <class T>
T take(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

struct LevelSum {
  uint64_t chunks = 0, floorChunks = 0, live = 0, others = 0, ghosts = 0, bytes = 0;
};

// Encodes chunks as a file would hold them, and keeps their sizes alone.
class Encoder {
 public:
  explicit Encoder(const Options& options) : options_(options) {}

  ChunkSink sink() {
    ChunkSink sink;
    sink.begin = [this](const AssetContents& header) -> Status {
      header_ = header;
      writer_ = take(AssetStreamWriter::create(options_.scratch, header, WriteProtected::kReplace));
      return {};
    };
    sink.append = [this](std::vector<ChunkContents>&& batch) -> Status {
      for (const ChunkContents& chunk : batch) add(chunk);
      return {};
    };
    return sink;
  }

  const std::map<uint32_t, LevelSum>& levels() const { return levels_; }

 private:
  void add(const ChunkContents& chunk) {
    const ChunkLevel place = header_.levels.empty() ? ChunkLevel{} : header_.levels[count_];
    ++count_;
    LevelSum& sum = levels_[place.level];
    ++sum.chunks;
    sum.floorChunks += place.in == kNoGroup;
    sum.live += chunk.liveCount;
    sum.others += chunk.cellCount - chunk.liveCount;
    sum.ghosts += chunk.ghostCount;
    for (const StoredSection& section : take(writer_->encodeChunk(chunk)).sections) sum.bytes += section.stored.size();
  }

  const Options& options_;
  AssetContents header_;
  std::optional<AssetStreamWriter> writer_;
  size_t count_ = 0;
  std::map<uint32_t, LevelSum> levels_;
};

double share(uint64_t part, uint64_t whole) {
  return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0;
}

void print(const Encoder& encoder, const BakeResult& baked) {
  fmt::print(
      "level chunks (floor)     live   others   ghosts        bytes  groups failed  locked %   merges  undone % "
      "rounds\n");
  uint64_t above = 0, finest = 0;
  for (const auto& [level, sum] : encoder.levels()) {
    (level == 0 ? finest : above) += sum.bytes;
    fmt::print("{:5} {:6} {:7} {:8} {:8} {:8} {:12}", level, sum.chunks, sum.floorChunks, sum.live, sum.others,
               sum.ghosts, sum.bytes);
    if (level < baked.levels.size()) {
      const LevelReport& made = baked.levels[level];
      fmt::print(" {:7} {:6} {:9.1f} {:8} {:9.1f} {:6}", made.groups, made.failed, share(made.locked, made.live),
                 made.merges, share(made.undone, made.merges + made.undone), made.rounds);
    }
    fmt::print("\n");
  }
  fmt::print("levels above 0: {:.2f} x the bytes of level 0\n",
             static_cast<double>(above) / static_cast<double>(finest));
  for (const StageReport& stage : baked.stages) {
    fmt::print("{:<20} {:9.2f} s {:10} items {:9.1f} MiB at most\n", stage.stage, stage.seconds, stage.items,
               static_cast<double>(stage.peakBytes) / (1 << 20));
  }
}

void run(const Options& options) {
  const FoamInput input = take(loadFoam(options.model, {}));
  CameraSet cameras;
  BakeOptions bake;
  bake.preset = options.preset;
  bake.knobs = take(presetKnobs(options.preset));
  bake.chunkCells = options.chunkCells;
  bake.steiner = !options.noSteiner;
  bake.measure = false;
  bake.levels = true;
  if (!options.cameras.empty()) {
    cameras = take(readCameras(options.cameras));
    bake.cameras = &cameras;
  }
  Encoder encoder(options);
  print(encoder, take(bakeFoam(input.foam, bake, encoder.sink())));
}

}  // namespace
}  // namespace froth

int main(int argc, char** argv) {
  froth::Options options;
  CLI::App program("Bakes a foam with levels of detail and prints what they are made of");
  program.add_option("MODEL", options.model)->required();
  program.add_option("--cameras", options.cameras);
  program.add_option("--preset", options.preset);
  program.add_option("--chunk-cells", options.chunkCells);
  program.add_option("--scratch", options.scratch, "Beside this file temporaries lie while it runs");
  program.add_flag("--no-steiner", options.noSteiner);
  CLI11_PARSE(program, argc, argv);
  try {
    froth::run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
