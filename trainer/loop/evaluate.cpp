#include "trainer/loop/evaluate.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace froth {
namespace {

constexpr double kMostPsnr = 100;

}  // namespace

double psnrOf(const Photo& photo, const std::vector<glm::vec4>& rendered) {
  double squares = 0;
  uint64_t values = 0;
  for (size_t i = 0; i < rendered.size(); ++i) {
    if (!photo.counted.empty() && !photo.counted[i]) continue;
    for (int c = 0; c < 3; ++c) {
      const double shown = std::clamp(double{rendered[i][c]}, 0.0, 1.0);
      const double error = shown - photo.rgba[4 * i + static_cast<size_t>(c)] / 255.0;
      squares += error * error;
      ++values;
    }
  }
  const double mean = values > 0 ? squares / static_cast<double>(values) : 0;
  return mean > 0 ? std::min(-10 * std::log10(mean), kMostPsnr) : kMostPsnr;
}

double meanPsnr(const std::vector<double>& psnrs) {
  return psnrs.empty() ? 0 : std::accumulate(psnrs.begin(), psnrs.end(), 0.0) / static_cast<double>(psnrs.size());
}

Result<std::vector<double>> photoPsnrs(StepExecutor& executor, const std::vector<Photo>& photos, size_t count,
                                       const AdamStep<float>& adam) {
  std::vector<double> psnrs;
  std::vector<glm::vec4> image;
  for (size_t i = 0; i < count; ++i) {
    const Photo& photo = photos[i * photos.size() / count];
    if (Status shown = executor.show(photo.view, adam, image); !shown) return shown.error();
    psnrs.push_back(psnrOf(photo, image));
  }
  return psnrs;
}

}  // namespace froth
