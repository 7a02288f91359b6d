// Through which of its radical planes a ray leaves a cell. It meets one at t = clearance / q (cell.h); planes with q <=
// 0 are no exits.
#ifndef FROTH_FOAM_NEXT_CELL_H
#define FROTH_FOAM_NEXT_CELL_H
#include "prelude.h"

// By how much the ray meets one plane before the other, without a division; q, otherQ > 0. 0: at once. Where there is
// no other plane yet otherClearance is 1 and otherQ is 0, so that any lies before it.
FOAM_FN real exitLead(real clearance, real q, real otherClearance, real otherQ) {
  return otherClearance * q - clearance * otherQ;
}

#include "postlude.h"
#endif
