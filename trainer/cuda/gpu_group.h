// GPUs of this machine that hand each other what they have, by NCCL.
//
// NCCL is loaded when a group is made, not linked: it takes 200 MB, and only runs on several GPUs need it. Where its
// header was missing when froth was built, there are no groups.
#pragma once

#include <cuda_runtime_api.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "base/result.h"

namespace froth {

class GpuGroup {
 public:
  // Whether NCCL is there; the message says what to install.
  static Status check();
  // Of the GPUs 0, 1, ..., gpuCount - 1.
  static Result<std::unique_ptr<GpuGroup>> make(uint32_t gpuCount);
  ~GpuGroup();

  // What a GPU has and gets, in its own memory, in the order of its stream.
  struct Place {
    uint8_t* blocks;  // [GPUs * bytes]
    cudaStream_t stream;
  };
  // Block i of the i-th place goes to block i of all others. Returns when all is in the streams. One thread calls.
  Status gather(const std::vector<Place>& places, size_t bytes);

 private:
  struct Members;
  GpuGroup();

  std::unique_ptr<Members> members_;
};

}  // namespace froth
