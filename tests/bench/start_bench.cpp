// What the start of an application pays for pipelines: froth_bench_start CACHE ASSET...
//
// Makes a context and the pipelines of all assets, several instances included, with a VkPipelineCache that has the
// bytes of the file CACHE, if it is there, and writes them back. Run it twice: the second run is an application's
// second start. The driver has a cache of its own; it is off with __GL_SHADER_DISK_CACHE=0 (NVIDIA) or
// MESA_SHADER_CACHE_DISABLE=1.
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>

#include "froth/froth_precompile.h"
#include "host/host.h"
#include "host/make_struct.h"
#include "tests/bench/bench_calls.h"

using namespace froth;

namespace {

std::vector<char> readBytes(const char* path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

VkPipelineCache createCache(const Host& host, const std::vector<char>& bytes) {
  VkPipelineCacheCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO;
  info.initialDataSize = bytes.size();
  info.pInitialData = bytes.data();
  VkPipelineCache cache = VK_NULL_HANDLE;
  require(vkCreatePipelineCache(host.device, &info, nullptr, &cache) == VK_SUCCESS, "vkCreatePipelineCache");
  return cache;
}

void writeCache(const Host& host, VkPipelineCache cache, const char* path) {
  size_t size = 0;
  vkGetPipelineCacheData(host.device, cache, &size, nullptr);
  std::vector<char> bytes(size);
  vkGetPipelineCacheData(host.device, cache, &size, bytes.data());
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(size));
}

template <class Call>
void time(const char* name, const Call& call) {
  const auto begin = std::chrono::steady_clock::now();
  check(call(), name);
  const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
  std::printf("  %-18s %9.3f ms\n", name, taken.count());
}

}  // namespace

int main(int argc, char** argv) {
  require(argc >= 3, "froth_bench_start CACHE ASSET...");
  const std::unique_ptr<Host> host = take(Host::create({}));
  const std::vector<char> bytes = readBytes(argv[1]);
  std::printf("%s, cache of %zu bytes\n", host->info.name.c_str(), bytes.size());
  FrothContextInfo info = host->contextInfo();
  info.pipelineCache = createCache(*host, bytes);
  info.walkShaders = 1;
  FrothContext* context = nullptr;
  time("frothCreateContext", [&] { return frothCreateContext(&info, &context); });
  std::vector<FrothVariant> variants;
  for (int i = 2; i < argc; ++i) {
    auto asset = makeStruct<FrothAssetInfo>();
    asset.path = argv[i];
    time("frothReadVariant", [&] { return frothReadVariant(context, &asset, &variants.emplace_back()); });
  }
  auto precompile = makeStruct<FrothPrecompileInfo>();
  precompile.variantCount = static_cast<uint32_t>(variants.size());
  precompile.variants = variants.data();
  precompile.severalInstances = 1;
  time("frothPrecompile", [&] { return frothPrecompile(context, &precompile); });
  writeCache(*host, info.pipelineCache, argv[1]);
  check(frothDestroyContext(context, UINT64_MAX), "frothDestroyContext");
  vkDestroyPipelineCache(host->device, info.pipelineCache, nullptr);
}
