// Marks what runs on the CPU and in CUDA kernels alike.
#pragma once

#if defined(__CUDACC__)
#define FROTH_HD __host__ __device__ inline
#else
#define FROTH_HD inline
#endif
