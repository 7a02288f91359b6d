#include "trainer/photos/photo_order.h"

#include <algorithm>
#include <numeric>

#include "base/counter_random.h"

namespace froth {

Result<PhotoSplit> splitPhotos(const std::vector<CapturedView>& views, uint32_t period) {
  const bool isSaid =
      std::any_of(views.begin(), views.end(), [](const CapturedView& v) { return v.part != CapturePart::kUnsaid; });
  PhotoSplit split;
  for (uint32_t i = 0; i < views.size(); ++i) {
    if (isSaid) {
      if (views[i].part == CapturePart::kTraining) split.training.push_back(i);
      if (views[i].part == CapturePart::kTest) split.test.push_back(i);
    } else {
      (period > 0 && i % period == 0 ? split.test : split.training).push_back(i);
    }
  }
  if (split.training.size() >= 2) return split;
  return makeError(ErrorKind::kBadInput,
                   "%zu of %zu photos are for training, at least 2 are needed; take more photos%s",
                   split.training.size(), views.size(), isSaid ? "" : ", or hold fewer out with --test-every");
}

std::vector<uint32_t> epochOrder(uint32_t count, uint64_t seed, uint64_t epoch) {
  const CounterRandom random(seed, Purpose::kPhotoOrder, epoch);
  std::vector<uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return random.bits(a) < random.bits(b); });
  return order;
}

std::vector<uint32_t> PhotoSequence::ofStep(uint32_t step, uint32_t photosPerStep) {
  std::vector<uint32_t> photos;
  for (uint32_t i = 0; i < photosPerStep; ++i) {
    const uint64_t index = uint64_t{step} * photosPerStep + i, epoch = index / count_;
    if (epoch != orderOf_) order_ = epochOrder(count_, seed_, epoch);
    orderOf_ = epoch;
    photos.push_back(order_[index % count_]);
  }
  return photos;
}

}  // namespace froth
