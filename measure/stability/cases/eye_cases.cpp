// Eyes and rays in special position.
#include <cmath>

#include "base/counter_random.h"
#include "measure/stability/cases/case_parts.h"

namespace froth {
namespace {

// Four cells around a vertex at the origin, which is where their power cells meet exactly; more of them around.
std::vector<CaseCell> aroundVertex() {
  std::vector<CaseCell> cells;
  const glm::vec3 corners[4] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  for (uint32_t i = 0; i < 4; ++i) cells.push_back({0.5f * corners[i], 1.0f, 1.5f, kFaceToViewer, 5, i});
  for (uint32_t i = 0; i < 4; ++i) cells.push_back({-1.25f * corners[i], 0.75f, 6, kFaceToViewer, 0.2f, 10 + i});
  return cells;
}

StiffCase from(const std::string& name, const std::string& what, const std::string& analysis, const glm::dvec3& eye) {
  const glm::dvec3 target = eye + glm::dvec3(0.4, 0.3, 1), behind = eye - glm::dvec3(1, 0.2, 0.5);
  return {name,
          what,
          analysis,
          foamOfCells(aroundVertex()),
          {caseView(eye, target, 32, 24, 0.8), caseView(eye, behind, 32, 24, 0.8)}};
}

StiffCase onDetailSite() {
  Foam foam = foamOfCells(aroundVertex());
  foam.detailSites[0] = {0, 0};
  const glm::dvec3 eye(foam.sites[0]);  // a detail site at the cell's own
  return {"eyes/on_detail_site",
          "the eye is a detail site, and so a site",
          "That detail site is seen along no direction; whatever colour it gets must be a colour that one of its lobes "
          "allows. Froth takes "
          "the face's normal, in all renderers alike.",
          foam,
          {caseView(eye, eye + glm::dvec3(0.2, 0.1, 1), 32, 24, 0.8)}};
}

// Rays of an odd image through a lens on an axis: those of the middle row and column have components that are exactly
// 0.
StiffCase alongAxes() {
  std::vector<View> views;
  const glm::dvec3 up[3] = {{0, -1, 0}, {0, 0, 1}, {1, 0, 0}};
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 eye(0);
    eye[axis] = -3;
    views.push_back(caseView(eye, {0, 0, 0}, 25, 25, 0.5, up[axis]));
  }
  return {"eyes/along_axes", "rays along the three axes, with components that are exactly 0",
          "A direction of 0 divides nothing: planes that hold it are never met, boxes are entered by the other axes.",
          foamOfCells(cloud(40, 51)), std::move(views)};
}

// A grid of odd number, looked at along its planes from an eye in them: the middle column of rays never leaves a plane.
StiffCase alongPlane(const std::string& name, const std::string& what, bool isVertex) {
  // In the plane x = 0; with `isVertex` in the planes x = 0 and y = 0, so that the middle ray runs along edges through
  // vertices.
  const glm::dvec3 eye(0, isVertex ? 0 : 0.125, -2);
  return {name,
          what,
          "A ray in a plane shows the cell of the first of its two sites. One within rounding of it may take either "
          "side for its whole "
          "length: its pixel is entitled to either colour, never to both or none.",
          foamOfBoxes(),
          {caseView(eye, eye + glm::dvec3(0, 0, 1), 25, 25, 0.5),
           orthographicView(eye, eye + glm::dvec3(0, 0, 1), 1.1, 25, 25)}};
}

}  // namespace

std::vector<StiffCase> eyeCases() {
  const glm::dvec3 site(0.5, 0.5, 0.5);
  return {
      from("eyes/inside", "the eye inside a cell", "The first interval begins at 0; nothing is close to a limit.",
           {0.375, 0.25, 0.3125}),
      from("eyes/on_sphere", "the eye on a ball's sphere",
           "Half of all rays leave the ball at once: its interval is a rounding long.", {-1.25 + 0.75, -1.25, -1.25}),
      from("eyes/on_plane", "the eye on a radical plane",
           "The plane is met at t = 0, from either side: it cuts all rays of one side and none of the other.",
           {0.5, 0, 0}),
      from("eyes/on_vertex", "the eye on the vertex of four cells",
           "Three planes through the eye divide the image; rays along them may take either side.", {0, 0, 0}),
      from("eyes/on_site", "the eye on a site",
           "The centre is 0 in all formulas; detail sites are seen along their own offsets.", site),
      onDetailSite(),
      alongAxes(),
      alongPlane("eyes/along_plane", "rays along radical planes", false),
      alongPlane("eyes/through_vertices", "a ray along edges and through vertices of the diagram", true)};
}

}  // namespace froth
