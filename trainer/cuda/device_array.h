// An array in the memory of the GPU.
#pragma once

#include <cuda_runtime_api.h>

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "trainer/cuda/cuda_status.h"

namespace froth {

template <class T>
class DeviceArray {
 public:
  DeviceArray() = default;
  ~DeviceArray() { cudaFree(data_); }
  DeviceArray(DeviceArray&& other) noexcept { swap(other); }
  DeviceArray& operator=(DeviceArray&& other) noexcept {
    swap(other);
    return *this;
  }

  T* data() const { return data_; }
  size_t size() const { return size_; }
  size_t byteCount() const { return capacity_ * sizeof(T); }

  // Contents are lost when the array grows, which waits for the GPU. `name` stands in the error.
  Status resize(size_t size, const char* name) {
    if (size > capacity_) {
      cudaFree(std::exchange(data_, nullptr));
      capacity_ = size_ = 0;
      const std::string what =
          "cudaMalloc of " + std::to_string(size) + " x " + std::to_string(sizeof(T)) + " bytes for '" + name + "'";
      if (Status made = checkCuda(cudaMalloc(reinterpret_cast<void**>(&data_), size * sizeof(T)), what.c_str());
          !made) {
        data_ = nullptr;
        return made;
      }
      capacity_ = size;
    }
    size_ = size;
    return {};
  }

  // In the order of the stream; `values` may change at once if it is not pinned.
  Status upload(const std::vector<T>& values, const char* name, cudaStream_t stream) {
    if (Status resized = resize(values.size(), name); !resized) return resized;
    return checkCuda(cudaMemcpyAsync(data_, values.data(), size_ * sizeof(T), cudaMemcpyHostToDevice, stream), name);
  }

  // Waits for the stream.
  Status download(std::vector<T>& values, const char* name, cudaStream_t stream) const {
    values.resize(size_);
    if (Status copied =
            checkCuda(cudaMemcpyAsync(values.data(), data_, size_ * sizeof(T), cudaMemcpyDeviceToHost, stream), name);
        !copied) {
      return copied;
    }
    return checkCuda(cudaStreamSynchronize(stream), name);
  }

 private:
  void swap(DeviceArray& other) {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
  }

  T* data_ = nullptr;
  size_t size_ = 0, capacity_ = 0;
};

}  // namespace froth
