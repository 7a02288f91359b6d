// transforms.json, as nerfstudio and instant-ngp write it.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "base/image/rgba_image.h"
#include "reference/capture/capture.h"

namespace froth {

// Size of a photo named as its frame names it; asked for frames that do not tell.
using PhotoSizes = std::function<Result<ImageSize>(const std::string& name)>;

// Frames in the order of the file. View::name is the frame's path; CapturedView::mask its mask_path, relative to the
// file's folder, as photo and Capture::pointFile are. Values of a frame go before those of the file. `file` stands for
// it in messages. Any bytes give views or an error.
Result<Capture> parseTransforms(std::span<const uint8_t> bytes, const std::string& file, const PhotoSizes& sizes);

}  // namespace froth
