#include "trainer/cuda/cuda_photos.h"

#include <tbb/parallel_for.h>

#include "trainer/cpu/view_exchange.h"
#include "trainer/photos/reduce_photo.h"

namespace froth {

Status CudaPhotos::upload(uint32_t halvings, cudaStream_t stream) {
  std::vector<Photo> reduced(photos_->size());
  tbb::parallel_for(size_t{0}, photos_->size(), [&](size_t i) { reduced[i] = reducePhoto((*photos_)[i], halvings); });
  arrays_.resize(photos_->size());
  halvings_ = halvings;
  for (size_t i = 0; i < reduced.size(); ++i) {
    const Photo& photo = reduced[i];
    Arrays& arrays = arrays_[i];
    if (Status sent = arrays.rgba.upload(photo.rgba, "photos", stream); !sent) return sent;
    if (Status sent = arrays.counted.upload(photo.counted, "masks", stream); !sent) return sent;
    const std::vector<float> directions = lensDirections(photo.view);
    if (Status sent = arrays.directions.upload(directions, "directions of a lens", stream); !sent) return sent;
    Target& target = arrays.target;
    target.view = trainingView<float>(photo.view);
    if (!directions.empty()) target.view.directions = arrays.directions.data();
    target.image = {photo.view.width, photo.view.height, arrays.rgba.data(),
                    photo.counted.empty() ? nullptr : arrays.counted.data()};
  }
  return checkCuda(cudaStreamSynchronize(stream), "upload of photos");
}

Result<CudaPhotos::Target> CudaPhotos::at(uint32_t photo, uint32_t halvings, cudaStream_t stream) {
  if (halvings != halvings_) {
    if (Status sent = upload(halvings, stream); !sent) return sent.error();
  }
  return arrays_[photo].target;
}

size_t CudaPhotos::byteCount() const {
  size_t sum = 0;
  for (const Arrays& arrays : arrays_) {
    sum += arrays.rgba.byteCount() + arrays.counted.byteCount() + arrays.directions.byteCount();
  }
  return sum;
}

}  // namespace froth
