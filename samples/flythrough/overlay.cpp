#include "samples/flythrough/overlay.h"

#include <span>

#include <imgui.h>

#include "host/imgui_layer.h"

namespace froth {
namespace {

constexpr double kMebi = 1024.0 * 1024.0;

void layOutParts(const char* owner, uint64_t sum, std::span<const FrothMemory> parts) {
  const double bytes = static_cast<double>(sum);
  if (!ImGui::TreeNode(owner, "%s %.1f MiB", owner, bytes / kMebi)) return;
  for (const FrothMemory& part : parts) ImGui::Text("%8.2f  %s", static_cast<double>(part.bytes) / kMebi, part.name);
  ImGui::TreePop();
}

// Counts are zero unless asked for (--counters).
void layOutWork(const FrothWork& work, VkExtent2D extent) {
  if (work.ballHits == 0) return;
  const double rays = static_cast<double>(extent.width) * extent.height;
  const auto perRay = [&](uint64_t count) { return static_cast<double>(count) / rays; };
  ImGui::Text("per ray  %.2f balls, %.2f planes, %.2f heights, %.2f colours", perRay(work.ballHits),
              perRay(work.planes), perRay(work.heights), perRay(work.colours));
  ImGui::Text("         %.2f steps, %.2f neighbours", perRay(work.steps), perRay(work.neighbours));
}

void layOutWarnings(const FrothViewStatus& view) {
  if (view.bits & FROTH_VIEW_CELL_OVERFLOW) ImGui::TextUnformatted("cells overflowed: buffers grow");
  if (view.bits & FROTH_VIEW_PAIR_OVERFLOW) ImGui::TextUnformatted("pairs overflowed: buffers grow");
  if (view.bits & FROTH_VIEW_ENTRY_LIMIT) ImGui::TextUnformatted("tiles hit the limit of their lists");
  if (view.bits & FROTH_VIEW_STEP_LIMIT) ImGui::TextUnformatted("walks hit the step limit");
  if (view.bits & FROTH_VIEW_NO_WALK_GRAPH) ImGui::TextUnformatted("the asset has no walk graph");
}

}  // namespace

void Overlay::layOut(const OverlayContent& content, VkExtent2D extent) {
  ImGui::SetNextWindowPos(ImVec2(12, 12), ImGuiCond_FirstUseEver);
  ImGui::Begin("Froth", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::Text("%s, %s, %.1f frames/s", content.picture, content.camera, ImGui::GetIO().Framerate);
  if (content.scale < 1) ImGui::Text("drawn at %.2f of width and height", double{content.scale});
  if (content.asset.state == FROTH_ASSET_OPENING) {
    ImGui::Text("loading, %.1f MiB to go", static_cast<double>(content.frame.uploadBytesQueued) / kMebi);
  }
  if (!content.followed.empty()) ImGui::TextUnformatted(content.followed.c_str());
  history_.add(content.view.serial, {content.view.passes, content.view.passCount});
  layOutPassTimes(history_);
  ImGui::Separator();
  ImGui::Text("cells    %u drawn, %u live, %u in all", content.view.visibleCells, content.asset.liveCount,
              content.asset.cellCount);
  ImGui::Text("pairs    %llu", static_cast<unsigned long long>(content.view.pairs));
  layOutWork(content.view.work, extent);
  ImGui::Text("memory   device %.1f MiB, host %.1f MiB", static_cast<double>(content.frame.deviceBytes) / kMebi,
              static_cast<double>(content.frame.hostBytes) / kMebi);
  layOutParts("asset", content.asset.deviceBytes, {content.asset.memory, content.asset.memoryCount});
  layOutParts("view", content.view.deviceBytes, {content.view.memory, content.view.memoryCount});
  layOutWarnings(content.view);
  ImGui::Separator();
  ImGui::Text("1 raster  2 walk  3 difference x 32%s", content.hasLevels ? "  4 levels" : "");
  ImGui::TextUnformatted(
      "W A S D Q E fly, drag to look, wheel: speed\n"
      "P path or free flight  C screenshot\n"
      "H hide this  Esc quit");
  ImGui::End();
}

}  // namespace froth
