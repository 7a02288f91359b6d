// Even spreads of points: on a spiral that turns by this angle from one to the next.
#pragma once

namespace froth {

inline constexpr double kGoldenAngle = 2.39996322972865332;

}  // namespace froth
