#include "trainer/cpu/foam_exchange.h"

#include <algorithm>

#include "foam/checkpoint/activation.h"

namespace froth {
namespace {

template <class Real>
std::vector<Real>& tensorOf(FoamStorage<Real>& storage, Parameter parameter) {
  return storage.values[static_cast<size_t>(parameter)];
}

template <class Real, class Item>
void storeItems(const std::vector<Item>& items, std::vector<Real>& tensor) {
  const float* values = reinterpret_cast<const float*>(items.data());
  std::copy(values, values + items.size() * (sizeof(Item) / sizeof(float)), tensor.begin());
}

template <class Real, class Item>
void loadItems(const std::vector<Real>& tensor, std::vector<Item>& items) {
  items.resize(tensor.size() / (sizeof(Item) / sizeof(float)));
  std::transform(tensor.begin(), tensor.end(), reinterpret_cast<float*>(items.data()),
                 [](Real value) { return static_cast<float>(value); });
}

}  // namespace

template <class Real>
FoamStorage<Real> storeFoam(const Foam& foam, AdamMoments moments) {
  FoamStorage<Real> storage;
  resizeStorage(storage, {foam.cellCount, foam.detailCount, foam.lobeCount}, moments);
  storeItems(foam.sites, tensorOf(storage, Parameter::kPoints));
  storeItems(foam.orientations, tensorOf(storage, Parameter::kOrientations));
  storeItems(foam.detailSites, tensorOf(storage, Parameter::kDetailSites));
  storeItems(foam.detailHeights, tensorOf(storage, Parameter::kDetailHeights));
  storeItems(foam.lobeAxes, tensorOf(storage, Parameter::kLobeAxes));
  storeItems(foam.lobeColours, tensorOf(storage, Parameter::kLobeColours));
  const auto deactivate = [](float value) { return Real(inverseSoftplus(value)); };
  std::transform(foam.radii.begin(), foam.radii.end(), tensorOf(storage, Parameter::kRadii).begin(), deactivate);
  std::transform(foam.densities.begin(), foam.densities.end(), tensorOf(storage, Parameter::kDensity).begin(),
                 deactivate);
  return storage;
}

template <class Real>
Foam activateFoam(const FoamStorage<Real>& storage) {
  const auto tensor = [&](Parameter parameter) -> const std::vector<Real>& {
    return storage.values[static_cast<size_t>(parameter)];
  };
  Foam foam;
  foam.cellCount = storage.shape.cellCount;
  foam.detailCount = storage.shape.detailCount;
  foam.lobeCount = storage.shape.lobeCount;
  loadItems(tensor(Parameter::kPoints), foam.sites);
  loadItems(tensor(Parameter::kDetailSites), foam.detailSites);
  loadItems(tensor(Parameter::kDetailHeights), foam.detailHeights);
  loadItems(tensor(Parameter::kLobeAxes), foam.lobeAxes);
  loadItems(tensor(Parameter::kLobeColours), foam.lobeColours);
  for (const Real raw : tensor(Parameter::kRadii)) foam.radii.push_back(static_cast<float>(softplus(double{raw})));
  for (const Real raw : tensor(Parameter::kDensity)) {
    foam.densities.push_back(static_cast<float>(softplus(double{raw})));
  }
  const std::vector<Real>& raw = tensor(Parameter::kOrientations);
  for (size_t i = 0; i < raw.size(); i += 4) {
    foam.orientations.push_back(normaliseQuaternion(glm::dvec4(raw[i], raw[i + 1], raw[i + 2], raw[i + 3])));
  }
  return foam;
}

template FoamStorage<float> storeFoam(const Foam&, AdamMoments);
template FoamStorage<double> storeFoam(const Foam&, AdamMoments);
template Foam activateFoam(const FoamStorage<float>&);
template Foam activateFoam(const FoamStorage<double>&);

}  // namespace froth
