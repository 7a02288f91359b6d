// Several instances in one image. Where their intervals overlap, densities add and colours mix by them.
#include "measure/stability/cases/case_parts.h"

namespace froth {
namespace {

StiffCase placed(const std::string& name, const std::string& what, const std::string& analysis,
                 std::vector<CasePlace> places, std::vector<View> views) {
  StiffCase stiff{name, what, analysis, foamOfCells(cloud(40, 81)), std::move(views)};
  stiff.places = std::move(places);
  return stiff;
}

const glm::quat kAskew = glm::normalize(glm::quat(0.9f, 0.1f, 0.35f, -0.1f));
constexpr glm::quat kUpright(1, 0, 0, 0), kHalfTurn(0, 0, 1, 0);  // about y

// Cubes of which each fills its own of a lattice's: instances that are shifted by a whole number share planes and
// spheres.
Foam latticeFoam() { return foamOfCubes({2, 2, 2}, glm::vec3(-0.25f), 0.4375f); }

}  // namespace

std::vector<StiffCase> instanceCases() {
  std::vector<View> views = outsideViews();
  views.push_back(caseView({0.1, 0.2, -0.3}, {0.3, 0.1, 1}, 32, 24, 0.8));
  std::vector<StiffCase> cases = {
      placed("instances/crossing",
             "two instances cross, one turned and smaller, seen from outside and from within both",
             "Intervals of both are merged where they lie; each is conditioned as if it were alone.",
             {{}, {{0.3, 0.2, 0.4}, kAskew, 0.75f}}, views),
      placed("instances/parallel", "the same along parallel rays", "As instances/crossing.",
             {{}, {{0.3, 0.2, 0.4}, kAskew, 0.75f}}, {orthographicView({0, 0, -3}, {0, 0, 0}, 1.2)}),
      placed("instances/coinciding", "an instance thrice in one place",
             "All intervals begin and end together: rounding leaves slivers between them that hold one or two of the "
             "three.",
             {{}, {}, {}}, views),
      placed("instances/turned_round",
             "an instance and itself turned by half a turn about the middle, four times in all",
             "As many as rays of the GPU follow at once.",
             {{}, {{0, 0, 0}, kHalfTurn, 1}, {{0.25, 0, 0}, kUpright, 1}, {{0, 0.25, 0}, kHalfTurn, 1}}, views),
      placed("instances/scales", "one a thousandth as large and as far, one a thousand times, one as it is",
             "Lengths of each are rounded relative to themselves; what is tiny hides behind what is near alone.",
             {{}, {{0, 0, -3.4955}, kAskew, 0.001f}, {{0, 0, 3500}, kAskew, 1000}},
             {caseView({0, 0, -3.5}, {0, 0, 0})})};
  StiffCase beside{"instances/beside",
                   "blocks of a lattice beside and through each other, whose planes and spheres coincide",
                   "Intervals of one end where those of another begin, up to rounding: a sliver is as dense as both.",
                   latticeFoam(),
                   {caseView({0.4, -0.7, -3}, {0, 0, 0}), orthographicView({0, 0, -3}, {0, 0, 0}, 1.25)}};
  beside.places = {{}, {{1, 0, 0}, kUpright, 1}, {{-0.5, 0, 0}, kUpright, 1}, {{0, 1, 0}, kHalfTurn, 1}};
  cases.push_back(std::move(beside));
  StiffCase ended = cases.front();
  ended.name = "instances/ended";
  ended.what = "the first of these, whose rays the scene ends in the middle of both";
  ended.analysis = "An interval that is cut is as long as the scene's depth says, whichever instance it is of.";
  for (const View& view : ended.views) {
    ended.ends.push_back({view.width, view.height, 1, std::vector<float>(size_t{view.width} * view.height, 3.5f)});
  }
  ended.ends.back().values.assign(ended.ends.back().values.size(), 0.5f);  // from within
  StiffCase far = cases.front();
  far.name = "instances/far_away";
  far.what = "the first of these a million units from the origin";
  far.analysis = "Each place and the eye are subtracted in double.";
  far.moved = {1e6, -1e6, 1e6};
  cases.push_back(std::move(ended));
  cases.push_back(std::move(far));
  return cases;
}

}  // namespace froth
