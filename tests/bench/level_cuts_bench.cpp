// froth_bench_level_cuts ASSET CAMERAS: how the cuts that a reader draws look, by `detail`.
//
// For each detail and view: the groups that are refined when the view is drawn at its own size (docs/STREAMING.md), the
// cells of that cut, and its PSNR against level 0, by the float reference at about --pixels. Views are those of the
// flight path; --views takes the test views. --levels: the same of whole levels.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "baker/bake/bake.h"
#include "baker/lod/cut.h"
#include "baker/lod/shrink_view.h"
#include "base/image/mean_square.h"
#include "format/group_bounds.h"
#include "format/read/asset_reader.h"
#include "reference/camera/view_rays.h"
#include "reference/render/reference.h"

namespace froth {
namespace {

struct Options {
  std::string asset, cameras;
  std::vector<double> details{0.25, 0.5, 1, 2, 4};
  std::vector<uint32_t> levels;
  uint32_t pixels = 20'000, every = 1;
  bool testViews = false;
};

template <class T>
T take(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

class CutsBench {
 public:
  explicit CutsBench(const Options& options)
      : options_(options), contents_(take(readAsset(options.asset))), finestFoam_(take(foamFromAsset(contents_))) {
    const CameraSet cameras = take(readCameras(options.cameras));
    const std::vector<View>& all = options.testViews || cameras.flight.empty() ? cameras.views : cameras.flight;
    for (size_t v = 0; v < all.size(); v += options.every) views_.push_back(all[v]);
    const ReferenceRenderer renderer(finestFoam_);
    for (const View& view : views_) finest_.push_back(draw(renderer, view));
  }

  void run() const {
    for (const double detail : options_.details) {
      compare(fmt::format("detail {}", detail), [&](const View& view) { return refinedAt(view, detail); });
    }
    for (const uint32_t level : options_.levels) {
      std::vector<uint8_t> isRefined;
      for (const LevelGroup& group : contents_.groups) isRefined.push_back(group.level >= level);
      compare(fmt::format("level {}", level), [&](const View&) { return isRefined; });
    }
  }

 private:
  void compare(const std::string& name, const auto& refinedIn) const {
    double sum = 0, worst = 0, cells = 0;
    std::string each;
    for (size_t v = 0; v < views_.size(); ++v) {
      const AssetContents cut = take(contentsOfCut(contents_, refinedIn(views_[v])));
      for (const ChunkContents& chunk : cut.chunks) cells += chunk.liveCount;
      const Foam foam = take(foamFromAsset(cut));
      const double square = meanSquare(finest_[v], draw(ReferenceRenderer(foam), views_[v]));
      sum += square;
      worst = std::max(worst, square);
      each += fmt::format(" {:.1f}", decibels(square));
    }
    const auto count = static_cast<double>(views_.size());
    fmt::print("{}: {:.0f} cells, all {:.2f} dB, worst {:.2f} dB; each{}\n", name, cells / count, decibels(sum / count),
               decibels(worst), each);
    std::fflush(stdout);
  }

  std::vector<uint8_t> refinedAt(const View& view, double detail) const {
    std::vector<uint8_t> isRefined;
    for (size_t g = 0; g < bounds_.size(); ++g) {
      const double nearest = distanceTo(bounds_[g], eyeOf(view));
      isRefined.push_back(contents_.groups[g].error * detail >= nearest / view.fx);
    }
    return isRefined;
  }

  Image draw(const ReferenceRenderer& renderer, const View& view) const {
    ReferenceOptions reference;
    reference.precision = Precision::kFloat;
    reference.cutoff = 1e-3;
    reference.nearRatio = view.nearRatio.value_or(double{contents_.nearRatio});
    reference.nearDepth = view.nearDepth.value_or(double{contents_.nearDepth});
    return take(renderer.render(shrinkView(view, options_.pixels), reference)).colour;
  }

  const Options& options_;
  const AssetContents contents_;
  const std::vector<GroupBounds> bounds_ = boundGroups(contents_);
  const Foam finestFoam_;
  std::vector<View> views_;
  std::vector<Image> finest_;
};

}  // namespace
}  // namespace froth

int main(int argc, char** argv) {
  froth::Options options;
  CLI::App program("How the cuts that a reader draws look");
  program.add_option("ASSET", options.asset)->required();
  program.add_option("CAMERAS", options.cameras)->required();
  program.add_option("--details", options.details);
  program.add_option("--levels", options.levels, "whole levels");
  program.add_option("--pixels", options.pixels, "of an image, about");
  program.add_option("--every", options.every, "Take every so many views");
  program.add_flag("--views", options.testViews, "The test views instead of the flight path");
  CLI11_PARSE(program, argc, argv);
  try {
    froth::CutsBench(options).run();
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
