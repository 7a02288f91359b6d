#include "trainer/photos/exposure.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "reference/camera/view_points.h"

namespace froth {
namespace {

constexpr int kAround = 1;                           // pixels around a point's, which count too
constexpr double kLeastValue = 8, kMostValue = 247;  // of 255: darker is noise, brighter may be clipped
constexpr size_t kLeastSeen = 20;                    // points of a photo that others show too
constexpr double kSpread = 0.1;                      // gloss and occluders differ by more, and weigh less (Huber)
constexpr int kMostSweeps = 500;
constexpr double kSettled = 1e-6;

// What a photo shows where a point is.
struct Observation {
  uint32_t photo = 0;
  glm::dvec3 value{0};  // logarithms
  double weight = 1;
};

// By point: the observations of one follow each other.
struct Observations {
  std::vector<Observation> all;
  std::vector<size_t> firsts{0};  // [points + 1]
};

// None outside of the photo, and beside pixels that do not count, are too dark or too bright.
std::optional<glm::dvec3> valueAt(const Photo& photo, const glm::dvec2& pixel) {
  const int width = int(photo.view.width), height = int(photo.view.height);
  const int column = int(pixel.x), row = int(pixel.y);
  if (column < kAround || row < kAround || column + kAround >= width || row + kAround >= height) return std::nullopt;
  glm::dvec3 sum(0);
  for (int y = row - kAround; y <= row + kAround; ++y) {
    for (int x = column - kAround; x <= column + kAround; ++x) {
      const size_t index = size_t(y) * size_t(width) + size_t(x);
      const uint8_t* rgba = &photo.rgba[4 * index];
      if (rgba[3] != 255 || (!photo.counted.empty() && photo.counted[index] == 0)) return std::nullopt;
      sum += glm::dvec3(rgba[0], rgba[1], rgba[2]);
    }
  }
  const glm::dvec3 mean = sum / double((2 * kAround + 1) * (2 * kAround + 1));
  const double least = std::min({mean.x, mean.y, mean.z}), most = std::max({mean.x, mean.y, mean.z});
  if (least < kLeastValue || most > kMostValue) return std::nullopt;
  return glm::log(mean);
}

Observations observe(const Capture& capture, const std::vector<Photo>& photos) {
  std::vector<ViewPoints> views;
  for (const Photo& photo : photos) views.emplace_back(photo.view);
  Observations observations;
  for (const CapturedPoint& point : capture.points) {
    for (uint32_t i = 0; i < point.observerCount; ++i) {
      const uint32_t photo = capture.observers[point.firstObserver + i];
      const std::optional<glm::dvec2> pixel = views[photo].of(point.position);
      const std::optional<glm::dvec3> value = pixel ? valueAt(photos[photo], *pixel) : std::nullopt;
      if (value) observations.all.push_back({photo, *value});
    }
    const size_t first = observations.firsts.back();
    if (observations.all.size() - first < 2) {
      observations.all.resize(first);  // nothing to compare it with
    } else {
      observations.firsts.push_back(observations.all.size());
    }
  }
  return observations;
}

// A point's colour is the mean of what its photos show, without their exposures; a photo's exposure the mean of how its
// points differ from their colours. Each sweep makes one from the other.
glm::dvec3 colourOf(const Observations& observations, size_t point, const std::vector<glm::dvec3>& exposures) {
  glm::dvec3 sum(0);
  double weights = 0;
  for (size_t i = observations.firsts[point]; i < observations.firsts[point + 1]; ++i) {
    const Observation& one = observations.all[i];
    sum += one.weight * (one.value - exposures[one.photo]);
    weights += one.weight;
  }
  return sum / weights;
}

// Returns by how much an exposure changes at most.
double sweep(Observations& observations, const std::vector<size_t>& seen, std::vector<glm::dvec3>& exposures) {
  std::vector<glm::dvec3> sums(exposures.size(), glm::dvec3(0));
  std::vector<double> weights(exposures.size(), 0.0);
  for (size_t point = 0; point + 1 < observations.firsts.size(); ++point) {
    const glm::dvec3 colour = colourOf(observations, point, exposures);
    for (size_t i = observations.firsts[point]; i < observations.firsts[point + 1]; ++i) {
      Observation& one = observations.all[i];
      const glm::dvec3 difference = one.value - colour;
      one.weight = 1 / std::max(1.0, glm::length(difference - exposures[one.photo]) / kSpread);
      sums[one.photo] += one.weight * difference;
      weights[one.photo] += one.weight;
    }
  }
  glm::dvec3 mean(0);
  for (size_t i = 0; i < sums.size(); ++i) {
    sums[i] = seen[i] >= kLeastSeen ? sums[i] / weights[i] : glm::dvec3(0);
    mean += sums[i] / double(sums.size());
  }
  double change = 0;
  for (size_t i = 0; i < sums.size(); ++i) {
    const glm::dvec3 next = seen[i] >= kLeastSeen ? sums[i] - mean : glm::dvec3(0);
    change = std::max(change, glm::length(next - exposures[i]));
    exposures[i] = next;
  }
  return change;
}

}  // namespace

Result<std::vector<glm::dvec3>> findExposures(const Capture& capture, const std::vector<Photo>& photos) {
  Observations observations = observe(capture, photos);
  std::vector<size_t> seen(photos.size());
  for (const Observation& one : observations.all) ++seen[one.photo];
  if (std::ranges::count_if(seen, [](size_t count) { return count >= kLeastSeen; }) < 2) {
    return makeError(
        ErrorKind::kBadInput,
        "exposures: of %zu points %zu are seen in several photos, and no two photos show %zu of them; give "
        "a COLMAP model with points, or leave --even-exposure out",
        capture.points.size(), observations.firsts.size() - 1, kLeastSeen);
  }
  std::vector<glm::dvec3> exposures(photos.size(), glm::dvec3(0));
  for (int i = 0; i < kMostSweeps && sweep(observations, seen, exposures) > kSettled; ++i) continue;
  return exposures;
}

void removeExposure(const glm::dvec3& exposure, Photo& photo) {
  const glm::dvec3 factor = glm::exp(-exposure);
  for (size_t i = 0; i < photo.rgba.size(); i += 4) {
    for (size_t c = 0; c < 3; ++c) {
      const double value = std::round(photo.rgba[i + c] * factor[glm::length_t(c)]);
      photo.rgba[i + c] = static_cast<uint8_t>(std::min(value, double(photo.rgba[i + 3])));  // premultiplied
    }
  }
}

Status evenExposures(const Capture& capture, std::vector<Photo>& photos) {
  const Result<std::vector<glm::dvec3>> exposures = findExposures(capture, photos);
  if (!exposures) return exposures.error();
  for (size_t i = 0; i < photos.size(); ++i) removeExposure((*exposures)[i], photos[i]);
  return {};
}

}  // namespace froth
