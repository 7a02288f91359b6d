#include "shaders/foam/cell.h"
#include "shaders/foam/clip_face.h"

#include <cmath>

#include "tests/foam/precision.h"

namespace froth {
namespace {

template <class Real>
class CellMathematics : public InBothPrecisions<Real> {};
TYPED_TEST_SUITE(CellMathematics, Precisions);

TYPED_TEST(CellMathematics, PowerOfTheOriginIsNegativeInsideTheBallAndExactNearItsSurface) {
  using Vec3 = glm::vec<3, TypeParam>;
  EXPECT_EQ(foam::powerOfOrigin(Vec3(0, 0, 0), TypeParam(2)), TypeParam(-4));
  EXPECT_EQ(foam::powerOfOrigin(Vec3(3, 0, 4), TypeParam(3)), TypeParam(16));
  // |p|^2 - r^2 in float would have an error of 0.06 here.
  const TypeParam radius = TypeParam(1000), distance = std::nextafter(radius, TypeParam(2000));
  const double exact = (double(distance) - double(radius)) * (double(distance) + double(radius));
  EXPECT_NEAR(foam::powerOfOrigin(Vec3(distance, 0, 0), radius), exact, 4 * exact * this->kEpsilon);
}

TYPED_TEST(CellMathematics, NearTestsLookAtTheRatioToTheRadiusAndAtTheDepthOfTheSite) {
  using Vec3 = glm::vec<3, TypeParam>;
  const auto isNear = [](Vec3 centre, double radius, double ratio, double depth) {
    return foam::isNearCell(centre, TypeParam(radius), Vec3(0, 0, 1), TypeParam(ratio), TypeParam(depth));
  };
  EXPECT_TRUE(isNear({0, 0, 3.99}, 1, 4, 0));
  EXPECT_FALSE(isNear({0, 0, 4}, 1, 4, 0));     // the limit itself is drawn
  EXPECT_FALSE(isNear({0, 3, -4}, 1, 4, 0));    // distance, not depth
  EXPECT_TRUE(isNear({100, 0, 0.9}, 1, 4, 1));  // depth, not distance
  EXPECT_FALSE(isNear({100, 0, 1}, 1, 4, 1));
  EXPECT_TRUE(isNear({0, 0, -5}, 1, 0, 0.5));
  EXPECT_FALSE(isNear({0, 0, 0}, 1, 0, 0));  // both switched off
  EXPECT_FALSE(isNear({0, 0, -9}, 1, -1, -1));
}

//        ____
//  o--->(-c--)---   tNear, tFar of a ball of radius 2 around (0, 0, 5)
//        ----
TYPED_TEST(CellMathematics, ARayMeetsABallAheadAroundOrNotAtAll) {
  using Vec3 = glm::vec<3, TypeParam>;
  TypeParam tNear, tFar;
  const auto meets = [&](Vec3 centre) { return foam::intersectBall(centre, TypeParam(2), Vec3(0, 0, 1), tNear, tFar); };
  EXPECT_TRUE(meets({0, 0, 5}));
  EXPECT_EQ(tNear, TypeParam(3));
  EXPECT_EQ(tFar, TypeParam(7));
  EXPECT_TRUE(meets({0, 0, 1}));  // the eye lies inside
  EXPECT_EQ(tNear, TypeParam(0));
  EXPECT_EQ(tFar, TypeParam(3));
  EXPECT_TRUE(meets({0, 0, -1}));  // inside, past the centre
  EXPECT_EQ(tFar, TypeParam(1));
  EXPECT_FALSE(meets({0, 0, -2}));  // touched from behind
  EXPECT_FALSE(meets({0, 0, -5}));
  EXPECT_FALSE(meets({2, 0, 5}));  // grazed
  EXPECT_FALSE(meets({3, 0, 5}));
  EXPECT_TRUE(meets({0, TypeParam(1.999), 5}));
}

TYPED_TEST(CellMathematics, ABallSmallAndFarAwayKeepsItsChord) {
  using Vec3 = glm::vec<3, TypeParam>;
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 direction = this->direction();
    const Vec3 d(direction), side(glm::normalize(glm::cross(direction, this->direction())));
    const TypeParam radius = TypeParam(0.05), distance = TypeParam(100);
    const Vec3 centre = distance * d + TypeParam(this->uniform(0, 0.9)) * radius * side;
    TypeParam tNear, tFar;
    ASSERT_TRUE(foam::intersectBall(centre, radius, d, tNear, tFar));
    // Against double on the same rounded input, whose direction is not quite of unit length.
    double exactNear, exactFar;
    ASSERT_TRUE(foam::intersectBall(glm::dvec3(centre), double(radius), glm::dvec3(d), exactNear, exactFar));
    // The perpendicular is off by a few epsilon of the distance; b^2 - 4ac would be off by epsilon * 100^2,
    // the whole chord.
    const double sine = 0.1, slope = 1 / std::sqrt(sine);
    EXPECT_NEAR(double(tFar) - double(tNear), exactFar - exactNear, 40 * slope * this->kEpsilon * distance);
  }
}

TYPED_TEST(CellMathematics, PointsOfTheRadicalPlaneHaveEqualPowers) {
  using Vec3 = glm::vec<3, TypeParam>;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 d(this->point(2));
    const TypeParam ri = TypeParam(this->uniform(0.1, 3)), rj = TypeParam(this->uniform(0.1, 3));
    const TypeParam m = foam::radicalOffset(d, ri, rj);
    const glm::dvec3 foot = glm::dvec3(d) * (double(m) / glm::dot(glm::dvec3(d), glm::dvec3(d)));
    const double powerI = glm::dot(foot, foot) - double(ri) * ri;
    const double powerJ = glm::dot(foot - glm::dvec3(d), foot - glm::dvec3(d)) - double(rj) * rj;
    EXPECT_NEAR(powerI, powerJ, 40 * this->kEpsilon);
    // Seen from the other side the two offsets share |d|^2 between them.
    EXPECT_NEAR(double(m) + double(foam::radicalOffset(-d, rj, ri)), double(glm::dot(d, d)), 40 * this->kEpsilon);
  }
  EXPECT_EQ(foam::radicalOffset(Vec3(2, 0, 0), TypeParam(1), TypeParam(1)), TypeParam(2));
}

TYPED_TEST(CellMathematics, ClearanceIsPositiveOnTheCellsSide) {
  using Vec3 = glm::vec<3, TypeParam>;
  const Vec3 toNeighbour(2, 0, 0);
  const TypeParam offset =
      foam::radicalOffset(toNeighbour, TypeParam(1), TypeParam(1));           // the plane lies 1 past the site
  EXPECT_GT(foam::radicalClearance(Vec3(5, 0, 0), toNeighbour, offset), 0);   // origin 6 before the plane
  EXPECT_LT(foam::radicalClearance(Vec3(-5, 0, 0), toNeighbour, offset), 0);  // origin past it
  EXPECT_EQ(foam::radicalClearance(Vec3(-1, 3, 7), toNeighbour, offset), 0);  // origin on it
}

TYPED_TEST(CellMathematics, APlaneLowersTheEndRaisesTheStartOrEmptiesAParallelRay) {
  const auto clip = [](double clearance, double q, bool isFirst = true) {
    TypeParam tNear = 1, tFar = 5;
    foam::clipByPlane(TypeParam(clearance), TypeParam(q), isFirst, tNear, tFar);
    return std::pair(double(tNear), double(tFar));
  };
  EXPECT_EQ(clip(3, 1), std::pair(1.0, 3.0));
  EXPECT_EQ(clip(9, 1), std::pair(1.0, 5.0));
  EXPECT_EQ(clip(-3, -1), std::pair(3.0, 5.0));
  EXPECT_EQ(clip(3, -1), std::pair(1.0, 5.0));
  EXPECT_EQ(clip(1, 0), std::pair(1.0, 5.0));
  EXPECT_EQ(clip(0, 0), std::pair(1.0, 5.0));         // in the plane itself: the first of the two cells owns it,
  EXPECT_EQ(clip(0, 0, false), std::pair(1.0, 1.0));  // and the other does not
  EXPECT_EQ(clip(-1, 0), std::pair(1.0, 1.0));        // parallel on the neighbour's side
  const auto [tNear, tFar] = clip(-1, 1);             // behind the origin: nothing is left
  EXPECT_GE(tNear, tFar);
}

TYPED_TEST(CellMathematics, ClippingAtTheRadicalPlaneLeavesThePartOfLowerPower) {
  using Vec3 = glm::vec<3, TypeParam>;
  int cut = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 centre(this->point(3)), other(this->point(3)), direction(this->direction());
    const TypeParam ri = TypeParam(this->uniform(0.5, 2)), rj = TypeParam(this->uniform(0.5, 2));
    TypeParam tNear = 0, tFar = 10;
    const TypeParam clearance =
        foam::radicalClearance(centre, other - centre, foam::radicalOffset(other - centre, ri, rj));
    foam::clipByPlane(clearance, glm::dot(other - centre, direction), foam::comesFirst(other - centre), tNear, tFar);
    const TypeParam t = TypeParam(this->uniform(0, 10));
    const auto power = [&](Vec3 site, double r) {
      const glm::dvec3 x = double(t) * glm::dvec3(direction) - glm::dvec3(site);
      return glm::dot(x, x) - r * r;
    };
    const double difference = power(centre, ri) - power(other, rj);
    if (std::abs(difference) < 1e-3) continue;  // on the plane, up to rounding
    EXPECT_EQ(t > tNear && t < tFar, difference < 0);
    cut += difference > 0;
  }
  EXPECT_GT(cut, 300);
}

TYPED_TEST(CellMathematics, EyePlanesCutLikePlanes) {
  using Vec3 = glm::vec<3, TypeParam>;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 d(this->point(3)), direction(this->direction());
    const TypeParam clearance = TypeParam(this->uniform(-3, 3));
    TypeParam tNear = TypeParam(0.5), tFar = 20;
    foam::clipByPlane(clearance, glm::dot(d, direction), foam::comesFirst(d), tNear, tFar);
    const TypeParam s = glm::dot(foam::eyePlane(d, clearance, clearance >= 0), direction);
    const double inverseFar = std::max(1 / 20.0, double(clearance > 0 ? s : TypeParam(0)));
    const double inverseNear = std::min(1 / 0.5, double(clearance < 0 ? s : TypeParam(2)));
    if (tNear < tFar) {
      EXPECT_NEAR(1 / inverseFar, tFar, 1e3 * this->kEpsilon * tFar);
      EXPECT_NEAR(1 / inverseNear, tNear, 1e3 * this->kEpsilon * tNear);
    } else {
      EXPECT_LE(inverseNear, inverseFar * (1 + 1e3 * this->kEpsilon));
    }
  }
}

TYPED_TEST(CellMathematics, AnEyeOnThePlaneGivesAFiniteEyePlaneOfTheRightSide) {
  using Vec3 = glm::vec<3, TypeParam>;
  for (double clearance : {0.0, 1e-38, 1e-31, -1e-31, -1e-38}) {
    const Vec3 plane = foam::eyePlane(Vec3(1, -2, 100), TypeParam(clearance), clearance >= 0);
    for (int axis = 0; axis < 3; ++axis) EXPECT_TRUE(std::isfinite(plane[axis])) << clearance;
    EXPECT_EQ(plane.x > 0, clearance >= 0) << clearance;
    // Leaving through the plane: it ends, or starts, at once.
    EXPECT_LT(1 / std::abs(glm::dot(plane, Vec3(1, 0, 0))), 1e-27);
  }
}

TYPED_TEST(CellMathematics, RoundingNeverHidesAnExitFromAnEyeOnThePlane) {
  using Vec3 = glm::vec<3, TypeParam>;
  using Exact3 = glm::vec<3, long double>;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 toNeighbour(this->point(1));
    const TypeParam radius = TypeParam(this->uniform(0.1, 1));
    // In every other case the radii cancel the distance in the offset, and the eye lies close to the site.
    const bool isCancelling = i % 2 == 0;
    const TypeParam other = isCancelling ? std::sqrt(radius * radius + glm::dot(toNeighbour, toNeighbour))
                                         : TypeParam(this->uniform(0.1, 1));
    const Exact3 d(toNeighbour), aside = glm::cross(d, Exact3(this->point(isCancelling ? 1e-3 : 1)));
    const long double r = radius, s = other;
    const long double exactOffset = (glm::dot(d, d) + (r - s) * (r + s)) / 2;
    const long double beyond = i % 4 == 3 ? 0.01L : 0;  // an eye on the neighbour's side, in units of |d|
    const Vec3 centre(aside - d * (exactOffset / glm::dot(d, d) + beyond));
    const long double exact = exactOffset + glm::dot(d, Exact3(centre));
    const TypeParam offset = foam::radicalOffset(toNeighbour, radius, other);
    const TypeParam clearance =
        foam::exitClearance(centre, toNeighbour, offset, foam::radicalClearance(centre, toNeighbour, offset));
    if (exact >= 0) {
      EXPECT_GE(clearance, TypeParam(0)) << i;
    }
    EXPECT_EQ(beyond > 0, exact < -1e-3L * glm::dot(d, d)) << i;
    if (exact < -1e-5L * (glm::length(d) * glm::length(Exact3(centre)) + glm::dot(d, d) + r * r + s * s)) {
      EXPECT_LT(clearance, TypeParam(0)) << i;
    }
  }
}

TYPED_TEST(CellMathematics, OfTwoCellsOneOwnsARayInTheirPlaneAndTheirPlanesHaveTheSameBits) {
  using Vec3 = glm::vec<3, TypeParam>;
  EXPECT_TRUE(foam::comesFirst(Vec3(1, -9, -9)));
  EXPECT_FALSE(foam::comesFirst(Vec3(-1, 9, 9)));
  EXPECT_TRUE(foam::comesFirst(Vec3(0, 1, -9)));
  EXPECT_FALSE(foam::comesFirst(Vec3(0, 0, -1)));
  EXPECT_TRUE(foam::comesFirst(Vec3(0, 0, -0.0)));  // in one point
  int differs = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 centre(this->point(3)), other(this->point(3)), d = other - centre;
    const TypeParam ri = TypeParam(this->uniform(0.5, 2)), rj = TypeParam(this->uniform(0.5, 2));
    const TypeParam own = foam::sharedClearance(centre, other, d, ri, rj),
                    its = foam::sharedClearance(other, centre, -d, rj, ri);
    EXPECT_EQ(own, -its);
    EXPECT_NE(foam::comesFirst(d), foam::comesFirst(-d));
    EXPECT_EQ(foam::eyePlane(d, own, own >= 0), foam::eyePlane(-d, its, its > 0));
    differs += foam::radicalClearance(centre, d, foam::radicalOffset(d, ri, rj)) !=
               -foam::radicalClearance(other, -d, foam::radicalOffset(-d, rj, ri));
  }
  EXPECT_GT(differs, 1000);  // each from its own site they round apart
}

// A site moved by one unit in the last place lies farther or nearer, where a dot product of one number shows no
// difference.
TYPED_TEST(CellMathematics, TheOrderAlongARayTellsSitesApartThatNearlyCoincide) {
  using Vec3 = glm::vec<3, TypeParam>;
  const TypeParam infinity = std::numeric_limits<TypeParam>::infinity();
  int alike = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 direction = glm::normalize(Vec3(this->point(1))), site(this->point(1));
    Vec3 other = site;
    other[i % 3] = std::nextafter(other[i % 3], infinity);
    const bool isFarther = direction[i % 3] > 0;
    const auto order = foam::orderAlong(direction, site), otherOrder = foam::orderAlong(direction, other);
    EXPECT_EQ(foam::liesFarther(order, otherOrder), isFarther) << i;
    EXPECT_EQ(foam::liesFarther(otherOrder, order), !isFarther) << i;
    EXPECT_FALSE(foam::liesFarther(order, order));
    alike += foam::fixedDot(direction, site) == foam::fixedDot(direction, other);
  }
  EXPECT_GT(alike, 300);
}

TYPED_TEST(CellMathematics, AnEyePlaneIsFiniteForAllLengths) {
  using Vec3 = glm::vec<3, TypeParam>;
  for (const TypeParam length : {TypeParam(1e-18), TypeParam(1), TypeParam(1e18)}) {
    for (const bool isFar : {false, true}) {
      const Vec3 plane = foam::eyePlane(Vec3(1, 0, -1) * length, TypeParam(0), isFar);
      EXPECT_TRUE(std::isfinite(glm::dot(plane, Vec3(0, 1, 0)))) << length;
      EXPECT_EQ(glm::dot(plane, Vec3(1, 0, 0)) > 0, isFar) << length;
    }
  }
}

TYPED_TEST(CellMathematics, AnExitBehindTheOriginIsOneInAllUnits) {
  using Vec3 = glm::vec<3, TypeParam>;
  for (const TypeParam unit : {TypeParam(1e-9), TypeParam(1), TypeParam(1e9), TypeParam(1e12)}) {
    const Vec3 centre = unit * Vec3(-3, 0, 1), toNeighbour = unit * Vec3(2, 0, 0);
    const TypeParam offset = foam::radicalOffset(toNeighbour, unit, unit);
    const TypeParam clearance = foam::radicalClearance(centre, toNeighbour, offset);
    EXPECT_LT(foam::exitClearance(centre, toNeighbour, offset, clearance), TypeParam(0)) << unit;
  }
}

TYPED_TEST(CellMathematics, TheFaceIsMetAtItsHeightAndAGrazedFaceFarAway) {
  using Vec3 = glm::vec<3, TypeParam>;
  const Vec3 normal(0, 0, -1);
  EXPECT_EQ(foam::intersectFace(Vec3(1, 2, 5), normal, TypeParam(-1), TypeParam(0)), TypeParam(5));
  EXPECT_EQ(foam::intersectFace(Vec3(1, 2, 5), normal, TypeParam(-1), TypeParam(0.5)),
            TypeParam(4.5));  // bumps face the eye
  for (double facing : {0.0, -0.0, 1e-13, -1e-13}) {
    const TypeParam t = foam::intersectFace(Vec3(1, 2, 5), normal, TypeParam(facing), TypeParam(0));
    EXPECT_TRUE(std::isfinite(t));
    EXPECT_GT(std::abs(t), 1e11);
    EXPECT_EQ(t > 0, facing < 0) << facing;
  }
}

// The GPU sees a face in units of the radius: normal and facing are 1 / radius long.
TYPED_TEST(CellMathematics, TheFaceOfAHugeBallIsMetWhereItsUnitNormalSays) {
  using Vec3 = glm::vec<3, TypeParam>;
  for (const double radius : {1e-15, 1.0, 2e14, 1e18}) {
    const TypeParam unit = TypeParam(1 / radius);
    const TypeParam t = foam::intersectFace(Vec3(0, 0, 0), Vec3(0, 0, unit), TypeParam(-0.0687) * unit, TypeParam(-2));
    EXPECT_NEAR(t / (2 / 0.0687 * radius), 1, 1e-6) << radius;
  }
}

}  // namespace
}  // namespace froth
