// Times passes on the GPU, by events.
#pragma once

#include <cuda_runtime_api.h>

#include <string>
#include <vector>

namespace froth {

struct PassTime {
  std::string name;
  float milliseconds = 0;  // the mean over laps
};

class PassClock {
 public:
  PassClock() = default;
  PassClock(const PassClock&) = delete;
  PassClock& operator=(const PassClock&) = delete;
  ~PassClock();

  // The work in the stream since the last mark was that of `pass`; null: it was nobody's.
  void mark(const char* pass, cudaStream_t stream);
  // Waits for the stream. Passes in their order, each once; `laps`: how many rounds of passes were marked.
  std::vector<PassTime> times(int laps);

 private:
  struct Mark {
    const char* pass;
    cudaEvent_t event;
  };
  std::vector<Mark> marks_;
};

}  // namespace froth
