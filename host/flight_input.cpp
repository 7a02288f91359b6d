#include "host/flight_input.h"

#include <cmath>

#include <GLFW/glfw3.h>
#include <imgui.h>

namespace froth {

FlyInput flightInput(double seconds) {
  constexpr double kRadiansPerPixel = 0.003;  // of a drag
  const ImGuiIO& io = ImGui::GetIO();
  const auto axis = [](int positive, int negative) {
    return static_cast<double>(ImGui::IsKeyDown(positive)) - static_cast<double>(ImGui::IsKeyDown(negative));
  };
  FlyInput input;
  input.seconds = seconds;
  input.move = {axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_Q, GLFW_KEY_E), axis(GLFW_KEY_W, GLFW_KEY_S)};
  if (ImGui::IsMouseDown(ImGuiMouseButton_Left) && !io.WantCaptureMouse) {
    input.turn = kRadiansPerPixel * glm::dvec2(io.MouseDelta.x, io.MouseDelta.y);
  }
  return input;
}

double flightSpeedChange() {
  const ImGuiIO& io = ImGui::GetIO();
  return io.WantCaptureMouse ? 1.0 : std::pow(1.2, io.MouseWheel);
}

}  // namespace froth
