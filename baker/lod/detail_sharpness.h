// Of all foams that the baker takes: AssetContents::detailSharpness.
#pragma once

namespace froth {

inline constexpr double kTrainedSharpness = 10;

}  // namespace froth
