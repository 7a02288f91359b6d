#include "measure/stability/forms.h"

#include "measure/stability/case_judge.h"
#include "measure/stability/image_bound.h"

namespace froth {
namespace {

constexpr Form kForms[] = {{"float", FormKind::kReference, false}, {"raster", FormKind::kRaster, false},
                           {"walk", FormKind::kWalk, false},       {"rays", FormKind::kRays, false},
                           {"queries", FormKind::kQueries, false}, {"raster shipped", FormKind::kRaster, true},
                           {"walk shipped", FormKind::kWalk, true}};

View movedBy(const glm::dvec3& by, View view) {
  for (int axis = 0; axis < 3; ++axis) view.worldFromCamera[4 * axis + 3] += by[axis];
  return view;
}

Result<DrawnForm> drawReference(const ReferenceRenderer& renderer, const View& view, ReferenceOptions options) {
  options.precision = Precision::kFloat;
  Result<RenderedImages> images = renderer.render(view, options);
  if (!images) return images.error();
  return DrawnForm{std::move(*images)};
}

FrothInstanceInfo placementOf(const CasePlace& place, const glm::dvec3& moved) {
  FrothInstanceInfo info{};
  for (int axis = 0; axis < 3; ++axis) {
    info.position[axis] = place.position[axis] + moved[axis];
    info.rotation[axis] = place.rotation[axis];
  }
  info.rotation[3] = place.rotation.w;
  info.scale = place.scale;
  return info;
}

}  // namespace

// The form that games draw is drawn from these bakes alone: it differs from the others by what no bake changes, and
// costs as much.
bool isDrawnAsShipped(const std::string& preset) { return preset == "exact" || preset == "default"; }

std::vector<Form> formsOf(const StiffCase& stiff, const std::string& preset) {
  std::vector<Form> forms;
  for (const Form& form : kForms) {
    const bool isOfOne = form.kind == FormKind::kReference;
    if ((!form.isShipped || isDrawnAsShipped(preset)) && !(isOfOne && !stiff.places.empty())) forms.push_back(form);
  }
  return forms;
}

CaseView caseViewOf(const StiffCase& stiff, size_t index, const BakedCase& baked) {
  return {movedBy(-baked.base, stiff.views[index]), movedBy(stiff.moved, stiff.views[index]),
          stiff.ends.empty() ? nullptr : &stiff.ends[index], stiff.jitter};
}

Result<std::unique_ptr<FormRenderer>> FormRenderer::create(const GpuDeviceOptions& options) {
  GpuDeviceOptions floats = options;
  floats.checkIndices = floats.floatColours = floats.castsRays = true;
  Result<std::unique_ptr<GpuRenderer>> inFloat = GpuRenderer::create(floats);
  if (!inFloat) return inFloat.error();
  GpuDeviceOptions shipped = options;
  shipped.validate = false;  // as in a game; layers see the same calls in the other context
  Result<std::unique_ptr<GpuRenderer>> asShipped = GpuRenderer::create(shipped);
  if (!asShipped) return asShipped.error();
  return std::unique_ptr<FormRenderer>(new FormRenderer(std::move(*inFloat), std::move(*asShipped)));
}

Status FormRenderer::load(const StiffCase& stiff, const BakedCase& baked, bool isShippedToo, const Progress& progress) {
  baked_ = &baked;
  std::vector<FrothInstanceInfo> placements;
  for (const CasePlace& place : stiff.places) placements.push_back(placementOf(place, stiff.moved));
  if (placements.empty()) placements.push_back(placementOf({}, stiff.moved));
  if (Status loaded = inFloat_->load(baked.asset, progress, placements); !loaded) return loaded;
  return isShippedToo ? asShipped_->load(baked.asset, progress, placements) : Status();
}

Result<DrawnForm> FormRenderer::draw(const Form& form, const StiffCase& stiff, size_t index) {
  const CaseView view = caseViewOf(stiff, index, *baked_);
  switch (form.kind) {
    case FormKind::kReference:
      return drawReference(*baked_->reference, view.ofFoam, optionsOfCase(stiff, index));
    case FormKind::kRays:
    case FormKind::kQueries:
      return castRays(form, view);
    case FormKind::kRaster:
    case FormKind::kWalk:
      break;
  }
  return drawImages(form, view);
}

// Twice in the same way, and a raster with all tiles in the other form.
Result<DrawnForm> FormRenderer::drawImages(const Form& form, const CaseView& view) {
  View aimed = view.ofWorld;
  aimed.cx -= view.jitter.x;
  aimed.cy -= view.jitter.y;
  GpuRenderOptions options;
  options.jitter = view.jitter;
  options.ends = view.ends;
  options.method = form.kind == FormKind::kRaster ? Method::kRaster : Method::kWalk;
  options.tileForm = FROTH_TILE_FORM_ALL_SHORT;
  options.cutoff = form.isShipped ? static_cast<float>(kShippedCutoff) : 0.0f;
  options.maxSteps = form.isShipped ? 0 : baked_->foam.cellCount;
  const auto draw = [&] {
    return form.isShipped ? asShipped_->renderColour(aimed, options) : inFloat_->render(aimed, options);
  };
  Result<GpuFrame> first = draw();
  if (!first) return first.error();
  const Result<GpuFrame> again = draw();
  if (!again) return again.error();
  DrawnForm drawn{std::move(first->images)};
  drawn.isRepeatable = hasSameBits(drawn.images, again->images);
  drawn.endsInTime = (first->status.bits & FROTH_VIEW_STEP_LIMIT) == 0;
  if (form.kind != FormKind::kRaster) return drawn;
  options.tileForm = FROTH_TILE_FORM_ALL_LONG;
  Result<GpuFrame> inLongTiles = draw();
  if (!inLongTiles) return inLongTiles.error();
  drawn.inLongTiles = std::move(inLongTiles->images);
  return drawn;
}

Result<DrawnForm> FormRenderer::castRays(const Form& form, const CaseView& view) {
  const RayOptions options{baked_->foam.cellCount, view.ends};
  const auto cast = [&] {
    return form.kind == FormKind::kRays ? inFloat_->castRays(view.ofWorld, options)
                                        : inFloat_->queryRays(view.ofWorld, options);
  };
  Result<RayFrame> first = cast();
  if (!first) return first.error();
  const Result<RayFrame> again = cast();
  if (!again) return again.error();
  DrawnForm drawn{std::move(first->images)};
  drawn.isRepeatable = hasSameBits(drawn.images, again->images);
  drawn.endsInTime = !first->hitStepLimit;
  return drawn;
}

}  // namespace froth
