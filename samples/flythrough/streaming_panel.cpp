#include "samples/flythrough/streaming_panel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <imgui.h>

#include "samples/flythrough/level_colours.h"

namespace froth {
namespace {

constexpr double kMebi = 1024.0 * 1024.0;

double mebibytes(uint64_t bytes) { return static_cast<double>(bytes) / kMebi; }

struct LevelRow {
  uint32_t chunks = 0, drawn = 0, resident = 0, coming = 0, failed = 0;
};

std::vector<LevelRow> countByLevel(const std::vector<FrothChunk>& chunks) {
  std::vector<LevelRow> rows;
  for (const FrothChunk& chunk : chunks) {
    if (chunk.level >= rows.size()) rows.resize(chunk.level + 1);
    LevelRow& row = rows[chunk.level];
    ++row.chunks;
    row.drawn += chunk.state == FROTH_CHUNK_DRAWN;
    row.resident += chunk.state == FROTH_CHUNK_RESIDENT;
    row.coming += chunk.state == FROTH_CHUNK_COMING;
    row.failed += chunk.state == FROTH_CHUNK_FAILED;
  }
  return rows;
}

void layOutLevels(const std::vector<FrothChunk>& chunks) {
  constexpr std::array kColumns = {"level", "drawn", "kept", "coming", "failed", "in all"};
  if (!ImGui::BeginTable("levels", static_cast<int>(kColumns.size()), ImGuiTableFlags_SizingFixedFit)) return;
  for (const char* column : kColumns) ImGui::TableSetupColumn(column);
  ImGui::TableHeadersRow();
  const std::vector<LevelRow> rows = countByLevel(chunks);
  for (uint32_t level = 0; level < rows.size(); ++level) {
    const LevelColour& colour = colourOfLevel(level);
    ImGui::TableNextColumn();
    ImGui::TextColored({colour[0], colour[1], colour[2], 1}, "%u", level);
    const LevelRow& row = rows[level];
    for (const uint32_t count : {row.drawn, row.resident, row.coming, row.failed, row.chunks}) {
      ImGui::TableNextColumn();
      ImGui::Text("%u", count);
    }
  }
  ImGui::EndTable();
}

void layOutStatus(const FrothStreamStatus& status, bool hasBudget) {
  ImGui::TextUnformatted(status.isSettled ? "settled: what is wanted is drawn" : "coming: coarser levels stand in");
  if (status.oldestRequest > 0) ImGui::Text("waiting for %u frames", status.oldestRequest);
  ImGui::Text("chunks   %.1f MiB", mebibytes(status.usedBytes));
  if (hasBudget) {
    ImGui::SameLine(0, 0);
    ImGui::Text(" of %.1f", mebibytes(status.budgetBytes));
  }
  if (status.excessBytes > 0) ImGui::Text("         %.1f MiB above the budget", mebibytes(status.excessBytes));
  ImGui::Text("since the start  %llu evictions, %llu retries, %llu failures",
              static_cast<unsigned long long>(status.evictions), static_cast<unsigned long long>(status.retries),
              static_cast<unsigned long long>(status.failures));
  if (status.floorHits > 0) ImGui::Text("%u chunks of the floor where finer ones are wanted", status.floorHits);
}

// Up to where nothing is left out: chunks get half of what else is free.
uint64_t enoughFor(const std::vector<FrothChunk>& chunks) {
  uint64_t bytes = 0;
  for (const FrothChunk& chunk : chunks) bytes += chunk.deviceBytes;
  constexpr uint64_t kForOthers = uint64_t{1} << 30;
  return 4 * bytes + kForOthers;
}

bool layOutSettings(const std::vector<FrothChunk>& chunks, StreamSettings& settings) {
  constexpr float kLeastBudget = 16;  // [MiB]
  constexpr float kLeastDetail = 0.125f, kMostDetail = 8;
  const float mostBudget = static_cast<float>(mebibytes(enoughFor(chunks)));
  float budget = settings.budget == 0 ? mostBudget : static_cast<float>(mebibytes(settings.budget));
  bool isChanged = false;
  const char* const format = settings.budget == 0 ? "no limit" : "%.0f MiB";
  if (ImGui::SliderFloat("budget", &budget, kLeastBudget, mostBudget, format, ImGuiSliderFlags_Logarithmic)) {
    settings.budget = budget < mostBudget ? static_cast<uint64_t>(std::llround(double{budget} * kMebi)) : 0;
    isChanged = true;
  }
  ImGui::BeginDisabled(settings.isFrozen);  // it says what is wanted
  isChanged |= ImGui::SliderFloat("detail", &settings.detail, kLeastDetail, kMostDetail, "%.2f",
                                  ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
  ImGui::EndDisabled();
  isChanged |= ImGui::Checkbox("freeze what is wanted", &settings.isFrozen);
  return isChanged;
}

}  // namespace

bool layOutStreaming(const StreamFigures& figures, const MapCamera& camera, StreamSettings& settings) {
  constexpr float kMargin = 12;
  ImGui::SetNextWindowPos({ImGui::GetIO().DisplaySize.x - kMargin, kMargin}, ImGuiCond_FirstUseEver, {1, 0});
  ImGui::Begin("Streaming", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
  layOutStatus(figures.status, settings.budget > 0);
  layOutLevels(figures.chunks);
  ImGui::Separator();
  const bool isChanged = layOutSettings(figures.chunks, settings);
  ImGui::Separator();
  layOutMap(figures.chunks, camera);
  ImGui::End();
  return isChanged;
}

}  // namespace froth
