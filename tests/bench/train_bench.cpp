// froth_bench_train SCENE [options]: how fast training on a GPU comes to which likeness, as lines of JSON.
//
// Trains as `froth train` does. Every so many steps it prints the seconds that training took so far, photos a second
// since the line before, PSNR and SSIM of the test photos at full size, and what the passes of a step cost over the 100
// steps before. With --gpus, passes and memory are those of GPU 0.
#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "foam/checkpoint/checkpoint.h"
#include "tests/bench/bench_calls.h"
#include "trainer/cpu/view_exchange.h"
#include "trainer/cuda/multi_gpu_executor.h"
#include "trainer/loop/evaluate.h"
#include "trainer/loop/train_scene.h"
#include "trainer/loss/image_loss.h"

namespace froth {
namespace {

using Clock = std::chrono::steady_clock;

constexpr uint32_t kTimedSteps = 100;

struct Options {
  std::string scene, output;
  uint32_t every = 500, gpus = 1;
  bool isDeterministic = false;
  double seconds = 1e9;
  TrainOptions train;
};

double secondsSince(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

// Passes calls on, and looks at the foam between steps.
class WatchedExecutor : public StepExecutor {
 public:
  WatchedExecutor(std::unique_ptr<StepExecutor> executor, CudaExecutor& gpu, const Options& options,
                  const std::vector<Photo>& tests)
      : executor_(std::move(executor)), gpu_(gpu), options_(options), tests_(tests) {}

  Status run(const StepPlan& plan) override {
    const uint32_t done = plan.adam.step, phase = (done - 1) % options_.every;
    cudaSetDevice(0);  // that of gpu_ and its clock; a step of several GPUs may leave this thread at another
    if (phase == options_.every - kTimedSteps) gpu_.step().setClock(&clock_.emplace());
    const Clock::time_point begin = Clock::now();
    if (clock_) clock_->mark(nullptr, gpu_.step().stream());
    if (Status ran = executor_->run(plan); !ran) return ran;
    seconds_ += secondsSince(begin);
    photos_ += plan.photos.size();
    if (done % options_.every == 0) print(plan, done);
    if (seconds_ + rearrangeSeconds_ > options_.seconds) {
      print(plan, done);
      return makeError(ErrorKind::kCancelled, "out of time after %u steps", done);
    }
    return {};
  }
  Status rearrange(const CellPlan& plan) override {
    const Status done = executor_->rearrange(plan);
    rearrangeSeconds_ += secondsSince(factsBegin_);
    return done;
  }
  Result<CellFacts> facts() override {
    factsBegin_ = Clock::now();
    return executor_->facts();
  }
  Status read(FoamStorage<float>& foam) override { return executor_->read(foam); }
  Status average() override { return executor_->average(); }
  Status takeMeans() override { return executor_->takeMeans(); }
  Status beginAnew() override { return executor_->beginAnew(); }
  uint32_t cellCount() const override { return executor_->cellCount(); }
  Status show(const View& view, const AdamStep<float>& adam, std::vector<glm::vec4>& image) override {
    return executor_->show(view, adam, image);
  }
  Result<uint64_t> droppedCount() override { return executor_->droppedCount(); }

 private:
  void print(const StepPlan& plan, uint32_t done);

  std::unique_ptr<StepExecutor> executor_;
  CudaExecutor& gpu_;  // the only one, or the first
  const Options& options_;
  const std::vector<Photo>& tests_;
  std::optional<PassClock> clock_;
  double seconds_ = 0, rearrangeSeconds_ = 0;
  size_t photos_ = 0;  // since the last line, which was at ...
  double secondsOfLine_ = 0;
  Clock::time_point factsBegin_;
  ImageLoss<float> loss_;
};

void WatchedExecutor::print(const StepPlan& plan, uint32_t done) {
  gpu_.step().setClock(nullptr);  // what follows is no step
  const double seconds = seconds_ + rearrangeSeconds_;
  double psnr = 0, similarity = 0;
  std::vector<glm::vec4> image, unused;
  for (const Photo& photo : tests_) {
    check(executor_->show(photo.view, plan.adam, image));
    psnr += psnrOf(photo, image) / static_cast<double>(tests_.size());
    unused.resize(image.size());
    const LossTarget target{photo.view.width, photo.view.height, photo.rgba.data(),
                            photo.counted.empty() ? nullptr : photo.counted.data()};
    similarity += (1 - loss_.evaluate(target, image, 1, unused).dissimilarity) / static_cast<double>(tests_.size());
  }
  fmt::print(
      "{{\"steps\": {}, \"seconds\": {:.2f}, \"densify_seconds\": {:.2f}, \"photos_per_second\": {:.2f}, \"psnr\": "
      "{:.3f}, \"ssim\": {:.4f}, "
      "\"cells\": {}, \"seen\": {}, \"entries\": {}, \"gpu_megabytes\": {:.0f}",
      done, seconds, rearrangeSeconds_, static_cast<double>(photos_) / (seconds - secondsOfLine_), psnr, similarity,
      gpu_.step().cellCount(), gpu_.step().counters().seenCells, gpu_.step().counters().tileEntries,
      static_cast<double>(gpu_.byteCount()) / 1e6);
  if (clock_) {
    for (const PassTime& time : clock_->times(kTimedSteps)) {
      fmt::print(", \"{}\": {:.3f}", time.name, time.milliseconds);
    }
  }
  fmt::print("}}\n");
  std::fflush(stdout);
  photos_ = 0;
  secondsOfLine_ = seconds;
  clock_.reset();
}

void train(const Options& options) {
  Capture capture = take(readCapture(options.scene));
  Clock::time_point begin = Clock::now();
  const TrainingSet set = take(prepareTraining(capture, options.train, {}));
  const View& view = set.training.front().view;
  fmt::print("{{\"photos\": {}, \"tests\": {}, \"width\": {}, \"height\": {}, \"seconds_to_read\": {:.2f}}}\n",
             set.training.size(), set.testing.size(), view.width, view.height, secondsSince(begin));
  const MakeExecutor make = [&](const FoamStorage<float>& foam,
                                std::vector<Photo> photos) -> Result<std::unique_ptr<StepExecutor>> {
    fmt::print("{{\"seconds_to_start\": {:.2f}, \"cells\": {}}}\n", secondsSince(begin), foam.shape.cellCount);
    const bool isOne = options.gpus == 1;
    Result<std::unique_ptr<StepExecutor>> made =
        isOne ? CudaExecutor::make(foam, std::move(photos), options.isDeterministic)
              : MultiGpuExecutor::make(options.gpus, foam, std::move(photos), options.isDeterministic);
    if (!made) return made.error();
    CudaExecutor& gpu = isOne ? static_cast<CudaExecutor&>(**made) : static_cast<MultiGpuExecutor&>(**made).gpu(0);
    return std::unique_ptr<StepExecutor>(
        std::make_unique<WatchedExecutor>(std::move(*made), gpu, options, set.testing));
  };
  begin = Clock::now();
  const Result<TrainResult> result = trainScene(capture, set, options.train, make);
  fmt::print("{{\"wall_seconds\": {:.2f}}}\n", secondsSince(begin));
  if (!result) {
    fmt::print("{}\n", result.error().message);
    return;
  }
  fmt::print("{{\"psnr\": {:.3f}, \"dropped\": {}, \"cells\": {}}}\n", meanPsnr(result->testPsnrs),
             result->droppedCount, result->foam.cellCount);
  if (!options.output.empty()) check(exportCheckpoint(options.output, result->foam, {}));
}

}  // namespace
}  // namespace froth

int main(int argc, char** argv) {
  froth::Options options;
  CLI::App app{"How fast training on a GPU comes to which likeness."};
  app.add_option("scene", options.scene, "a folder with a COLMAP model or transforms.json")->required();
  app.add_option("--steps", options.train.schedule.steps, "steps of one photo in all; --gpus takes fewer");
  app.add_option("--gpus", options.gpus, "of this machine; a step has so many photos")
      ->check(CLI::Range(1u, froth::kMostPhotosPerStep));
  app.add_option("--cells", options.train.schedule.mostCells, "at most so many");
  app.add_option("--start-cells", options.train.schedule.startCells, "to begin with");
  app.add_option("--detail-sites", options.train.detailCount, "per cell");
  app.add_option("--lobes", options.train.lobeCount, "per detail site");
  app.add_option("--downscale", options.train.photos.downscale, "divides the sides of photos");
  app.add_option("--every", options.every, "steps between two lines");
  app.add_flag("--deterministic", options.isDeterministic, "sums do not depend on an order");
  app.add_option("--seconds", options.seconds, "of training, then it stops");
  app.add_option("--output", options.output, "the foam");
  CLI11_PARSE(app, argc, argv);
  options.train.photosPerStep = options.gpus;
  froth::train(options);
  return 0;
}
