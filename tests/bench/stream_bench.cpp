// froth_bench_stream: processor time of ChunkStreamer::update, with many chunks known and a few thousand resident. An
// eye and a stream point ahead of it fly on a straight line; reads take some frames, none fails.
//
// Arguments: chunks known; budget above the floor in thousandths of all bytes. `resident` and `wanted`: chunks and
// groups at the end.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "tests/stream/level_dag.h"
#include "tests/stream/simulated_owner.h"

namespace {

using namespace froth;
using namespace froth::test;

constexpr uint32_t kFramesBefore = 1500;

StreamEye makeFlyer(double extent) {
  StreamEye eye;
  eye.position = {0.1 * extent, 0.5 * extent, 0.2};
  eye.pixelAngle = 1e-3;
  eye.pixelSize = 1e-4;
  return eye;
}

void flyOver(benchmark::State& state) {
  const LevelDag dag = makeLevelDag(1, {static_cast<uint32_t>(state.range(0) / 2), 64, 8});
  const LevelGraph graph = dag.graph();
  uint64_t allBytes = 0;
  for (const uint64_t bytes : dag.bytes) allBytes += bytes;

  SimulatedOwner owner({.mostDelay = 1, .failureShare = 0, .readsInFlight = 64, .stream = {}, .checksCuts = false});
  owner.setBudget(graph.floorBytes() + allBytes * static_cast<uint64_t>(state.range(1)) / 1000);
  const uint32_t asset = owner.addAsset(graph);
  if (!owner.streamer.placeAsset(asset)) return state.SkipWithError("the floor does not fit");
  StreamEye eye = makeFlyer(dag.extent), ahead = eye;
  const auto fly = [&] {
    eye.position.x += 1e-4 * dag.extent;
    ahead.position = eye.position + glm::dvec3(0.05 * dag.extent, 0, 0);
    ahead.detail = 0.5;
    owner.streamer.setEyes(asset, std::vector{eye, ahead});
  };
  for (uint32_t i = 0; i < kFramesBefore; ++i) {
    fly();
    owner.runFrame();
  }
  double longest = 0;
  for (auto _ : state) {
    fly();
    owner.runFrame();
    state.SetIterationTime(owner.updateSeconds());
    longest = std::max(longest, owner.updateSeconds());
  }
  const StreamStatistics statistics = owner.streamer.statistics();
  state.counters["known"] = graph.chunkCount();
  state.counters["resident"] =
      static_cast<double>(statistics.states[static_cast<size_t>(ChunkState::kResident)].chunks);
  state.counters["wanted"] = static_cast<double>(owner.streamer.wanted(asset).members().size());
  state.counters["longest_us"] = longest * 1e6;
}

BENCHMARK(flyOver)
    ->Args({100'000, 20})
    ->Args({100'000, 50})
    ->Args({1'000'000, 2})
    ->Args({1'000'000, 5})
    ->UseManualTime()
    ->Iterations(3000)
    ->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
