#include "samples/flythrough/residency_map.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include <imgui.h>

#include "samples/flythrough/level_colours.h"

namespace froth {
namespace {

double middleRadius(std::span<const FrothChunk> chunks) {
  std::vector<double> radii;
  for (const FrothChunk& chunk : chunks) radii.push_back(chunk.radius);
  const auto middle = radii.begin() + std::ssize(radii) / 2;
  std::nth_element(radii.begin(), middle, radii.end());
  return *middle;
}

// From the asset's axes to those of the picture, x right and y down.
class MapPlane {
 public:
  // `up` has length 1. The smaller half of the balls fits: chunks of the sky reach far.
  MapPlane(std::span<const FrothChunk> chunks, const glm::dvec3& up, const ImVec2& corner, float side) {
    const glm::dvec3 along = std::abs(up.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
    right_ = glm::normalize(along - glm::dot(along, up) * up);
    down_ = glm::cross(right_, up);
    glm::dvec2 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
    const double most = middleRadius(chunks);
    for (const FrothChunk& chunk : chunks) {
      if (chunk.radius > most) continue;
      const glm::dvec2 centre = flatten(centreOf(chunk));
      low = glm::min(low, centre - chunk.radius);
      high = glm::max(high, centre + chunk.radius);
    }
    const double extent = std::max(high.x - low.x, high.y - low.y);
    scale_ = extent > 0 ? side / extent : 1;
    const glm::dvec2 middle = (low + high) / 2.0;
    offset_ = glm::dvec2(corner.x, corner.y) + side / 2.0 - scale_ * middle;
  }

  static glm::dvec3 centreOf(const FrothChunk& chunk) { return {chunk.centre[0], chunk.centre[1], chunk.centre[2]}; }
  ImVec2 place(const glm::dvec3& point) const {
    const glm::dvec2 pixel = scale_ * flatten(point) + offset_;
    return {static_cast<float>(pixel.x), static_cast<float>(pixel.y)};
  }
  float length(double length) const { return static_cast<float>(scale_ * length); }

 private:
  glm::dvec2 flatten(const glm::dvec3& point) const { return {glm::dot(point, right_), glm::dot(point, down_)}; }

  glm::dvec3 right_, down_;
  glm::dvec2 offset_;
  double scale_;
};

ImU32 colourOf(const FrothChunk& chunk, float alpha) {
  const LevelColour& colour = colourOfLevel(chunk.level);
  return ImGui::ColorConvertFloat4ToU32({colour[0], colour[1], colour[2], alpha});
}

void drawChunk(ImDrawList& list, const MapPlane& plane, const FrothChunk& chunk) {
  constexpr float kShare = 0.5f;  // of the balls' radii: they overlap
  const ImVec2 centre = plane.place(MapPlane::centreOf(chunk));
  const float radius = std::max(plane.length(kShare * chunk.radius), 1.5f);
  if (chunk.state == FROTH_CHUNK_DRAWN) list.AddCircleFilled(centre, radius, colourOf(chunk, 0.35f));
  const bool isComing = chunk.state == FROTH_CHUNK_COMING;
  list.AddCircle(centre, radius, colourOf(chunk, isComing ? 0.5f : 0.9f), 0, isComing ? 1.0f : 2.0f);
}

void drawCamera(ImDrawList& list, const MapPlane& plane, const Pose& pose) {
  constexpr float kArrow = 18;  // [pixels]
  const ImU32 white = ImGui::ColorConvertFloat4ToU32({1, 1, 1, 1});
  const ImVec2 eye = plane.place(pose.eye), ahead = plane.place(pose.eye + pose.worldFromCamera * glm::dvec3(0, 0, 1));
  const float x = ahead.x - eye.x, y = ahead.y - eye.y, length = std::hypot(x, y);
  list.AddCircleFilled(eye, 4, white);
  if (length > 0) list.AddLine(eye, {eye.x + kArrow * x / length, eye.y + kArrow * y / length}, white, 2);
}

}  // namespace

void layOutMap(std::span<const FrothChunk> chunks, const MapCamera& camera) {
  constexpr float kSide = 280;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton("map", {kSide, kSide});
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const MapPlane plane(chunks, camera.up, corner, kSide);
  std::vector<const FrothChunk*> shown;  // the finest last, on top
  for (const FrothChunk& chunk : chunks) {
    const bool isOnDevice = chunk.state == FROTH_CHUNK_DRAWN || chunk.state == FROTH_CHUNK_RESIDENT;
    if (isOnDevice || chunk.state == FROTH_CHUNK_COMING) shown.push_back(&chunk);
  }
  std::ranges::stable_sort(shown, std::greater(), &FrothChunk::level);
  const ImVec2 opposite(corner.x + kSide, corner.y + kSide);
  list.PushClipRect(corner, opposite, true);
  for (const FrothChunk* chunk : shown) drawChunk(list, plane, *chunk);
  drawCamera(list, plane, camera.pose);
  list.PopClipRect();
  list.AddRect(corner, opposite, ImGui::GetColorU32(ImGuiCol_Border));
  ImGui::TextUnformatted("from above: discs drawn, rings kept, thin rings coming");
}

}  // namespace froth
