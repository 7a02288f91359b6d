// The limits of a view, checked alike when a file is read and before one is written.
#pragma once

#include <string>

#include "base/result.h"
#include "reference/camera/camera.h"

namespace froth {

// `place` heads the error message: "cameras.json: view 3".
Status checkView(const View& view, const std::string& place);

}  // namespace froth
