// Where the bytes of an asset are.
#include <array>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "format/section.h"
#include "tool/statistics.h"

namespace froth {
namespace {

struct SectionSum {
  uint64_t count = 0, storedBytes = 0, rawBytes = 0;

  void add(const SectionRecord& record) {
    ++count;
    storedBytes += record.storedSize;
    rawBytes += record.rawSize;
  }
};

constexpr size_t kLayers = 3;
constexpr std::array<const char*, kLayers> kLayerNames = {"geometry", "details", "view dependence"};

struct SectionSums {
  std::map<uint32_t, SectionSum> types;
  std::array<SectionSum, kLayers> layers;
  SectionSum all;
  double cells = 0;
};

SectionSums sumSections(const AssetReader& asset) {
  SectionSums sums;
  for (const SectionRecord& record : asset.sections()) {
    sums.types[record.type].add(record);
    sums.layers[static_cast<size_t>(sectionLayer(static_cast<SectionType>(record.type)))].add(record);
    sums.all.add(record);
  }
  for (const ChunkContents& chunk : asset.manifest().chunks) sums.cells += chunk.cellCount;
  return sums;
}

std::string nameOf(uint32_t type) {
  const char* name = sectionName(type);
  return name ? name : fmt::format("type {}", type);
}

}  // namespace

void printSections(const AssetReader& asset) {
  const SectionSums sums = sumSections(asset);
  const auto print = [&](const std::string& name, const SectionSum& sum) {
    fmt::print("{:<22} {:>9} {:>12} {:>12} {:>11.2f} {:>8.2f}\n", name, sum.count, sum.rawBytes, sum.storedBytes,
               static_cast<double>(sum.storedBytes) / sums.cells,
               100.0 * static_cast<double>(sum.storedBytes) / static_cast<double>(sums.all.storedBytes));
  };
  fmt::print("{:<22} {:>9} {:>12} {:>12} {:>11} {:>8}\n", "section", "count", "raw bytes", "bytes", "bytes/cell", "%");
  for (const auto& [type, sum] : sums.types) print(nameOf(type), sum);
  for (size_t layer = 0; layer < kLayers; ++layer) {
    print(fmt::format("layer {}: {}", layer, kLayerNames[layer]), sums.layers[layer]);
  }
  print("all", sums.all);
}

nlohmann::ordered_json sectionsAsJson(const AssetReader& asset) {
  const SectionSums sums = sumSections(asset);
  const auto entry = [&](const SectionSum& sum) -> nlohmann::ordered_json {
    return {{"count", sum.count},
            {"rawBytes", sum.rawBytes},
            {"bytes", sum.storedBytes},
            {"bytesPerCell", static_cast<double>(sum.storedBytes) / sums.cells}};
  };
  nlohmann::ordered_json types = nlohmann::ordered_json::object(), layers = nlohmann::ordered_json::array();
  for (const auto& [type, sum] : sums.types) types[nameOf(type)] = entry(sum);
  for (const SectionSum& layer : sums.layers) layers.push_back(entry(layer));
  return {{"types", types}, {"layers", layers}, {"all", entry(sums.all)}};
}

}  // namespace froth
