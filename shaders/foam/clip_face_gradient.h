// How the place where a ray meets a cell's face moves with the face, and what turning a cell changes: gradients of
// clip_face.h, for training.
//
// Face frame: (tangent, bitangent, normal), as of inFaceFrame. A turn of the cell by a small vector `torque` of that
// frame turns every vector v that is fixed in the world and written in it: v' = v + torque x v.
#ifndef FROTH_FOAM_CLIP_FACE_GRADIENT_H
#define FROTH_FOAM_CLIP_FACE_GRADIENT_H
#include "prelude.h"

// The torque of a gradient by the normal, which is (0, 0, 1) of the face frame.
FOAM_FN real3 torqueOfNormal(real3 gradientInFrame) { return real3(gradientInFrame.y, -gradientInFrame.x, real(0)); }

// normal . (x - p) = height, met at the point `local` in the face frame [scene units]; facing: normal . direction,
// bounded. Adds the gradients of the centre in the face frame and of the turn; returns that of the height.
FOAM_FN real addFaceGradient(real3 local, real facing, real seed, FOAM_INOUT(real3) centreGradient,
                             FOAM_INOUT(real3) torque) {
  real scaled = seed / facing;
  centreGradient.z = centreGradient.z + scaled;
  torque = torque + torqueOfNormal(-scaled * local);
  return scaled;
}

#include "postlude.h"
#endif
