// Checks a camera of the caller's.
#pragma once

#include "froth/froth.h"
#include "runtime/device/messages.h"

namespace froth {

// The defaults of a lens, and null for what it has no use for.
void resolveLens(FrothCamera& camera);

// On FROTH_OK every field is finite, the rotation is one, and rays follow from projection or lens. `call` names the
// entry point in messages.
FrothResult checkCamera(const Messages& messages, const char* call, const FrothCamera& camera);

}  // namespace froth
