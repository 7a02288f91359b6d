// The forms in which the stiff set draws a view: the one description of them, and what draws them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "measure/gpu/gpu_renderer.h"
#include "measure/stability/baked_case.h"
#include "measure/stability/cases/stiff_case.h"

namespace froth {

enum class FormKind {
  kReference,  // the reference in float, on the CPU
  kRaster,
  kWalk,
  kRays,     // of a buffer, by the shaders that engines include
  kQueries,  // on the CPU, in double
};

struct Form {
  const char* name;
  FormKind kind;
  // what a game draws: colour alone in halves, with the default cut-off; else all that it has, in float, without
  bool isShipped;
};

inline constexpr double kShippedCutoff = 1e-3;

bool isDrawnAsShipped(const std::string& preset);
// The reference in float knows no several instances.
std::vector<Form> formsOf(const StiffCase& stiff, const std::string& preset);

// What a form shows of a view.
struct DrawnForm {
  RenderedImages images;                        // of a raster: with all tiles short
  std::optional<RenderedImages> inLongTiles{};  // of a raster
  bool isRepeatable = true;                     // the same bits on a second run
  bool endsInTime = true;                       // no walk takes more steps than there are cells
};

// A view of a case, in the frames of those who draw it.
struct CaseView {
  View ofFoam;        // BakedCase::foam
  View ofWorld;       // where the asset is placed
  const Image* ends;  // as StiffCase::ends; null: nowhere
  glm::vec2 jitter;   // StiffCase::jitter
};
// Refers to the case's images.
CaseView caseViewOf(const StiffCase& stiff, size_t index, const BakedCase& baked);

// One thread at a time.
class FormRenderer {
 public:
  // `options` need the lens classes of all views. Indices are always checked.
  static Result<std::unique_ptr<FormRenderer>> create(const GpuDeviceOptions& options);

  // Keeps a reference to `baked`.
  Status load(const StiffCase& stiff, const BakedCase& baked, bool isShippedToo, const Progress& progress);
  Result<DrawnForm> draw(const Form& form, const StiffCase& stiff, size_t index);

  const HostDeviceInfo& device() const { return inFloat_->device(); }

 private:
  FormRenderer(std::unique_ptr<GpuRenderer> inFloat, std::unique_ptr<GpuRenderer> asShipped)
      : inFloat_(std::move(inFloat)), asShipped_(std::move(asShipped)) {}
  Result<DrawnForm> drawImages(const Form& form, const CaseView& view);
  Result<DrawnForm> castRays(const Form& form, const CaseView& view);

  // Two contexts: one keeps all values as floats and checks every index, the other is what a game creates.
  std::unique_ptr<GpuRenderer> inFloat_, asShipped_;
  const BakedCase* baked_ = nullptr;
};

}  // namespace froth
