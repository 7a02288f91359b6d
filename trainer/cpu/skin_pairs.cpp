#include "trainer/cpu/skin_pairs.h"

#include <algorithm>

#include <tbb/parallel_for.h>

#include "foam/cech_pairs.h"
#include "trainer/step/skin.h"

namespace froth {
namespace {

// Where in row `neighbour` stands `cell`: rows are ascending and the graph is symmetric.
uint32_t placeInRow(const CellGraph& graph, uint32_t neighbour, uint32_t cell) {
  const auto begin = graph.neighbours.begin() + graph.offsets[neighbour];
  const auto end = graph.neighbours.begin() + graph.offsets[neighbour + 1];
  return static_cast<uint32_t>(std::lower_bound(begin, end, cell) - graph.neighbours.begin());
}

}  // namespace

template <class Real>
bool SkinPairs::follow(const std::vector<glm::vec<4, Real>>& balls, float leastSkin) {
  bool isGood = found_.size() == balls.size();
  for (size_t i = 0; isGood && i < balls.size(); ++i) {
    isGood = isWithinSlack(balls[i], found_[i], slacks_[i]);
  }
  if (isGood) return false;
  found_.assign(balls.begin(), balls.end());
  find(leastSkin);
  return true;
}

void SkinPairs::find(float leastSkin) {
  std::vector<glm::vec3> sites(found_.size());
  std::vector<float> radii(found_.size());
  slacks_.resize(found_.size());
  for (size_t i = 0; i < found_.size(); ++i) {
    const float skin = skinOf(found_[i].w, leastSkin);
    sites[i] = glm::vec3(found_[i]);
    radii[i] = found_[i].w + skin;
    slacks_[i] = slackOf(skin);
  }
  graph_ = findCechPairs(sites, radii);
  reverses_.resize(graph_.neighbours.size());
  tbb::parallel_for(size_t{0}, found_.size(), [&](size_t cell) {
    for (uint32_t e = graph_.offsets[cell]; e < graph_.offsets[cell + 1]; ++e) {
      reverses_[e] = placeInRow(graph_, graph_.neighbours[e], static_cast<uint32_t>(cell));
    }
  });
}

template bool SkinPairs::follow(const std::vector<glm::vec4>&, float);
template bool SkinPairs::follow(const std::vector<glm::dvec4>&, float);

}  // namespace froth
