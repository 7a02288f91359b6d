#include "measure/sweep/drawing.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

#include "base/progress_printer.h"

namespace froth {
namespace {

// Mean frames of cycles over the views.
struct CycleTimes {
  std::vector<double> totals;
  std::vector<std::string> passOrder;
  std::map<std::string, std::vector<double>> passes;
  uint64_t residentBytes = 0, viewBytes = 0;
  DrawnChunks drawn;

  void add(const FrothAssetStatus& asset, const FrothViewStatus& view, const DrawnChunks& chunks) {
    residentBytes = std::max(residentBytes, asset.deviceBytes + view.deviceBytes);
    viewBytes = std::max<uint64_t>(viewBytes, view.deviceBytes);
    drawn.bytes = std::max(drawn.bytes, chunks.bytes);
    drawn.liveCells = std::max(drawn.liveCells, chunks.liveCells);
  }

  DrawTimes result() const {
    DrawTimes times{intervalOf(totals), {}, residentBytes, drawn, viewBytes};
    for (const std::string& pass : passOrder) times.passes.push_back({pass, intervalOf(passes.at(pass))});
    return times;
  }
};

// Draws on a device of its own until it goes: a GPU that has nothing to do for the time of a load lowers its clocks,
// and needs a second to raise them again.
class Warmth {
 public:
  Warmth(GpuRenderer& renderer, const Draw& draw)
      : thread_([&renderer, &draw](const std::stop_token& stop) {
          for (size_t frame = 0; !stop.stop_requested(); ++frame) {
            if (!renderer.draw(draw.views[frame % draw.views.size()], draw.options)) return;
          }
        }) {}

 private:
  std::jthread thread_;
};

bool haveManyAssets(const std::vector<Draw>& draws) {
  return std::any_of(draws.begin(), draws.end(), [&](const Draw& draw) { return draw.asset != draws.front().asset; });
}

class GpuSweepRenderer : public SweepRenderer {
 public:
  GpuSweepRenderer(std::unique_ptr<GpuRenderer> renderer, const GpuDeviceOptions& options)
      : renderer_(std::move(renderer)), options_(options) {}

  std::string device() const override { return renderer_->device().name; }
  std::string driver() const override { return renderer_->device().driver; }

  Result<std::vector<RenderedImages>> render(const Draw& draw, const Progress& progress) override {
    if (Status loaded = load(draw, progress); !loaded) return loaded.error();
    std::vector<RenderedImages> images;
    for (const View& view : draw.views) {
      Result<GpuFrame> frame = renderer_->render(view, draw.options);
      if (!frame) return frame.error();
      images.push_back(std::move(frame->images));
    }
    return images;
  }

  Result<std::vector<DrawTimes>> time(const std::vector<Draw>& draws, const Rounds& rounds,
                                      const Progress& progress) override {
    std::vector<CycleTimes> cycles(draws.size());
    if (draws.empty()) return std::vector<DrawTimes>{};
    if (Status ready = haveManyAssets(draws) ? prepareWarmth(draws.front()) : Status(); !ready) return ready.error();
    if (Status warm = warmUp(draws.front(), progress); !warm) return warm.error();
    for (uint32_t round = 0; round < rounds.count; ++round) {
      size_t done = round * draws.size();
      for (const size_t i : orderOf(draws, rounds, round)) {
        if (!report(progress, "time", done++, rounds.count * draws.size())) return stoppedError();
        if (Status timed = timeRound(draws[i], cyclesOf(draws[i], rounds), cycles[i]); !timed) return timed.error();
      }
    }
    std::vector<DrawTimes> times;
    for (const CycleTimes& one : cycles) times.push_back(one.result());
    return times;
  }

 private:
  Status load(const Draw& draw, const Progress& progress) {
    if (Status set = renderer_->setStreaming(draw.streaming); !set) return set;
    if (loaded_ == std::pair(draw.asset, draw.layers)) return {};
    loaded_ = {};
    std::optional<Warmth> warmth;
    if (warmer_) warmth.emplace(*warmer_, warmingDraw_);
    if (Status loaded = renderer_->load(inputOf(draw), progress); !loaded) return loaded;
    loaded_ = {draw.asset, draw.layers};
    return {};
  }

  static AssetInput inputOf(const Draw& draw) {
    AssetInput input;
    input.path = draw.asset;
    input.layers = draw.layers;
    return input;
  }

  // A CPU that draws has nothing to lose but time.
  Status prepareWarmth(const Draw& draw) {
    if (warmer_ || renderer_->device().type == VK_PHYSICAL_DEVICE_TYPE_CPU) return {};
    Result<std::unique_ptr<GpuRenderer>> created = GpuRenderer::create(options_);
    if (!created) return created.error();
    if (Status loaded = (*created)->load(inputOf(draw), {}); !loaded) return loaded;
    warmer_ = std::move(*created);
    warmingDraw_ = draw;
    return {};
  }

  // Clocks of an idle GPU take about a second to rise.
  Status warmUp(const Draw& draw, const Progress& progress) {
    if (Status loaded = load(draw, progress); !loaded) return loaded;
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(1);
    for (size_t frame = 0; std::chrono::steady_clock::now() < end; ++frame) {
      const Result<FrothViewStatus> status = renderer_->draw(draw.views[frame % draw.views.size()], draw.options);
      if (!status) return status.error();
    }
    return {};
  }

  Status timeRound(const Draw& draw, uint32_t count, CycleTimes& cycles) {
    if (Status loaded = load(draw, {}); !loaded) return loaded;
    CycleTimes warm;
    if (Status drawn = timeCycle(draw, warm); !drawn) return drawn;  // buffers grow to what the hungriest view needs
    for (uint32_t cycle = 0; cycle < count; ++cycle) {
      if (Status drawn = timeCycle(draw, cycles); !drawn) return drawn;
    }
    return {};
  }

  Status timeCycle(const Draw& draw, CycleTimes& cycles) {
    std::map<std::string, double> passes;
    double total = 0;
    for (const View& view : draw.views) {
      const Result<FrothViewStatus> status = renderer_->draw(view, draw.options);
      if (!status) return status.error();
      if (status->passCount == 0) {
        return makeError(ErrorKind::kUnsupported,
                         "device %s gives no timestamps on its compute queue; pick another, or --cpu",
                         renderer_->device().name.c_str());
      }
      for (uint32_t i = 0; i < status->passCount; ++i) {
        const FrothPassTime& pass = status->passes[i];
        if (passes.emplace(pass.name, 0).second &&
            std::find(cycles.passOrder.begin(), cycles.passOrder.end(), pass.name) == cycles.passOrder.end()) {
          cycles.passOrder.push_back(pass.name);
        }
        passes[pass.name] += pass.milliseconds;
        total += pass.milliseconds;
      }
      const Result<DrawnChunks> drawn = renderer_->drawnChunks();
      if (!drawn) return drawn.error();
      cycles.add(renderer_->assetStatus(), *status, *drawn);
    }
    const auto views = static_cast<double>(draw.views.size());
    cycles.totals.push_back(total / views);
    for (const auto& [name, sum] : passes) cycles.passes[name].push_back(sum / views);
    return {};
  }

  std::unique_ptr<GpuRenderer> renderer_, warmer_;
  GpuDeviceOptions options_;
  Draw warmingDraw_;
  std::pair<std::filesystem::path, uint32_t> loaded_{};
};

}  // namespace

Result<std::unique_ptr<SweepRenderer>> createGpuSweepRenderer(GpuDeviceOptions options) {
  options.measurePasses = true;
  Result<std::unique_ptr<GpuRenderer>> renderer = GpuRenderer::create(options);
  if (!renderer) return renderer.error();
  return std::unique_ptr<SweepRenderer>(std::make_unique<GpuSweepRenderer>(std::move(*renderer), options));
}

}  // namespace froth
