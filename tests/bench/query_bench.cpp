// froth_bench_queries ASSET: how long the queries of froth.h take on one and two threads. A null context: no GPU.
//
// Rays start anywhere in the box of the scene, in all directions; spheres of a hundredth of its diagonal rest on
// surfaces that such rays have hit. items_per_second counts queries, of all threads together.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "froth/froth_query.h"
#include "host/make_struct.h"

using froth::makeStruct;

namespace {

constexpr size_t kQueries = 1 << 14;
constexpr uint32_t kBatch = 64;

struct World {
  FrothContext* context = nullptr;
  FrothInstance instance{};
  FrothAssetStatus asset = makeStruct<FrothAssetStatus>();
  std::vector<FrothRay> rays;
  std::vector<FrothSphere> spheres;
};

void printMessage(void*, FrothSeverity, FrothResult, const char* object, const char* text) {
  std::fprintf(stderr, "%s: %s\n", object, text);
}

bool open(const char* path, World& world) {
  auto contextInfo = makeStruct<FrothContextInfo>();
  contextInfo.abiVersion = FROTH_ABI_VERSION;
  contextInfo.onMessage = printMessage;
  auto assetInfo = makeStruct<FrothAssetInfo>();
  assetInfo.path = path;
  assetInfo.layers = 2;
  assetInfo.keepForQueries = 1;
  auto instanceInfo = makeStruct<FrothInstanceInfo>();
  if (frothCreateContext(&contextInfo, &world.context) != FROTH_OK) return false;
  if (frothOpenAsset(world.context, &assetInfo, &instanceInfo.asset) != FROTH_OK) return false;
  auto frame = makeStruct<FrothFrame>();
  do {
    frame.completedSerial = frame.serial++;
    if (frothUpdate(world.context, &frame, nullptr) != FROTH_OK) return false;
    if (frothGetAssetStatus(world.context, instanceInfo.asset, &world.asset) != FROTH_OK) return false;
  } while (world.asset.state == FROTH_ASSET_OPENING);
  return world.asset.state == FROTH_ASSET_READY &&
         frothCreateInstance(world.context, &instanceInfo, &world.instance) == FROTH_OK;
}

void makeRays(World& world) {
  std::mt19937_64 engine(1);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(engine() >> 11) * 0x1p-53);
  };
  for (size_t i = 0; i < kQueries; ++i) {
    FrothRay ray{};
    const double z = uniform(-1, 1), turn = uniform(0, 2 * 3.14159265358979);
    const double direction[3] = {std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn), z};
    for (int axis = 0; axis < 3; ++axis) {
      ray.origin[axis] = uniform(double{world.asset.boundsMin[axis]}, double{world.asset.boundsMax[axis]});
      ray.direction[axis] = direction[axis];
    }
    world.rays.push_back(ray);
  }
}

bool makeSpheres(World& world) {
  double diagonal = 0;
  for (int axis = 0; axis < 3; ++axis) {
    diagonal += std::pow(double{world.asset.boundsMax[axis]} - double{world.asset.boundsMin[axis]}, 2);
  }
  std::vector<FrothRayHit> hits(kQueries);
  if (frothCastRays(world.context, nullptr, world.rays.data(), hits.data(), kQueries) != FROTH_OK) return false;
  double steps = 0, count = 0;
  for (const FrothRayHit& hit : hits) {
    steps += hit.steps;
    if (!std::isfinite(hit.distance)) continue;
    ++count;
    auto sphere = makeStruct<FrothSphere>();
    sphere.radius = 0.01 * std::sqrt(diagonal);
    for (int axis = 0; axis < 3; ++axis) {
      sphere.centre[axis] = hit.position[axis] + 0.9 * sphere.radius * double{hit.normal[axis]};
    }
    world.spheres.push_back(sphere);
  }
  std::printf("%u cells, %.1f host bytes per cell; %.1f steps per ray, %.0f %% of the rays hit\n",
              world.asset.cellCount, static_cast<double>(world.asset.hostBytes) / world.asset.cellCount,
              steps / kQueries, 100 * count / kQueries);
  return !world.spheres.empty();
}

// Each thread goes round the queries from a place of its own.
size_t startOf(const benchmark::State& state, size_t size) {
  return size / static_cast<size_t>(state.threads()) * static_cast<size_t>(state.thread_index());
}

void castRays(benchmark::State& state, const World& world, bool closestOnly) {
  auto info = makeStruct<FrothCastInfo>();
  info.closestOnly = closestOnly;
  FrothRayHit hits[kBatch];
  size_t first = startOf(state, kQueries) / kBatch * kBatch;
  for (auto _ : state) {
    frothCastRays(world.context, &info, &world.rays[first], hits, kBatch);
    benchmark::DoNotOptimize(hits);
    first = (first + kBatch) % kQueries;
  }
  state.SetItemsProcessed(state.iterations() * kBatch);
}

void locate(benchmark::State& state, const World& world) {
  auto location = makeStruct<FrothLocation>();
  size_t i = startOf(state, kQueries);
  for (auto _ : state) {
    frothLocate(world.context, world.instance, world.rays[i].origin, &location);
    benchmark::DoNotOptimize(location);
    i = (i + 1) % kQueries;
  }
  state.SetItemsProcessed(state.iterations());
}

void overlapSpheres(benchmark::State& state, const World& world) {
  auto contact = makeStruct<FrothContact>();
  size_t i = startOf(state, world.spheres.size());
  for (auto _ : state) {
    frothOverlapSphere(world.context, &world.spheres[i], &contact);
    benchmark::DoNotOptimize(contact);
    i = (i + 1) % world.spheres.size();
  }
  state.SetItemsProcessed(state.iterations());
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc != 2) return std::fprintf(stderr, "usage: froth_bench_queries ASSET\n"), 2;
  World world;
  if (!open(argv[1], world)) return 3;
  makeRays(world);
  if (!makeSpheres(world)) return std::fprintf(stderr, "%s: no ray is stopped\n", argv[1]), 3;
  const auto add = [&](const char* name, auto run) {
    benchmark::RegisterBenchmark(name, run)->ThreadRange(1, 2)->UseRealTime()->Unit(benchmark::kMicrosecond);
  };
  add("ray, closest only", [&](benchmark::State& state) { castRays(state, world, true); });
  add("ray, transmittance", [&](benchmark::State& state) { castRays(state, world, false); });
  add("locate", [&](benchmark::State& state) { locate(state, world); });
  add("sphere overlap", [&](benchmark::State& state) { overlapSpheres(state, world); });
  benchmark::RunSpecifiedBenchmarks();
  frothDestroyContext(world.context, UINT64_MAX);
  return 0;
}
