#include "trainer/start/match_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include <tbb/parallel_for.h>

#include "reference/camera/view_points.h"
#include "reference/camera/view_rays.h"
#include "trainer/photos/reduce_photo.h"
#include "trainer/start/scene_frame.h"
#include "trainer/start/start_cells.h"
#include "trainer/start/start_streams.h"

namespace froth {
namespace {

constexpr uint32_t kMostSide = 256;     // [pixels] of reduced photos
constexpr uint32_t kPixelsPerRay = 16;  // a ray for so many pixels of all photos,
constexpr uint32_t kMostRays = 16000;   // at most
constexpr int kPatchReach = 3;          // [pixels] a patch reaches so far from its middle
constexpr int kPatch = 2 * kPatchReach + 1;
constexpr double kStep = 1.5;        // [pixels] by which a step along a ray moves in the photo farthest away
constexpr double kSweepBegin = 0.5;  // of the distance to that photo: where the sweep begins
constexpr uint32_t kNearby = 16;     // photos to choose from,
constexpr uint32_t kNeighbours = 8;  // and so many of them are looked at
const double kSameSide = std::cos(glm::radians(40.0));  // between axes of photos that are compared
constexpr float kLeastStructure = 0.012f;               // deviation of a patch's greys: more than noise
constexpr float kAlike = 0.85f;                         // correlation from which patches are alike
constexpr float kStandsOut = 0.05f;                     // by so much other depths have to be less alike
constexpr float kObserves = 0.7f;                       // correlation from which a photo observes the point
constexpr uint32_t kFirstKept = 2;                      // [steps] from infinity: farther points have no depth

using Patch = std::array<float, kPatch * kPatch>;

// A reduced photo in grey.
struct GreyPhoto {
  View view;
  Photo photo;
  std::vector<float> grey;
  std::vector<uint8_t> isKnown;  // neither masked nor transparent

  bool isKnownAt(const glm::dvec2& pixel) const {
    return isKnown[static_cast<size_t>(pixel.y) * view.width + static_cast<size_t>(pixel.x)] != 0;
  }
};

GreyPhoto greyOf(const Photo& photo) {
  uint32_t halvings = 0;
  while (std::max(photo.view.width, photo.view.height) >> halvings > kMostSide) ++halvings;
  GreyPhoto reduced;
  reduced.photo = reducePhoto(photo, halvings);
  reduced.view = reduced.photo.view;
  const std::vector<uint8_t>& rgba = reduced.photo.rgba;
  for (size_t i = 0; i < rgba.size() / 4; ++i) {
    reduced.grey.push_back(static_cast<float>(rgba[4 * i] + rgba[4 * i + 1] + rgba[4 * i + 2]) / (3 * 255.0f));
    const bool counts = reduced.photo.counted.empty() || reduced.photo.counted[i] != 0;
    reduced.isKnown.push_back(counts && rgba[4 * i + 3] >= 128);
  }
  return reduced;
}

// How a patch lies in a photo: its middle, and by how much a pixel right and down in its own photo moves there.
struct PatchPlace {
  glm::vec2 middle, right, down;
};

// Greys of a patch with mean 0 and length 1; none where it leaves the photo, or has no structure.
std::optional<Patch> patchAt(const GreyPhoto& photo, const PatchPlace& place) {
  const float reachX = kPatchReach * (std::abs(place.right.x) + std::abs(place.down.x)) + 1;
  const float reachY = kPatchReach * (std::abs(place.right.y) + std::abs(place.down.y)) + 1;
  if (!(place.middle.x > reachX && place.middle.x + reachX < static_cast<float>(photo.view.width) &&
        place.middle.y > reachY && place.middle.y + reachY < static_cast<float>(photo.view.height))) {
    return std::nullopt;
  }
  Patch patch;
  float sum = 0, squares = 0;
  const size_t width = photo.view.width;
  for (int v = -kPatchReach, i = 0; v <= kPatchReach; ++v) {
    for (int u = -kPatchReach; u <= kPatchReach; ++u, ++i) {
      const glm::vec2 at = place.middle + float(u) * place.right + float(v) * place.down - 0.5f;  // pixel centres
      const auto x = static_cast<size_t>(at.x), y = static_cast<size_t>(at.y);
      const float* row = &photo.grey[y * width + x];
      const float s = at.x - static_cast<float>(x), t = at.y - static_cast<float>(y);
      const float value = (1 - t) * ((1 - s) * row[0] + s * row[1]) + t * ((1 - s) * row[width] + s * row[width + 1]);
      patch[size_t(i)] = value;
      sum += value;
      squares += value * value;
    }
  }
  const float mean = sum / patch.size(), variance = squares / patch.size() - mean * mean;
  if (!(variance > kLeastStructure * kLeastStructure)) return std::nullopt;
  const float scale = 1 / std::sqrt(variance * patch.size());
  for (float& value : patch) value = (value - mean) * scale;
  return patch;
}

class Sweep {
 public:
  Sweep(std::span<const Photo> photos, uint64_t seed)
      : pixels_(startRandom(seed, StartStream::kMatchPixel)), photos_(photos.size()), neighbours_(photos.size()) {
    tbb::parallel_for(size_t{0}, photos.size(), [&](size_t i) { photos_[i] = greyOf(photos[i]); });
    for (const GreyPhoto& photo : photos_) {
      rays_.emplace_back(photo.view);
      points_.emplace_back(photo.view);
    }
    for (uint32_t i = 0; i < photos_.size(); ++i) neighbours_[i] = neighboursOf(i);
  }

  uint32_t rayCount() const {
    size_t pixels = 0;
    for (const GreyPhoto& photo : photos_) pixels += photo.grey.size();
    return static_cast<uint32_t>(std::min<size_t>(pixels / kPixelsPerRay, kMostRays));
  }

  struct Match {
    CapturedPoint point;
    std::vector<uint32_t> observers;
  };
  std::optional<Match> matchOf(uint32_t index) const;

 private:
  // A patch of one photo, seen along the rays through it.
  struct Start {
    uint32_t photo;
    glm::dvec2 pixel;
    glm::dvec3 eye, middle, right, down;  // directions through the pixel, and through those beside it
    Patch patch;
  };
  std::optional<Start> startAt(uint32_t index) const;
  std::optional<float> likenessIn(uint32_t photo, const Start& start, double nearness) const;
  float likenessAt(const Start& start, double nearness) const;
  std::vector<uint32_t> neighboursOf(uint32_t index) const;
  double distanceTo(uint32_t a, uint32_t b) const {
    return glm::distance(eyeOf(photos_[a].view), eyeOf(photos_[b].view));
  }

  CounterRandom pixels_;
  std::vector<GreyPhoto> photos_;  // filled before rays_ and points_ refer to it
  std::vector<ViewRays> rays_;
  std::vector<ViewPoints> points_;
  std::vector<std::vector<uint32_t>> neighbours_;  // nearest first
};

// Spread over those nearby that look the same way from another place.
std::vector<uint32_t> Sweep::neighboursOf(uint32_t index) const {
  std::vector<std::pair<double, uint32_t>> nearby;
  for (uint32_t i = 0; i < photos_.size(); ++i) {
    const double distance = distanceTo(index, i);
    const bool isAlike = glm::dot(forwardOf(photos_[index].view), forwardOf(photos_[i].view)) > kSameSide;
    if (isAlike && distance > 0) nearby.emplace_back(distance, i);
  }
  std::sort(nearby.begin(), nearby.end());
  if (nearby.size() > kNearby) nearby.resize(kNearby);
  const size_t count = std::min<size_t>(nearby.size(), kNeighbours);
  std::vector<uint32_t> neighbours;
  for (size_t i = 1; i <= count; ++i) neighbours.push_back(nearby[i * nearby.size() / count - 1].second);
  return neighbours;
}

std::optional<Sweep::Start> Sweep::startAt(uint32_t index) const {
  Start start;
  start.photo = static_cast<uint32_t>(index % photos_.size());
  const GreyPhoto& photo = photos_[start.photo];
  start.pixel = {pixels_.uniform(2 * uint64_t{index}) * photo.view.width,
                 pixels_.uniform(2 * uint64_t{index} + 1) * photo.view.height};
  if (neighbours_[start.photo].empty() || !photo.isKnownAt(start.pixel)) return std::nullopt;
  const std::optional<Patch> patch = patchAt(photo, {start.pixel, {1, 0}, {0, 1}});
  if (!patch) return std::nullopt;
  start.patch = *patch;
  const ViewRays& rays = rays_[start.photo];
  const std::optional<ViewRay> middle = rays.at(start.pixel.x, start.pixel.y);
  const std::optional<ViewRay> right = rays.at(start.pixel.x + 1, start.pixel.y);
  const std::optional<ViewRay> down = rays.at(start.pixel.x, start.pixel.y + 1);
  if (!middle || !right || !down) return std::nullopt;
  start.eye = eyeOf(photo.view) + middle->offset;
  start.middle = middle->direction;
  start.right = right->direction;
  start.down = down->direction;
  return start;
}

// Correlation with what a photo shows at a depth; none where it does not show the place.
std::optional<float> Sweep::likenessIn(uint32_t photo, const Start& start, double nearness) const {
  const auto pixelOf = [&](const glm::dvec3& direction) { return points_[photo].of(start.eye + direction / nearness); };
  const std::optional<glm::dvec2> middle = pixelOf(start.middle);
  if (!middle || !photos_[photo].isKnownAt(*middle)) return std::nullopt;
  const std::optional<glm::dvec2> right = pixelOf(start.right), down = pixelOf(start.down);
  if (!right || !down) return std::nullopt;
  const std::optional<Patch> patch = patchAt(photos_[photo], {*middle, *right - *middle, *down - *middle});
  if (!patch) return 0.0f;  // plain
  float sum = 0;
  for (size_t i = 0; i < patch->size(); ++i) sum += (*patch)[i] * start.patch[i];
  return sum;
}

// The mean over the better half of the photos, for something may stand before it in the others; at least two.
float Sweep::likenessAt(const Start& start, double nearness) const {
  std::array<float, kNeighbours> values{};
  size_t count = 0;
  for (const uint32_t photo : neighbours_[start.photo]) {
    if (const std::optional<float> value = likenessIn(photo, start, nearness)) values[count++] = *value;
  }
  if (count < 2) return 0;
  const size_t kept = std::max<size_t>((count + 1) / 2, 2);
  std::partial_sort(values.begin(), values.begin() + kept, values.begin() + count, std::greater<>());
  float sum = 0;
  for (size_t i = 0; i < kept; ++i) sum += values[i];
  return sum / static_cast<float>(kept);
}

// The step that is most alike, between its neighbours where the parabola through them is highest; none where it is not
// alike enough, or others are as much.
std::optional<double> findPeak(const std::vector<float>& likeness) {
  const auto best = static_cast<size_t>(std::max_element(likeness.begin(), likeness.end()) - likeness.begin());
  if (likeness[best] < kAlike || best < kFirstKept || best + 1 >= likeness.size()) return std::nullopt;
  size_t first = best, last = best;  // the peak goes down to both sides
  while (first > 0 && likeness[first - 1] < likeness[first]) --first;
  while (last + 1 < likeness.size() && likeness[last + 1] < likeness[last]) ++last;
  for (size_t i = 0; i < likeness.size(); ++i) {
    if ((i < first || i > last) && likeness[i] > likeness[best] - kStandsOut) return std::nullopt;
  }
  const double before = likeness[best - 1], middle = likeness[best], after = likeness[best + 1];
  const double bend = before - 2 * middle + after;
  return static_cast<double>(best) + (bend < 0 ? 0.5 * (before - after) / bend : 0);
}

std::optional<Sweep::Match> Sweep::matchOf(uint32_t index) const {
  const std::optional<Start> start = startAt(index);
  if (!start) return std::nullopt;
  const GreyPhoto& photo = photos_[start->photo];
  const std::vector<uint32_t>& neighbours = neighbours_[start->photo];
  // In steps of nearness, 1 / distance, a place moves evenly through other photos.
  const double widest = distanceTo(start->photo, neighbours.back());
  const double focal = std::max(photo.view.fx, photo.view.fy);
  const double step = kStep / (focal * widest);
  const auto count = static_cast<size_t>(focal / (kSweepBegin * kStep));
  std::vector<float> likeness{0};  // at infinity
  for (size_t i = 1; i <= count; ++i) likeness.push_back(likenessAt(*start, static_cast<double>(i) * step));
  const std::optional<double> peak = findPeak(likeness);
  if (!peak) return std::nullopt;
  const double nearness = *peak * step;
  Match match;
  match.point.position = start->eye + start->middle / nearness;
  const size_t pixel = static_cast<size_t>(start->pixel.y) * photo.view.width + static_cast<size_t>(start->pixel.x);
  const uint8_t* rgba = &photo.photo.rgba[4 * pixel];
  for (size_t c = 0; c < 3; ++c) match.point.colour[c] = static_cast<uint8_t>(rgba[c] * 255 / rgba[3]);
  match.observers.push_back(start->photo);
  for (const uint32_t other : neighbours) {
    if (likenessIn(other, *start, nearness).value_or(0) >= kObserves) match.observers.push_back(other);
  }
  std::sort(match.observers.begin(), match.observers.end());
  return match;
}

}  // namespace

MatchedPoints matchPoints(std::span<const Photo> photos, uint64_t seed) {
  const Sweep sweep(photos, seed);
  std::vector<std::optional<Sweep::Match>> matches(sweep.rayCount());
  tbb::parallel_for(size_t{0}, matches.size(), [&](size_t i) { matches[i] = sweep.matchOf(static_cast<uint32_t>(i)); });
  MatchedPoints matched;
  for (std::optional<Sweep::Match>& match : matches) {
    if (!match) continue;
    match->point.firstObserver = matched.observers.size();
    match->point.observerCount = static_cast<uint32_t>(match->observers.size());
    matched.points.push_back(match->point);
    matched.observers.insert(matched.observers.end(), match->observers.begin(), match->observers.end());
  }
  return matched;
}

uint32_t replaceFewPoints(Capture& capture, std::span<const uint32_t> training, std::span<const Photo> photos,
                          uint64_t seed) {
  constexpr size_t kFew = 50;
  if (cellsOfPoints({capture, findSceneFrame(capture), training, {}, seed}).size() >= kFew) return 0;
  MatchedPoints matched = matchPoints(photos, seed);
  if (matched.points.size() < kFew) return 0;
  for (uint32_t& observer : matched.observers) observer = training[observer];
  capture.points = std::move(matched.points);
  capture.observers = std::move(matched.observers);
  return static_cast<uint32_t>(capture.points.size());
}

}  // namespace froth
