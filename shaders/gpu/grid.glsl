// Dispatches over long lists are two-dimensional: in one dimension a device need not take more than kMostGroupsAlong
// workgroups.
#ifndef FROTH_GPU_GRID_GLSL
#define FROTH_GPU_GRID_GLSL
#include "gpu/layout.h"

// May lie beyond the last group that was asked for.
uint linearGroup() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

uint groupsOver(uint items, uint perGroup) { return items / perGroup + (items % perGroup != 0 ? 1 : 0); }

uvec4 dispatchOf(uint groups) {
  uint rows = groupsOver(groups, kMostGroupsAlong);
  return uvec4(rows > 0 ? groupsOver(groups, rows) : 0, rows, 1, 0);
}

#endif
