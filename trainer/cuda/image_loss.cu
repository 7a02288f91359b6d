// The gradient of the loss of trainer/loss/image_loss.h, and what the backward pass wants of the photo. Two kernels
// over squares of 16 x 16 pixels, with 5 more around them: windows are compared, then what they say of their means goes
// back to their pixels. Bound: bytes, 36 written and some 95 read per pixel between the two; flops, some 1200 per
// pixel.
#include "trainer/cuda/launch.h"
#include "trainer/cuda/passes.h"
#include "trainer/loss/pixel_loss.h"

namespace froth {
namespace {

constexpr int kSquare = 16, kReach = foam::kSimilarityRadius, kWindow = 2 * kReach + 1, kWide = kSquare + 2 * kReach;
constexpr int kMoments = 6;  // means of 1, x, y, x^2, y^2, x y
constexpr int kFields = 3;   // derivatives by the means of x, x^2, x y

struct PixelPair {
  float shown = 0, wanted = 0, counts = 0;  // over grey
};

__device__ bool countsAt(const ImageTarget& target, size_t pixel) { return !target.counted || target.counted[pixel]; }

__device__ float photoValue(const ImageTarget& target, size_t pixel, int channel) {
  return target.rgba[4 * pixel + channel] / 255.0f;
}

__device__ float photoGap(const ImageTarget& target, size_t pixel) {
  return (255 - target.rgba[4 * pixel + 3]) / 255.0f;
}

__device__ PixelPair pairAt(const PixelArrays<float>& pixels, const ImageTarget& target, int x, int y, int channel) {
  if (x < 0 || y < 0 || x >= static_cast<int>(target.width) || y >= static_cast<int>(target.height)) return {};
  const size_t pixel = size_t(y) * target.width + x;
  if (!countsAt(target, pixel)) return {};
  const glm::vec4 rendered = pixels.rendered[pixel];
  return {foam::overGrey(rendered[channel], rendered.w),
          foam::overGrey(photoValue(target, pixel, channel), photoGap(target, pixel)), 1};
}

// Sums of `values` with the weights of a row of the window; stride: between its elements.
__device__ float blurOf(const float* values, int stride) {
  float sum = 0;
#pragma unroll
  for (int i = 0; i < kWindow; ++i) sum += foam::similarityWeight(i - kReach, 0.0f) * values[i * stride];
  return sum;
}

// Blurs the lines of kCount fields along x, by all threads. Each makes four numbers at a time, which share what they
// read: shared memory is the bound.
template <int kCount>
__device__ void blurRows(const float (&fields)[kCount][kWide][kWide + 1], float (&rows)[kCount][kWide][kSquare],
                         int thread) {
  constexpr int kAtATime = 4, kPerField = kWide * (kSquare / kAtATime);
  for (int i = thread; i < kCount * kPerField; i += kSquare * kSquare) {
    const int field = i / kPerField, y = i % kWide, x = i % kPerField / kWide * kAtATime;
    float values[kWindow + kAtATime - 1];
#pragma unroll
    for (int j = 0; j < kWindow + kAtATime - 1; ++j) values[j] = fields[field][y][x + j];
#pragma unroll
    for (int place = 0; place < kAtATime; ++place) rows[field][y][x + place] = blurOf(values + place, 1);
  }
}

// One channel per layer of the grid.
__global__ __launch_bounds__(kSquare* kSquare) void compareWindowsKernel(PixelArrays<float> pixels, ImageTarget target,
                                                                         float* fields) {
  __shared__ float products[kMoments][kWide][kWide + 1], rows[kMoments][kWide][kSquare];
  const int thread = static_cast<int>(threadIdx.y) * kSquare + threadIdx.x, channel = blockIdx.z;
  const int left = blockIdx.x * kSquare - kReach, top = blockIdx.y * kSquare - kReach;
  for (int i = thread; i < kWide * kWide; i += kSquare * kSquare) {
    const int x = i % kWide, y = i / kWide;
    const PixelPair pair = pairAt(pixels, target, left + x, top + y, channel);
    const float values[kMoments] = {pair.counts,
                                    pair.shown,
                                    pair.wanted,
                                    pair.shown * pair.shown,
                                    pair.wanted * pair.wanted,
                                    pair.shown * pair.wanted};
    for (int k = 0; k < kMoments; ++k) products[k][y][x] = values[k];
  }
  __syncthreads();
  blurRows(products, rows, thread);
  __syncthreads();
  const uint32_t x = blockIdx.x * kSquare + threadIdx.x, y = blockIdx.y * kSquare + threadIdx.y;
  if (x >= target.width || y >= target.height) return;
  const size_t pixel = size_t{y} * target.width + x, pixelCount = size_t{target.width} * target.height;
  glm::vec3 gradient(0);
  if (countsAt(target, pixel)) {
    float means[kMoments];
    for (int k = 0; k < kMoments; ++k) means[k] = blurOf(&rows[k][threadIdx.y][threadIdx.x], kSquare);
    const float total = means[0];  // > 0: the pixel itself counts
    foam::similarity(means[1] / total, means[2] / total, means[3] / total, means[4] / total, means[5] / total,
                     gradient);
    gradient /= total;
  }
  for (int k = 0; k < kFields; ++k) fields[(channel * kFields + k) * pixelCount + pixel] = gradient[k];
}

// The gradients of squares and of sparsity.
__device__ glm::vec4 plainGradient(const glm::vec4& rendered, const ImageTarget& target, size_t pixel,
                                   const LossTerms& terms) {
  glm::vec4 gradient(0, 0, 0, -terms.sparsity);
  const float gap = rendered.w - photoGap(target, pixel);
  for (int c = 0; c < 3; ++c) {
    float byColour, byTransmittance;
    foam::squareOverBackgrounds(rendered[c] - photoValue(target, pixel, c), gap, byColour, byTransmittance);
    gradient[c] = terms.perPixel * byColour;
    gradient.w += terms.perPixel * byTransmittance;
  }
  return gradient;
}

__global__ __launch_bounds__(kSquare* kSquare) void spreadGradientsKernel(PixelArrays<float> pixels, glm::vec4* wanted,
                                                                          ImageTarget target, LossTerms terms,
                                                                          const float* fields) {
  __shared__ float around[kFields][kWide][kWide + 1], rows[kFields][kWide][kSquare];
  const int thread = static_cast<int>(threadIdx.y) * kSquare + threadIdx.x;
  const int left = blockIdx.x * kSquare - kReach, top = blockIdx.y * kSquare - kReach;
  const int width = static_cast<int>(target.width), height = static_cast<int>(target.height);
  const uint32_t x = blockIdx.x * kSquare + threadIdx.x, y = blockIdx.y * kSquare + threadIdx.y;
  const size_t pixel = size_t{y} * target.width + x, pixelCount = size_t{target.width} * target.height;
  const bool isInside = x < target.width && y < target.height, counts = isInside && countsAt(target, pixel);
  glm::vec4 gradient = counts ? plainGradient(pixels.rendered[pixel], target, pixel, terms) : glm::vec4(0);
  glm::vec3 photo(0);
  for (int channel = 0; channel < 3; ++channel) {
    __syncthreads();
    for (int i = thread; i < kWide * kWide; i += kSquare * kSquare) {
      const int column = left + i % kWide, row = top + i / kWide;
      const bool isPixel = column >= 0 && row >= 0 && column < width && row < height;
      for (int k = 0; k < kFields; ++k) {
        const float* field = fields + (channel * kFields + k) * pixelCount;
        around[k][i / kWide][i % kWide] = isPixel ? field[size_t(row) * width + column] : 0;
      }
    }
    __syncthreads();
    blurRows(around, rows, thread);
    __syncthreads();
    if (!counts) continue;
    float means[kFields];
    for (int k = 0; k < kFields; ++k) means[k] = blurOf(&rows[k][threadIdx.y][threadIdx.x], kSquare);
    const PixelPair pair = pairAt(pixels, target, x, y, channel);
    const float byShown = terms.similarity * (means[0] + 2 * pair.shown * means[1] + pair.wanted * means[2]);
    gradient[channel] += byShown;
    gradient.w += 0.5f * byShown;
    photo[channel] = pair.wanted;
  }
  if (!isInside) return;
  pixels.gradients[pixel] = gradient;
  wanted[pixel] = glm::vec4(photo, counts ? 1.0f : 0.0f);
}

}  // namespace

Status differentiateLoss(const PixelArrays<float>& pixels, glm::vec4* wanted, const ImageTarget& target,
                         const LossTerms& terms, float* fields, cudaStream_t stream) {
  const dim3 square(kSquare, kSquare);
  const dim3 squares((target.width + kSquare - 1) / kSquare, (target.height + kSquare - 1) / kSquare);
  compareWindowsKernel<<<dim3(squares.x, squares.y, 3), square, 0, stream>>>(pixels, target, fields);
  spreadGradientsKernel<<<squares, square, 0, stream>>>(pixels, wanted, target, terms, fields);
  return checkLaunch("differentiateLoss");
}

}  // namespace froth
