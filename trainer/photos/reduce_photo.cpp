#include "trainer/photos/reduce_photo.h"

#include "trainer/photos/box_filter.h"

namespace froth {

Photo reducePhoto(const Photo& photo, uint32_t halvings) {
  const double factor = uint64_t{1} << halvings;
  const View& view = photo.view;
  const uint32_t width = reducedSide(view.width, factor), height = reducedSide(view.height, factor);
  Photo reduced;
  reduced.view = resizeView(view, width, height);
  reduced.rgba = reducePixels(photo.rgba, view.width, view.height, width, height);
  if (!photo.counted.empty()) {
    reduced.counted = reduceFlags(photo.counted, view.width, view.height, width, height);
  }
  return reduced;
}

}  // namespace froth
