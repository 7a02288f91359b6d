// What the images of a report are compared with: the double-precision reference of the foam as it was given, and
// photos.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "baker/input/foam_input.h"
#include "base/image/image.h"
#include "measure/report/report.h"
#include "reference/capture/view_selection.h"
#include "reference/image/flip.h"
#include "reference/render/reference.h"

namespace froth {

struct PointErrors {
  std::vector<ViewErrors> views;
  ErrorFigures errors;                      // mean over the views
  std::optional<ErrorFigures> photoErrors;  // the same against the photos
  std::optional<ErrorFigures> wholeErrors;  // and against all cells of an asset with levels of detail
};

struct ReferenceImage {
  Image colour;
  FlipImage flip;
};

class SweepReferences {
 public:
  // Draws every view in double, never ending a ray early. `photos`: a folder that holds them by the views' names;
  // empty: none. Fails if a photo is missing or has another size than its view.
  static Result<SweepReferences> create(const FoamInput& input, const std::vector<SelectedView>& views,
                                        const std::filesystem::path& photos, const Progress& progress);

  // What an asset with levels of detail shows with all of its finest cells.
  Status setWhole(std::vector<RenderedImages> images);

  // One image per view, of its size or smaller: enlarged bilinearly then.
  Result<PointErrors> compare(std::vector<RenderedImages> images) const;

  const Image& exact(size_t view) const { return exact_[view].colour; }

 private:
  std::vector<SelectedView> views_;
  std::vector<ReferenceImage> exact_;
  std::vector<Image> distances_;
  std::vector<ReferenceImage> photos_;  // empty: none
  std::vector<ReferenceImage> whole_;   // the same
};

// Means over views; PSNR of the mean square, maxError the largest.
ErrorFigures meanOf(const std::vector<ErrorFigures>& figures);

}  // namespace froth
