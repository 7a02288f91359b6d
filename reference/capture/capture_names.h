// Names of photos as a capture's files give them.
#pragma once

#include <string>

#include "base/result.h"

namespace froth {

// A name leads to a file below the folder of the photos: neither empty, nor absolute, nor out of it by "..". `place`
// heads the message.
Status checkPhotoName(const std::string& name, const std::string& place);

}  // namespace froth
