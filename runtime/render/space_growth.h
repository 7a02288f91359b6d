// How the buffers of an instance in a view become larger, or smaller, within the budget.
#pragma once

#include "runtime/render/view_state.h"

namespace froth {

// Frees what frames used no longer, and makes room for the asset, as far as is known. asset: null for a space that
// nobody has. On an error the space keeps what it had.
Status prepareSpace(ViewState& view, InstanceSpace& space, uint64_t completedSerial, const GpuAsset* asset);

}  // namespace froth
