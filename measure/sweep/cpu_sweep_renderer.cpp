#include <chrono>
#include <optional>
#include <utility>

#include "baker/input/foam_input.h"
#include "base/progress_printer.h"
#include "measure/sweep/drawing.h"

namespace froth {
namespace {

// The reference renderer in float, on all cores.
class CpuSweepRenderer : public SweepRenderer {
 public:
  std::string device() const override { return "CPU"; }
  std::string driver() const override { return "reference renderer, float"; }

  Result<std::vector<RenderedImages>> render(const Draw& draw, const Progress& progress) override {
    if (Status loaded = load(draw, progress); !loaded) return loaded.error();
    std::vector<RenderedImages> images;
    for (const View& view : draw.views) {
      Result<RenderedImages> image = drawView(draw, view, progress);
      if (!image) return image.error();
      images.push_back(std::move(*image));
    }
    return images;
  }

  Result<std::vector<DrawTimes>> time(const std::vector<Draw>& draws, const Rounds& rounds,
                                      const Progress& progress) override {
    std::vector<std::vector<double>> cycles(draws.size());
    for (uint32_t round = 0; round < rounds.count; ++round) {
      size_t done = round * draws.size();
      for (const size_t i : orderOf(draws, rounds, round)) {
        if (!report(progress, "time", done++, rounds.count * draws.size())) return stoppedError();
        if (Status loaded = load(draws[i], progress); !loaded) return loaded.error();
        const uint32_t count = cyclesOf(draws[i], rounds);
        for (uint32_t cycle = 0; cycle < count; ++cycle) {
          const auto start = std::chrono::steady_clock::now();
          for (const View& view : draws[i].views) {
            if (const Result<RenderedImages> image = drawView(draws[i], view, {}); !image) return image.error();
          }
          const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
          cycles[i].push_back(spent.count() / static_cast<double>(draws[i].views.size()));
        }
      }
    }
    std::vector<DrawTimes> times;
    for (const std::vector<double>& one : cycles) times.push_back({intervalOf(one), {}, 0});
    return times;
  }

 private:
  Status load(const Draw& draw, const Progress& progress) {
    if (loaded_ == std::pair(draw.asset, draw.layers)) return {};
    loaded_ = {};
    renderer_.reset();
    Result<FoamInput> input = loadFoam(draw.asset, progress, draw.layers);
    if (!input) return input.error();
    input_ = std::move(*input);
    renderer_.emplace(input_.foam, progress);
    loaded_ = {draw.asset, draw.layers};
    return {};
  }

  Result<RenderedImages> drawView(const Draw& draw, const View& view, const Progress& progress) {
    ReferenceOptions options;
    options.precision = Precision::kFloat;
    options.cutoff = draw.options.cutoff;
    options.nearRatio = view.nearRatio.value_or(input_.nearRatio);
    options.nearDepth = view.nearDepth.value_or(input_.nearDepth);
    options.detailSharpness = input_.detailSharpness;
    return renderer_->render(view, options, progress);
  }

  FoamInput input_;
  std::optional<ReferenceRenderer> renderer_;
  std::pair<std::filesystem::path, uint32_t> loaded_{};
};

}  // namespace

std::unique_ptr<SweepRenderer> createCpuSweepRenderer() { return std::make_unique<CpuSweepRenderer>(); }

}  // namespace froth
