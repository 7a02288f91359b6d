// Names of FrothRayPreparation on command lines.
#pragma once

#include <map>
#include <string>

#include "froth/froth_walk.h"

namespace froth {

inline const std::map<std::string, FrothRayPreparation> kRayPreparations = {
    {"nothing", FROTH_PREPARE_NOTHING}, {"visibility", FROTH_PREPARE_VISIBILITY}, {"radiance", FROTH_PREPARE_RADIANCE}};

}  // namespace froth
