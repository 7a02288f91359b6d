#include "trainer/photos/photos.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <system_error>

#include <tbb/parallel_for.h>

#include "base/atomic_file.h"
#include "base/image/rgba_image.h"
#include "trainer/photos/box_filter.h"

namespace froth {
namespace {

constexpr int kHalf = 128;  // a mask's pixel of less is black, else white

Status checkSize(const RgbaImage& image, std::span<const uint8_t> bytes, const CapturedView& view) {
  const uint32_t width = view.view.width, height = view.view.height;
  if (image.width == width && image.height == height) return {};
  const bool isTurned = image.width == height && image.height == width && exifOrientation(bytes).value_or(1) > 4;
  return makeError(ErrorKind::kBadInput, "%s: found %u x %u pixels, its camera has %u x %u; %s", view.photo.c_str(),
                   image.width, image.height, width, height,
                   isTurned ? "EXIF turns it for viewers: store it turned (mogrify -auto-orient) and calibrate again"
                            : "give the photos that were calibrated, and reduce them with --downscale");
}

Result<RgbaImage> readMask(const CapturedView& view, const RgbaImage& image) {
  Result<RgbaImage> mask = readRgbaImage(view.mask);
  if (!mask || (mask->width == image.width && mask->height == image.height)) return mask;
  return makeError(ErrorKind::kBadInput, "%s: found %u x %u pixels, its photo %s has %u x %u; give a mask of that size",
                   view.mask.c_str(), mask->width, mask->height, view.photo.c_str(), image.width, image.height);
}

// By how much a pixel of a mask keeps its photo's pixel, 0 to 255.
uint8_t keptBy(const RgbaImage& mask, size_t pixel, MaskSense sense) {
  const uint8_t value = mask.values[4 * pixel];
  return sense == MaskSense::kBlackIgnored ? value : static_cast<uint8_t>(255 - value);
}

uint8_t timesAlpha(uint8_t value, uint8_t alpha) { return static_cast<uint8_t>((value * alpha + 127) / 255); }

// A premultiplied colour above its alpha would be brighter than white.
void premultiply(std::vector<uint8_t>& rgba, AlphaForm form) {
  for (size_t i = 0; i < rgba.size(); i += 4) {
    const uint8_t alpha = rgba[i + 3];
    for (size_t c = i; c < i + 3; ++c) {
      rgba[c] = form == AlphaForm::kStraight ? timesAlpha(rgba[c], alpha) : std::min(rgba[c], alpha);
    }
  }
}

void cutOut(const RgbaImage& mask, MaskSense sense, std::vector<uint8_t>& rgba) {
  for (size_t pixel = 0; pixel < rgba.size() / 4; ++pixel) {
    const uint8_t kept = keptBy(mask, pixel, sense);
    for (size_t c = 0; c < 4; ++c) rgba[4 * pixel + c] = timesAlpha(rgba[4 * pixel + c], kept);
  }
}

std::vector<uint8_t> flagsOf(const RgbaImage& mask, MaskSense sense) {
  std::vector<uint8_t> counted(mask.values.size() / 4);
  for (size_t pixel = 0; pixel < counted.size(); ++pixel) counted[pixel] = keptBy(mask, pixel, sense) >= kHalf;
  return counted;
}

View reducedView(const View& view, double downscale) {
  return resizeView(view, reducedSide(view.width, downscale), reducedSide(view.height, downscale));
}

Result<Photo> readPhoto(const CapturedView& view, const PhotoOptions& options) {
  const Result<std::vector<uint8_t>> bytes = readFile(view.photo);
  if (!bytes) return bytes.error();
  Result<RgbaImage> image = decodeRgbaImage(*bytes, view.photo.string());
  if (!image) return image.error();
  if (Status status = checkSize(*image, *bytes, view); !status) return status.error();
  Photo photo{reducedView(view.view, options.downscale), std::move(image->values), {}};
  if (image->hasAlpha) premultiply(photo.rgba, options.alpha);
  if (!view.mask.empty()) {
    const Result<RgbaImage> mask = readMask(view, *image);
    if (!mask) return mask.error();
    if (options.isMaskAlpha) {
      cutOut(*mask, view.maskSense, photo.rgba);
    } else {
      photo.counted = flagsOf(*mask, view.maskSense);
    }
  }
  const uint32_t width = photo.view.width, height = photo.view.height;
  if (width == image->width && height == image->height) return photo;
  photo.rgba = reducePixels(photo.rgba, image->width, image->height, width, height);
  if (!photo.counted.empty()) photo.counted = reduceFlags(photo.counted, image->width, image->height, width, height);
  return photo;
}

// Before hours of waiting for the last of many photos.
Status checkPresent(const std::vector<CapturedView>& views) {
  const CapturedView* first = nullptr;
  size_t missing = 0;
  for (const CapturedView& view : views) {
    std::error_code error;
    if (std::filesystem::exists(view.photo, error)) continue;
    if (!first) first = &view;
    ++missing;
  }
  if (!first) return {};
  return makeError(ErrorKind::kBadInput, "%s: no such photo, as %zu of %zu; put the photos that were calibrated there",
                   first->photo.c_str(), missing, views.size());
}

Status checkMemory(const std::vector<CapturedView>& views, const PhotoOptions& options) {
  uint64_t bytes = 0;
  for (const CapturedView& view : views) {
    const uint64_t width = reducedSide(view.view.width, options.downscale);
    const bool hasFlags = !view.mask.empty() && !options.isMaskAlpha;
    bytes += width * reducedSide(view.view.height, options.downscale) * (hasFlags ? 5 : 4);
  }
  if (bytes <= options.mostBytes) return {};
  constexpr double kMega = 1e6;
  return makeError(ErrorKind::kMemory, "%zu photos take %.0f MB, %.0f MB are allowed; give --downscale 2 or more",
                   views.size(), double(bytes) / kMega, double(options.mostBytes) / kMega);
}

}  // namespace

Result<std::vector<Photo>> readPhotos(const std::vector<CapturedView>& views, const PhotoOptions& options,
                                      const Progress& progress) {
  if (!(options.downscale >= 1)) {
    return makeError(ErrorKind::kUsage, "--downscale: found %g; give a number of 1 or more", options.downscale);
  }
  if (Status status = checkPresent(views); !status) return status.error();
  if (Status status = checkMemory(views, options); !status) return status.error();
  std::vector<Photo> photos(views.size());
  std::vector<std::optional<Error>> errors(views.size());
  std::atomic<bool> isStopped = false;
  std::mutex mutex;
  uint64_t done = 0;
  tbb::parallel_for(size_t{0}, views.size(), [&](size_t i) {
    if (isStopped) return;
    Result<Photo> photo = readPhoto(views[i], options);
    if (photo) {
      photos[i] = std::move(*photo);
    } else {
      errors[i] = photo.error();
    }
    const std::lock_guard lock(mutex);
    if (!report(progress, "photos", ++done, views.size())) isStopped = true;
  });
  if (isStopped) return stoppedOnRequest("reading photos");
  for (const std::optional<Error>& error : errors) {
    if (error) return *error;
  }
  return photos;
}

}  // namespace froth
