#include "measure/stability/case_judge.h"

#include <fmt/format.h>

namespace froth {
namespace {

Result<std::optional<CaseFault>> judgeView(const ReferenceRenderer& renderer, const View& view, size_t index,
                                           const BoundOptions& boundOptions) {
  ReferenceOptions options = optionsOfCase(view);
  const Result<ImageBound> bound = boundImage(renderer, view, options, boundOptions);
  if (!bound) return bound.error();
  const BoundCheck exact = checkBound(*bound, bound->exact);
  if (!exact.isFinite) {
    return std::optional(CaseFault{"double: not finite", "a value of the exact image is not finite", index, exact.worstX,
                                   exact.worstY});
  }
  options.precision = Precision::kFloat;
  const Result<RenderedImages> first = renderer.render(view, options), second = renderer.render(view, options);
  if (!first) return first.error();
  if (!second) return second.error();
  BoundCheck check = checkBound(*bound, *first);
  if (check.worstExcess > 1 && boundOptions.samples < kSurerSamples) {
    BoundOptions surer = boundOptions;
    surer.samples = kSurerSamples;
    return judgeView(renderer, view, index, surer);
  }
  const auto fault = [&](const char* kind, std::string what, double factor = 0) {
    return std::optional(CaseFault{kind, std::move(what), index, check.worstX, check.worstY, factor});
  };
  if (!check.isFinite) return fault("float: not finite", "a value of the float image is not finite");
  if (check.worstExcess > 1) {
    return fault("float: over its bound",
                 fmt::format("pixel {}, {}: {} {:.3g} times its bound; largest error {:.3g}", check.worstX, check.worstY,
                             check.worstChannel, check.worstExcess, check.maxError),
                 check.worstExcess);
  }
  if (!hasSameBits(*first, *second)) return fault("float: another image", "a second render has other bits");
  return std::optional<CaseFault>();
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
      Result<std::optional<CaseFault>> fault = judgeView(renderer, stiffCase.views[i], i, options);
      if (!fault || *fault) return fault;
    }
    return std::optional<CaseFault>();
  };
}

ReferenceOptions optionsOfCase(const View& view) {
  ReferenceOptions options;
  options.nearRatio = view.nearRatio.value_or(0);
  options.nearDepth = view.nearDepth.value_or(0);
  return options;
}

}  // namespace froth
