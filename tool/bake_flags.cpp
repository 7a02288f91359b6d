#include "tool/bake_flags.h"

#include <bit>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "format/limits.h"
#include "tool/eyes_option.h"
#include "tool/options.h"

namespace froth {
namespace {

// Small enough to choose from, large enough that most of a group of four lies away from its border.
constexpr uint32_t kLevelChunkCells = 8192;
// From here on a reader that loads all cells before it shows one takes seconds.
constexpr uint32_t kManyCells = 500'000;

// A lattice step: 0 or a power of two.
CLI::Validator stepUpTo(float most) {
  const auto check = [most](const std::string& text) -> std::string {
    std::string range = numberBetween(0, most)(const_cast<std::string&>(text));
    if (!range.empty()) return range;
    int exponent = 0;
    const float step = std::stof(text);
    if (step == 0 || std::frexp(step, &exponent) == 0.5f) return {};
    return fmt::format("found '{}'; give a power of two, as 0.015625", text);
  };
  return {check, ""};
}

}  // namespace

void BakeFlags::takeEyes(const std::string& text) {
  const Result<EyeChoice> eyes = parseEyes(text);
  if (!eyes) throw CLI::ValidationError("--eyes", eyes.error().message);
  options_.eyes = *eyes;
}

template <class Number>
void BakeFlags::addKnob(CLI::App& command, const std::string& name, const std::string& description,
                        const CLI::Validator& check, std::function<void(BakeKnobs&, Number)> apply) {
  const auto keep = [this, apply](const Number& value) {
    changes_.push_back([apply, value](BakeKnobs& knobs) { apply(knobs, value); });
  };
  command.add_option_function<Number>(name, keep, description)->check(check)->group("Knobs of the preset");
}

void BakeFlags::addGeometryKnobs(CLI::App& command) {
  const auto add = [&](const char* name, const char* description, uint64_t least, uint64_t most,
                       uint32_t BakeKnobs::*knob) {
    addKnob<uint32_t>(command, name, description, countBetween(least, most),
                      [knob](BakeKnobs& knobs, uint32_t value) { knobs.*knob = value; });
  };
  add("--position-bits", "Of the scene's largest extent [bits, 10..22]; 0: float32", 0, 22, &BakeKnobs::positionBits);
  add("--radius-bits", "Of a radius' mantissa [bits, 4..23]", 4, 23, &BakeKnobs::radiusBits);
  add("--density-bits", "Of a density's mantissa [bits, 1..23]", 1, 23, &BakeKnobs::densityBits);
  add("--frame-bits", "Per axis of the octahedral normal [bits, 4..15]; 0: quaternions", 0, 15, &BakeKnobs::frameBits);
  add("--detail-site-bits", "Of a detail site, below one radius [bits, 1..16]; 0: float32", 0, 16,
      &BakeKnobs::detailSiteBits);
  add("--height-bits", "Of a height, below one radius [bits, 1..16]; 0: float32", 0, 16, &BakeKnobs::heightBits);
}

void BakeFlags::addColourKnobs(CLI::App& command) {
  const auto add = [&]<class Number>(const char* name, const char* description, const CLI::Validator& check,
                                     Number AppearanceOptions::*knob) {
    addKnob<Number>(command, name, description, check, [knob](BakeKnobs& knobs, Number value) {
      knobs.compressColours = true;
      knobs.appearance.*knob = value;
    });
  };
  add("--error-bound", "RMS error that a lobe must take away to be kept [display-coded, 0..1]", numberBetween(0, 1),
      &AppearanceOptions::errorBound);
  add("--lobes", "Most lobes kept per detail site [0..32]", countBetween(0, 32), &AppearanceOptions::lobeLimit);
  add("--codebook", "Entries of the codebook of lobe axes [0..65536]; 0: none", countBetween(0, 65536),
      &AppearanceOptions::codebookSize);
  add("--colour-step", "Lattice of colours [display-coded, power of two, 0..1]", stepUpTo(1),
      &AppearanceOptions::colourStep);
  add("--lobe-axis-step", "Lattice of lobe axes [power of two, 0..16]", stepUpTo(16), &AppearanceOptions::lobeAxisStep);
}

void BakeFlags::addTo(CLI::App& command) {
  options_.preset = "default";
  command.add_option("--preset", options_.preset, "How exactly values are kept; exact: every bit of the checkpoint")
      ->capture_default_str()
      ->check(CLI::IsMember({"exact", "high", "default", "small"}));
  addGeometryKnobs(command);
  addColourKnobs(command);
  command.add_option("--near-ratio", options_.nearRatio, "Default: skip cells nearer than this many radii; 0: none")
      ->capture_default_str()
      ->check(numberBetween(0, kMaxNearRatio));
  command
      .add_option("--near-depth", options_.nearDepth,
                  "Default: skip cells nearer than this depth [scene units]; 0: none")
      ->capture_default_str()
      ->check(numberBetween(0, kMaxNumber));
  command.add_flag("--no-walk", noWalk_, "No graph for walks: the asset can only be rasterized");
  command.add_flag("--no-steiner", noSteiner_, "No cells in empty space, which shorten walks");
  command.add_flag_function(
      "--lod,!--no-lod", [this](int64_t count) { levels_ = count > 0; },
      "Levels of detail, for scenes larger than memory; default: from 500,000 cells on");
  command.add_flag("--no-measure", noMeasure_, "No PSNR on sample views");
  command
      .add_option_function<std::string>(
          "--eyes", [this](const std::string& text) { takeEyes(text); },
          "Eyes to bake for: cameras, cameras+R (all within R of one [scene units]) or box:X0,Y0,Z0,X1,Y1,Z1")
      ->default_str("cameras");
  command
      .add_option("--cull-unseen", options_.cullUnseen,
                  "Drop cells of which no view sees more [opacity, 0..1]; needs --cameras; 0: none")
      ->check(numberBetween(0, 1));
  command
      .add_option("--memory-limit", options_.memoryLimit,
                  "Of the triangulation beside the input [bytes, or with KB, MB, GB]; works in pieces; 0: none")
      ->transform(CLI::AsSizeValue(false));
  command
      .add_option("--chunk-cells", chunkCells_, "Most live cells of a chunk [1..1048576]; default: 16384, --lod 8192")
      ->check(countBetween(1, 1 << 20));
  command.add_option("--seed", options_.seed, "Of Steiner cells, codebook and checks")
      ->capture_default_str()
      ->check(countBetween(0, std::numeric_limits<uint32_t>::max()));
  command.add_option("--threads", threads_, "Threads [1..1024]; default: one per core; the result is the same")
      ->check(countBetween(1, 1024));
}

Result<BakeOptions> BakeFlags::options(uint32_t cells) const {
  const Result<BakeKnobs> knobs = presetKnobs(options_.preset);
  if (!knobs) return knobs.error();
  BakeOptions options = options_;
  options.knobs = *knobs;
  for (const auto& change : changes_) change(options.knobs);
  options.walkGraph = !noWalk_;
  options.levels = levels_.value_or(cells >= kManyCells && options.walkGraph);
  if (options.levels) options.chunkCells = kLevelChunkCells;
  if (chunkCells_ > 0) options.chunkCells = chunkCells_;
  options.steiner = !noSteiner_;
  options.measure = !noMeasure_;
  return options;
}

}  // namespace froth
