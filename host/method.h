// The renderers of the runtime, a row each.
#pragma once

#include <array>
#include <string_view>

#include "froth/froth.h"

namespace froth {

enum class Method { kRaster, kWalk };

struct MethodInfo {
  Method method;
  const char* name;  // as options and reports spell it
  const char* call;
  FrothResult (*record)(FrothContext*, FrothView, VkCommandBuffer, const FrothRenderInfo*);
};

inline constexpr std::array<MethodInfo, 2> kMethods = {{
    {Method::kRaster, "raster", "frothRecordRaster", frothRecordRaster},
    {Method::kWalk, "walk", "frothRecordWalk", frothRecordWalk},
}};

inline const MethodInfo& infoOf(Method method) { return kMethods[static_cast<size_t>(method)]; }

// Null: no renderer has this name.
inline const MethodInfo* findMethod(std::string_view name) {
  for (const MethodInfo& info : kMethods) {
    if (info.name == name) return &info;
  }
  return nullptr;
}

}  // namespace froth
