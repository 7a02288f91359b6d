#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "baker/synth/gallery_scene.h"
#include "baker/synth/synth.h"
#include "base/counter_random.h"
#include "reference/camera/view_check.h"
#include "reference/camera/view_rays.h"

namespace froth {

using glm::dvec3;

namespace {

dvec3 traceRay(const Ray& ray) {
  const auto hit = galleryScene().intersect(ray);
  if (!hit) return {};
  return displayColour(lightPoint(*hit->solid, hit->position), ray.direction);
}

// Black where the lens sees nothing.
dvec3 tracePixel(const View& view, const ViewRays& rays, uint32_t x, uint32_t y, uint32_t samples,
                 const CounterRandom& random) {
  // Rows of strata as square as the count allows; each sample jitters inside its own.
  const auto rows = static_cast<uint32_t>(std::max(1.0, std::floor(std::sqrt(samples))));
  const uint64_t pixel = uint64_t{y} * view.width + x;
  dvec3 sum(0);
  for (uint32_t i = 0; i < samples; ++i) {
    const uint32_t row = i % rows, inRow = i / rows, rowLength = (samples - row + rows - 1) / rows;
    const uint64_t draw = 2 * (pixel * samples + i);
    const bool centred = samples == 1;  // one ray through the middle, as the renderers shoot
    const double u = (inRow + (centred ? 0.5 : random.uniform(draw))) / rowLength;
    const double v = (row + (centred ? 0.5 : random.uniform(draw + 1))) / rows;
    const std::optional<ViewRay> ray = rays.at(x + u, y + v);
    if (ray) sum += traceRay({eyeOf(view) + ray->offset, ray->direction});
  }
  return sum / static_cast<double>(samples);
}

}  // namespace

Result<Image> traceGallery(const View& view, uint32_t samples, const Progress& progress) {
  if (samples == 0) return makeError(ErrorKind::kUsage, "samples per pixel: 0; ask for at least 1");
  if (Status status = checkView(view, "view '" + view.name + "'"); !status) {
    return makeError(ErrorKind::kUsage, "%s", status.error().message.c_str());
  }
  const ViewRays rays(view);
  Image image{view.width, view.height, 3, std::vector<float>(size_t{view.width} * view.height * 3)};
  const CounterRandom random(0, Purpose::kSubpixel);
  constexpr uint32_t kBand = 16;  // rows between two reports
  for (uint32_t band = 0; band < view.height; band += kBand) {
    if (!report(progress, "tracing", band, view.height)) {
      return makeError(ErrorKind::kCancelled, "tracing of view '%s' was stopped", view.name.c_str());
    }
    const uint32_t end = std::min(band + kBand, view.height);
    tbb::parallel_for(tbb::blocked_range<uint32_t>(band, end, 1), [&](const tbb::blocked_range<uint32_t>& lines) {
      for (uint32_t y = lines.begin(); y < lines.end(); ++y) {
        for (uint32_t x = 0; x < view.width; ++x) {
          const dvec3 colour = tracePixel(view, rays, x, y, samples, random);
          for (int channel = 0; channel < 3; ++channel) {
            image.pixel(x, y)[channel] = static_cast<float>(colour[channel]);
          }
        }
      }
    });
  }
  return image;
}

}  // namespace froth
