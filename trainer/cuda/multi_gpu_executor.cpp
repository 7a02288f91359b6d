#include "trainer/cuda/multi_gpu_executor.h"

#include <atomic>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace froth {
namespace {

Status takeGpu(uint32_t index) { return checkCuda(cudaSetDevice(static_cast<int>(index)), "cudaSetDevice"); }

}  // namespace

Status MultiGpuExecutor::check(uint32_t gpuCount) {
  const uint32_t present = cudaDeviceCount();
  if (gpuCount > present) {
    return makeError(ErrorKind::kDevice, "%u GPUs are asked for, this machine has %u that run CUDA; ask for fewer",
                     gpuCount, present);
  }
  // Another architecture runs other machine code, whose rounding differs: foams would drift apart.
  cudaDeviceProp first{}, other{};
  for (uint32_t i = 0; i < gpuCount; ++i) {
    cudaDeviceProp& properties = i == 0 ? first : other;
    const Status read = checkCuda(cudaGetDeviceProperties(&properties, static_cast<int>(i)), "cudaGetDeviceProperties");
    if (!read) return read;
    if (i > 0 && (other.major != first.major || other.minor != first.minor)) {
      return makeError(ErrorKind::kDevice,
                       "GPU 0 (%s) and GPU %u (%s) are of different architectures; choose GPUs of one with "
                       "CUDA_VISIBLE_DEVICES",
                       first.name, i, other.name);
    }
  }
  return GpuGroup::check();
}

Result<std::unique_ptr<StepExecutor>> MultiGpuExecutor::make(uint32_t gpuCount, const FoamStorage<float>& foam,
                                                             std::vector<Photo> photos, bool isDeterministic) {
  if (Status fits = check(gpuCount); !fits) return fits.error();
  Result<std::unique_ptr<GpuGroup>> group = GpuGroup::make(gpuCount);
  if (!group) return group.error();
  std::unique_ptr<MultiGpuExecutor> executor(new MultiGpuExecutor());
  executor->group_ = std::move(*group);
  const auto shared = std::make_shared<const std::vector<Photo>>(std::move(photos));
  for (uint32_t i = 0; i < gpuCount; ++i) {
    if (Status taken = takeGpu(i); !taken) return taken.error();
    Result<std::unique_ptr<CudaExecutor>> gpu = CudaExecutor::makeOnOne(foam, shared, isDeterministic);
    if (!gpu) return gpu.error();
    executor->gpus_.push_back(std::move(*gpu));
  }
  return std::unique_ptr<StepExecutor>(std::move(executor));
}

Status MultiGpuExecutor::onEach(const std::function<Status(CudaExecutor&, uint32_t)>& call) {
  std::vector<Status> statuses(gpus_.size());
  const auto callOne = [&](size_t i) {
    const auto index = static_cast<uint32_t>(i);
    statuses[i] = takeGpu(index);
    if (statuses[i]) statuses[i] = call(*gpus_[i], index);
  };
  // A call that waits for tasks of its own must not take up the call of another GPU meanwhile.
  tbb::parallel_for(
      size_t{0}, gpus_.size(), [&](size_t i) { tbb::this_task_arena::isolate([&] { callOne(i); }); },
      tbb::simple_partitioner());
  for (const Status& status : statuses) {
    if (!status) return status;
  }
  return {};
}

Status MultiGpuExecutor::runOnce(const StepPlan& plan, uint32_t share) {
  const Status kept = onEach([&](CudaExecutor& gpu, uint32_t index) -> Status {
    if (Status begun = gpu.beginStep(plan); !begun) return begun;
    return gpu.keepPhotos(plan, index * share, share);
  });
  if (!kept) return kept;
  std::vector<GpuGroup::Place> places;
  for (const auto& gpu : gpus_) places.push_back({gpu->step().keptViews(), gpu->step().stream()});
  if (Status sent = group_->gather(places, share * gpus_.front()->step().bytesOfView()); !sent) return sent;
  return onEach([&](CudaExecutor& gpu, uint32_t index) { return gpu.updateByPhotos(plan, index == 0); });
}

Status MultiGpuExecutor::run(const StepPlan& plan) {
  const auto photos = static_cast<uint32_t>(plan.photos.size()), gpus = static_cast<uint32_t>(gpus_.size());
  if (photos % gpus != 0) {
    return makeError(ErrorKind::kUsage,
                     "training: the run has steps of %u photos, which %u GPUs do not share evenly; give --gpus %u, or "
                     "begin anew",
                     photos, gpus, photos);
  }
  while (true) {
    if (Status ran = runOnce(plan, photos / gpus); !ran) return ran;
    std::atomic<bool> isDone = true;
    const Status settled = onEach([&](CudaExecutor& gpu, uint32_t) -> Status {
      const Result<bool> fits = gpu.step().settle();
      if (!fits) return fits.error();
      if (!*fits) isDone = false;
      return {};
    });
    if (!settled || isDone) return settled;
  }
}

Status MultiGpuExecutor::rearrange(const CellPlan& plan) {
  return onEach([&](CudaExecutor& gpu, uint32_t) { return gpu.rearrange(plan); });
}

Status MultiGpuExecutor::beginAnew() {
  return onEach([](CudaExecutor& gpu, uint32_t) { return gpu.beginAnew(); });
}

Status MultiGpuExecutor::average() {
  return onEach([](CudaExecutor& gpu, uint32_t) { return gpu.average(); });
}

Status MultiGpuExecutor::takeMeans() {
  return onEach([](CudaExecutor& gpu, uint32_t) { return gpu.takeMeans(); });
}

Result<CellFacts> MultiGpuExecutor::facts() {
  if (Status taken = takeGpu(0); !taken) return taken.error();
  return gpus_.front()->facts();
}

Status MultiGpuExecutor::show(const View& view, const AdamStep<float>& adam, std::vector<glm::vec4>& image) {
  if (Status taken = takeGpu(0); !taken) return taken;
  return gpus_.front()->show(view, adam, image);
}

Status MultiGpuExecutor::read(FoamStorage<float>& foam) {
  if (Status taken = takeGpu(0); !taken) return taken;
  return gpus_.front()->read(foam);
}

Result<uint64_t> MultiGpuExecutor::droppedCount() {
  uint64_t sum = 0;
  for (uint32_t i = 0; i < gpus_.size(); ++i) {
    if (Status taken = takeGpu(i); !taken) return taken.error();
    const Result<uint64_t> count = gpus_[i]->droppedCount();
    if (!count) return count.error();
    sum += *count;
  }
  return sum;
}

}  // namespace froth
