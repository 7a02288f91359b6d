#include "measure/stability/case_judge.h"

#include <fmt/format.h>

#include "measure/stability/baked_case.h"

namespace froth {
namespace {

CaseFault notFinite(const BoundCheck& check, size_t view) {
  return {"double: not finite", "a value of the exact image is not finite", view, check.worstX, check.worstY};
}

Result<std::optional<CaseFault>> judgeView(const ReferenceRenderer& renderer, const StiffCase& stiff, size_t index,
                                           const BoundOptions& boundOptions) {
  const View& view = stiff.views[index];
  ReferenceOptions options = optionsOfCase(stiff, index);
  const Result<ImageBound> bound = boundImage(renderer, view, options, boundOptions);
  if (!bound) return bound.error();
  const BoundCheck exact = checkBound(*bound, bound->exact);
  if (!exact.isFinite) return std::optional(notFinite(exact, index));
  options.precision = Precision::kFloat;
  const Result<RenderedImages> first = renderer.render(view, options), second = renderer.render(view, options);
  if (!first) return first.error();
  if (!second) return second.error();
  BoundCheck check = checkBound(*bound, *first);
  if (check.worstExcess > 1 && boundOptions.samples < kSurerSamples) {
    BoundOptions surer = boundOptions;
    surer.samples = kSurerSamples;
    return judgeView(renderer, stiff, index, surer);
  }
  const auto fault = [&](const char* kind, std::string what, double factor = 0) {
    return std::optional(CaseFault{kind, std::move(what), index, check.worstX, check.worstY, factor});
  };
  if (!check.isFinite) return fault("float: not finite", "a value of the float image is not finite");
  if (check.worstExcess > 1) {
    return fault("float: over its bound",
                 fmt::format("pixel {}, {}: {} {:.3g} times its bound; largest error {:.3g}", check.worstX,
                             check.worstY, check.worstChannel, check.worstExcess, check.maxError),
                 check.worstExcess);
  }
  if (!hasSameBits(*first, *second)) return fault("float: another image", "a second render has other bits");
  return std::optional<CaseFault>();
}

// Of several instances: there is no float image of them.
Result<std::optional<CaseFault>> judgeMerged(const ReferenceRenderer& renderer, const StiffCase& stiff, size_t index) {
  const std::vector<PlacedFoam> placed = placeFoams(stiff, renderer, {});
  const ReferenceDraw draw = [&](const ReferenceOptions& own) { return renderMerged(placed, stiff.views[index], own); };
  const Result<ImageBound> bound = boundImage(draw, optionsOfCase(stiff, index), {.samples = 0});
  if (!bound) return bound.error();
  const BoundCheck exact = checkBound(*bound, bound->exact);
  return exact.isFinite ? std::optional<CaseFault>() : notFinite(exact, index);
}

}  // namespace

CaseJudge judgeByAll(std::vector<CaseJudge> judges) {
  return [judges = std::move(judges)](const StiffCase& stiffCase) -> Result<std::optional<CaseFault>> {
    for (const CaseJudge& judge : judges) {
      Result<std::optional<CaseFault>> fault = judge(stiffCase);
      if (!fault || *fault) return fault;
    }
    return std::optional<CaseFault>();
  };
}

CaseJudge judgeOfReference(BoundOptions options) {
  return [options](const StiffCase& stiffCase) -> Result<std::optional<CaseFault>> {
    const ReferenceRenderer renderer(stiffCase.foam);
    for (size_t i = 0; i < stiffCase.views.size(); ++i) {
      Result<std::optional<CaseFault>> fault =
          stiffCase.places.empty() ? judgeView(renderer, stiffCase, i, options) : judgeMerged(renderer, stiffCase, i);
      if (!fault || *fault) return fault;
    }
    return std::optional<CaseFault>();
  };
}

ReferenceOptions optionsOfCase(const StiffCase& stiff, size_t index) {
  const View& view = stiff.views[index];
  ReferenceOptions options;
  options.nearRatio = view.nearRatio.value_or(0);
  options.nearDepth = view.nearDepth.value_or(0);
  options.sceneDistance = stiff.ends.empty() ? nullptr : &stiff.ends[index];
  return options;
}

}  // namespace froth
