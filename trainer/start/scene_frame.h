// The normalised scene, in which training runs: its rates and limits are in scene units, and meant for cameras a few
// units from what they show.
#pragma once

#include <glm/glm.hpp>

#include "foam/foam.h"
#include "reference/capture/capture.h"
#include "trainer/step/eyes.h"

namespace froth {

// normalised = (scene - centre) * scale
struct SceneFrame {
  glm::dvec3 centre{0};
  double scale = 1;  // > 0
};

// The median of the points becomes 0, and the median distance from a point to a camera that observed it 4. Without
// points: the place that most axes of cameras pass by, and the distance to that; where they meet nowhere (they turn
// around one place, look outwards or in parallel), the middle of the cameras and three times how far they are spread.
// One camera alone that turns around: scale 4.
SceneFrame findSceneFrame(const Capture& capture);

// Around the mean of the cameras, in the normalised scene.
Eyes findEyes(const Capture& capture, const SceneFrame& frame);

glm::dvec3 normalised(const glm::dvec3& place, const SceneFrame& frame);
View normalised(const View& view, const SceneFrame& frame);

// Sites, radii and densities; all else of a foam has no unit. sceneFoam undoes normalisedFoam, up to rounding.
Foam normalisedFoam(Foam foam, const SceneFrame& frame);
Foam sceneFoam(Foam foam, const SceneFrame& frame);

}  // namespace froth
