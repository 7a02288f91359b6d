// froth_mirror_room: a foam among meshes, in a window or headless.
#include <CLI/CLI.hpp>

#include "host/ray_preparation.h"
#include "samples/mirror_room/headless.h"
#include "samples/mirror_room/options.h"
#include "samples/mirror_room/window.h"

int main(int argc, char** argv) {
  froth::MirrorRoomOptions options;
  std::vector<double> picked;
  bool hasNoParticles = false;
  std::string prepared = "radiance";
  CLI::App program{"Shows a .froth asset in a room of meshes: mirrors, shadows, picking, a bouncing ball."};
  program.add_option("ASSET", options.asset, "A .froth file, baked with its walk graph")->required();
  program.add_option("--room", options.room, "A glTF file with the meshes (meshes/make_room.py)")
      ->capture_default_str();
  program
      .add_option("--shadow-catching", options.look.shadowCatching,
                  "How much of their shadow meshes cast on the foam, 0 to 1")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
  program.add_option("--ray-step", options.look.rayStep, "2: one pixel in four casts rays from meshes")
      ->capture_default_str()
      ->check(CLI::Range(1u, 2u));
  program.add_flag("--base-colours", options.look.hasBaseColours, "Reflections of the foam without view dependence");
  program.add_flag("--no-particles", hasNoParticles, "Without the motes in the foam");
  program.add_option("--prepare-rays", prepared, "What is kept in device memory for rays")
      ->capture_default_str()
      ->check(CLI::IsMember(&froth::kRayPreparations));
  froth::addRunOptions(program, options);
  CLI::Option* headless = program.get_option("--headless");
  program.add_option("--json", options.json, "Headless: file for the GPU times by pass")->needs(headless);
  program.add_option("--pick", picked, "Headless: tell what pixel X,Y of the last frame shows")
      ->expected(2)
      ->delimiter(',')
      ->type_name("X,Y")
      ->needs(headless);
  return froth::runProgram("froth_mirror_room", program, argc, argv, [&] {
    options.hasParticles = !hasNoParticles;
    options.prepareRays = froth::kRayPreparations.at(prepared);
    if (!picked.empty()) options.picked = glm::dvec2(picked[0], picked[1]);
    return options.isHeadless ? froth::showHeadless(options) : froth::showInWindow(options);
  });
}
