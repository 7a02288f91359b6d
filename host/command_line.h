// What the command lines of the samples share.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "host/host.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace froth {

struct RunOptions {
  VkExtent2D extent{1280, 720};
  std::string device;            // index or part of a name; empty: the first suitable one
  bool validate = false;         // validation layers; a message fails the run
  uint32_t frames = 0;           // end after so many; 0: until the window is closed
  std::filesystem::path output;  // folder of frames and screenshots

  bool isHeadless = false;
  std::filesystem::path compare;  // empty, or the picture that the last frame must resemble
  double minPsnr = 40;            // [dB]
};

// What these write into outlives the program's parsing.
CLI::Option* addSizeOption(CLI::App& program, const char* name, VkExtent2D& extent, const char* description);
void addRunOptions(CLI::App& program, RunOptions& options);

// Parses, runs, and tells what failed as `name`. Exit codes: 0 well, 1 failed, 2 wrong arguments, 3 bad input.
int runProgram(const char* name, CLI::App& program, int argc, char** argv, const std::function<Status()>& run);

}  // namespace froth
