// The photos that train, in the memory of the GPU.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "trainer/cuda/device_array.h"
#include "trainer/cuda/passes.h"
#include "trainer/photos/photos.h"
#include "trainer/step/training_view.h"

namespace froth {

class CudaPhotos {
 public:
  struct Target {
    TrainingView<float> view;  // `directions` are in device memory
    ImageTarget image;
  };

  // `photos` are kept, for smaller ones are made of them; GPUs share them.
  explicit CudaPhotos(std::shared_ptr<const std::vector<Photo>> photos) : photos_(std::move(photos)) {}

  // A photo with its sides halved so often. The first call for a number of halvings uploads all photos at that size.
  Result<Target> at(uint32_t photo, uint32_t halvings, cudaStream_t stream);
  size_t byteCount() const;

 private:
  struct Arrays {
    DeviceArray<uint8_t> rgba, counted;
    DeviceArray<float> directions;
    Target target;
  };
  Status upload(uint32_t halvings, cudaStream_t stream);

  std::shared_ptr<const std::vector<Photo>> photos_;
  std::vector<Arrays> arrays_;
  uint32_t halvings_ = UINT32_MAX;  // of arrays_
};

}  // namespace froth
