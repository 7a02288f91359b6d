#include <iterator>

#include "measure/stability/cases/case_parts.h"

namespace froth {

std::vector<StiffCase> builtInCases() {
  std::vector<StiffCase> all;
  for (auto* family : {siteCases, placeCases, sizeCases, densityCases, faceCases, eyeCases, appearanceCases, viewCases,
                       instanceCases, depthCases, layerCases, inputCases}) {
    std::vector<StiffCase> cases = family();
    all.insert(all.end(), std::make_move_iterator(cases.begin()), std::make_move_iterator(cases.end()));
  }
  return all;
}

}  // namespace froth
