#include "measure/sweep/references.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "reference/image/metrics.h"

namespace froth {
namespace {

Result<Image> readPhoto(const std::filesystem::path& folder, const View& view) {
  const std::filesystem::path path = folder / view.name;
  Result<Image> photo = readImage(path);
  if (!photo) return photo.error();
  if (photo->width == view.width && photo->height == view.height) return photo;
  return makeError(ErrorKind::kUsage, "%s: %ux%u, the view has %ux%u; leave out --size or --photos", path.c_str(),
                   photo->width, photo->height, view.width, view.height);
}

// [scene units] of pixels where both have a distance; 0 where there is none.
double medianDistanceError(const Image& distance, const Image& exact) {
  std::vector<double> errors;
  for (size_t i = 0; i < distance.values.size(); ++i) {
    if (distance.values[i] >= 0 && exact.values[i] >= 0) {
      errors.push_back(std::abs(double{distance.values[i]} - exact.values[i]));
    }
  }
  if (errors.empty()) return 0;
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return *middle;
}

Result<ViewErrors> compareColours(const Image& image, const ReferenceImage& references) {
  const Result<ImageDifference> difference = compareImages(image, references.colour);
  if (!difference) return difference.error();
  const Result<FlipImage> seen = prepareFlip(image);
  if (!seen) return seen.error();
  const Result<FlipDifference> flip = compareFlip(references.flip, *seen);
  if (!flip) return flip.error();
  ViewErrors errors;
  errors.worstX = difference->worstX;
  errors.worstY = difference->worstY;
  errors.errors = {difference->psnr,     difference->ssim,        flip->mean, difference->meanError,
                   difference->maxError, difference->overOneStep, 0};
  return errors;
}

Result<ReferenceImage> prepareReference(Image colour) {
  Result<FlipImage> flip = prepareFlip(colour);
  if (!flip) return flip.error();
  return ReferenceImage{std::move(colour), std::move(*flip)};
}

float bilinear(const Image& image, double x, double y, uint32_t channel) {
  const auto clamped = [](double place, uint32_t size) {
    return std::clamp(place, 0.0, static_cast<double>(size - 1));
  };
  x = clamped(x, image.width);
  y = clamped(y, image.height);
  const auto x0 = static_cast<uint32_t>(x), y0 = static_cast<uint32_t>(y);
  const uint32_t x1 = std::min(x0 + 1, image.width - 1), y1 = std::min(y0 + 1, image.height - 1);
  const double u = x - x0, v = y - y0;
  const auto at = [&](uint32_t px, uint32_t py) { return double{image.pixel(px, py)[channel]}; };
  return static_cast<float>((1 - v) * ((1 - u) * at(x0, y0) + u * at(x1, y0)) +
                            v * ((1 - u) * at(x0, y1) + u * at(x1, y1)));
}

// Pixel centres at one half.
Image enlarge(const Image& image, uint32_t width, uint32_t height) {
  Image large{width, height, image.channels, std::vector<float>(size_t{width} * height * image.channels)};
  const double stepX = static_cast<double>(image.width) / width, stepY = static_cast<double>(image.height) / height;
  tbb::parallel_for(uint32_t{0}, height, [&](uint32_t y) {
    for (uint32_t x = 0; x < width; ++x) {
      for (uint32_t c = 0; c < image.channels; ++c) {
        large.pixel(x, y)[c] = bilinear(image, (x + 0.5) * stepX - 0.5, (y + 0.5) * stepY - 0.5, c);
      }
    }
  });
  return large;
}

// A distance has no value between those of two pixels.
Image repeatPixels(const Image& image, uint32_t width, uint32_t height) {
  Image large{width, height, 1, {}};
  large.values.reserve(size_t{width} * height);
  for (uint64_t y = 0; y < height; ++y) {
    for (uint64_t x = 0; x < width; ++x) {
      const auto nearestX = static_cast<uint32_t>((2 * x + 1) * image.width / (2 * width));
      const auto nearestY = static_cast<uint32_t>((2 * y + 1) * image.height / (2 * height));
      large.values.push_back(*image.pixel(nearestX, nearestY));
    }
  }
  return large;
}

}  // namespace

ErrorFigures meanOf(const std::vector<ErrorFigures>& figures) {
  ErrorFigures mean;
  double square = 0;
  for (const ErrorFigures& one : figures) {
    square += std::pow(10, -one.psnr / 10);
    mean.ssim += one.ssim;
    mean.flip += one.flip;
    mean.meanError += one.meanError;
    mean.maxError = std::max(mean.maxError, one.maxError);
    mean.overOneStep += one.overOneStep;
    mean.distanceError += one.distanceError;
  }
  const auto count = static_cast<double>(figures.size());
  mean.psnr = -10 * std::log10(square / count);
  for (double* value : {&mean.ssim, &mean.flip, &mean.meanError, &mean.overOneStep, &mean.distanceError}) {
    *value /= count;
  }
  return mean;
}

Result<SweepReferences> SweepReferences::create(const FoamInput& input, const std::vector<SelectedView>& views,
                                                const std::filesystem::path& photos, const Progress& progress) {
  SweepReferences references;
  references.views_ = views;
  const ReferenceRenderer renderer(input.foam, progress);
  for (const SelectedView& selected : views) {
    if (!photos.empty()) {
      Result<Image> photo = readPhoto(photos, selected.view);
      if (!photo) return photo.error();
      Result<ReferenceImage> prepared = prepareReference(std::move(*photo));
      if (!prepared) return prepared.error();
      references.photos_.push_back(std::move(*prepared));
    }
    ReferenceOptions options;
    options.nearRatio = selected.view.nearRatio.value_or(input.nearRatio);
    options.nearDepth = selected.view.nearDepth.value_or(input.nearDepth);
    options.detailSharpness = input.detailSharpness;
    Result<RenderedImages> images = renderer.render(selected.view, options, progress);
    if (!images) return images.error();
    Result<ReferenceImage> prepared = prepareReference(std::move(images->colour));
    if (!prepared) return prepared.error();
    references.exact_.push_back(std::move(*prepared));
    references.distances_.push_back(std::move(images->distance));
  }
  return references;
}

Status SweepReferences::setWhole(std::vector<RenderedImages> images) {
  for (RenderedImages& one : images) {
    Result<ReferenceImage> prepared = prepareReference(std::move(one.colour));
    if (!prepared) return prepared.error();
    whole_.push_back(std::move(*prepared));
  }
  return {};
}

Result<PointErrors> SweepReferences::compare(std::vector<RenderedImages> images) const {
  PointErrors point;
  std::vector<ErrorFigures> figures(images.size()), photoFigures(photos_.size()), wholeFigures(whole_.size());
  point.views.resize(images.size());
  std::vector<Status> statuses(images.size());
  tbb::parallel_for(size_t{0}, images.size(), [&](size_t i) {
    const ReferenceImage& exact = exact_[i];
    Image colour = std::move(images[i].colour), distance = std::move(images[i].distance);
    if (colour.width != exact.colour.width) {
      colour = enlarge(colour, exact.colour.width, exact.colour.height);
      distance = repeatPixels(distance, exact.colour.width, exact.colour.height);
    }
    Result<ViewErrors> errors = compareColours(colour, exact);
    if (!errors) {
      statuses[i] = errors.error();
      return;
    }
    errors->view = static_cast<uint32_t>(views_[i].index);
    errors->errors.distanceError = medianDistanceError(distance, distances_[i]);
    figures[i] = errors->errors;
    point.views[i] = *errors;
    const auto compareWith = [&](const std::vector<ReferenceImage>& others, std::vector<ErrorFigures>& found) {
      if (others.empty()) return;
      const Result<ViewErrors> compared = compareColours(colour, others[i]);
      if (compared) {
        found[i] = compared->errors;
      } else {
        statuses[i] = compared.error();
      }
    };
    compareWith(photos_, photoFigures);
    compareWith(whole_, wholeFigures);
  });
  for (const Status& status : statuses) {
    if (!status) return status.error();
  }
  point.errors = meanOf(figures);
  if (!photos_.empty()) point.photoErrors = meanOf(photoFigures);
  if (!whole_.empty()) point.wholeErrors = meanOf(wholeFigures);
  return point;
}

}  // namespace froth
