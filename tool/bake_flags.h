// The knobs and options of a bake as flags of a command.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "baker/bake/bake.h"
#include "base/result.h"

namespace froth {

// Holds what was parsed; lives as long as the command.
class BakeFlags {
 public:
  void addTo(CLI::App& command);
  // For a foam of so many cells: the preset's knobs, changed by the flags that were given.
  Result<BakeOptions> options(uint32_t cells) const;
  uint32_t threads() const { return threads_; }  // 0: as many as there are

 private:
  template <class Number>
  void addKnob(CLI::App& command, const std::string& name, const std::string& description, const CLI::Validator& check,
               std::function<void(BakeKnobs&, Number)> apply);
  void takeEyes(const std::string& text);
  void addGeometryKnobs(CLI::App& command);
  void addColourKnobs(CLI::App& command);

  BakeOptions options_;
  uint32_t threads_ = 0;
  uint32_t chunkCells_ = 0;     // 0: not given
  std::optional<bool> levels_;  // none: by the number of cells
  bool noWalk_ = false, noSteiner_ = false, noMeasure_ = false;
  std::vector<std::function<void(BakeKnobs&)>> changes_;  // by the flags that were given
};

}  // namespace froth
