// Lenses: from a point of the image to the ray that it sees, and back.
//
// A point of the image is given as ((x - cx) / fx, (y - cy) / fy), with x, y in pixels. What that is the lens says:
// tangents of angles (pinhole, radial-tangential), angles (fisheye, Kannala-Brandt: the distance from the centre;
// equirectangular:
// longitude and latitude), or scene units (orthographic). Directions lie in the camera's axes: x right, y down, z
// forward.
//
// Sources. Fisheye: r = f theta, "equidistant". Kannala & Brandt, "A generic camera model and calibration method for
// conventional, wide-angle, and fish-eye lenses", TPAMI 28(8), 2006, equation 6 with its four odd terms after the
// first, as in OpenCV's cv::fisheye. Radial-tangential: Brown, "Decentering distortion of lenses", 1966, with the
// rational radial part of OpenCV's calib3d (cv::projectPoints). Both are given from ray to image; the other way is
// Newton's.
#ifndef FROTH_FOAM_LENS_H
#define FROTH_FOAM_LENS_H
#include "prelude.h"

#if defined(__cplusplus)
// GLSL's atan of two arguments.
FOAM_FN real atan(real y, real x) { return std::atan2(y, x); }
#endif

const int kLensPinhole = 0;
const int kLensFisheye = 1;           // equidistant
const int kLensKannalaBrandt = 2;     // first = (k1, k2, k3, k4)
const int kLensRadialTangential = 3;  // first = (k1, k2, p1, p2), second = (k3, k4, k5, k6)
const int kLensEquirectangular = 4;
const int kLensRayMap = 5;  // a direction per pixel, which the caller gives
const int kLensOrthographic = 6;

// Newton's steps take far fewer; a guard that halves an interval reaches float's last place.
const int kMostLensSteps = 60;
// Where a distortion stops to grow is looked for at this many angles.
const int kLensAngles = 4096;

// Half a turn; and the largest angle whose tangent a radial-tangential lens may see: its rays all point forward.
FOAM_FN real lensPi(real) { return real(3.14159265358979323846); }
FOAM_FN real steepestLensAngle(real) { return real(1.57); }

// Distance from the image's centre of a ray at an angle from the axis, and its derivative. Square: theta^2.
FOAM_FN real kannalaBrandtRadius(real theta, real4 k) {
  real square = theta * theta;
  return theta * (real(1) + square * (k.x + square * (k.y + square * (k.z + square * k.w))));
}

FOAM_FN real kannalaBrandtSlope(real theta, real4 k) {
  real square = theta * theta;
  return real(1) +
         square * (real(3) * k.x + square * (real(5) * k.y + square * (real(7) * k.z + square * real(9) * k.w)));
}

// The radial part of a radial-tangential lens at a squared distance from the axis: numerator, denominator and
// their derivatives with respect to the square.
FOAM_FN real4 radialParts(real square, real4 first, real4 second) {
  return real4(real(1) + square * (first.x + square * (first.y + square * second.x)),
               real(1) + square * (second.y + square * (second.z + square * second.w)),
               first.x + square * (real(2) * first.y + square * real(3) * second.x),
               second.y + square * (real(2) * second.z + square * real(3) * second.w));
}

FOAM_FN real radialFactor(real4 parts) { return parts.x / parts.y; }
// d factor / d square.
FOAM_FN real radialGrowth(real4 parts) { return (parts.z * parts.y - parts.x * parts.w) / (parts.y * parts.y); }

// d(r factor)/dr: how fast a ray moves away from the centre of the image as it leaves the axis.
FOAM_FN real radialSlope(real radius, real4 first, real4 second) {
  real square = radius * radius;
  real4 parts = radialParts(square, first, second);
  if (!(parts.y > real(0))) return real(-1);
  return radialFactor(parts) + real(2) * square * radialGrowth(parts);
}

// Up to where the lens maps one ray to one point [Kannala-Brandt: angle; radial-tangential: tangent]: points that no
// ray within reaches see nothing. Other lenses: unused, 0.
FOAM_FN real lensRange(int kind, real4 first, real4 second) {
  bool isRadial = kind == kLensRadialTangential;
  if (!isRadial && kind != kLensKannalaBrandt) return real(0);
  real largest = isRadial ? steepestLensAngle(first.x) : lensPi(first.x);
  real reached = real(0);
  for (int i = 1; i <= kLensAngles; ++i) {
    real angle = largest * (real(i) / real(kLensAngles));
    real extent = isRadial ? tan(angle) : angle;
    real slope = isRadial ? radialSlope(extent, first, second) : kannalaBrandtSlope(extent, first);
    if (!(slope > real(0))) break;
    reached = extent;
  }
  return reached;
}

// The extent in [0, range] that a lens maps to `radius` [>= 0], by Newton's method inside a shrinking interval; the end
// of the range where radius lies beyond.
FOAM_FN real invertRadius(bool isRadial, real radius, real4 first, real4 second, real range) {
  real low = real(0);
  real high = range;
  real extent = min(radius, range);
  for (int i = 0; i < kMostLensSteps; ++i) {
    real found, slope;
    if (isRadial) {
      found = extent * radialFactor(radialParts(extent * extent, first, second));
      slope = radialSlope(extent, first, second);
    } else {
      found = kannalaBrandtRadius(extent, first);
      slope = kannalaBrandtSlope(extent, first);
    }
    if (found < radius) {
      low = extent;
    } else {
      high = extent;
    }
    real next = extent - (found - radius) / slope;
    if (next == extent) break;
    extent = next > low && next < high ? next : real(0.5) * (low + high);
  }
  return extent;
}

// A point of the image at `radius` from the centre, seen at `theta` from the axis.
FOAM_FN real3 directionAtAngle(real2 point, real radius, real theta) {
  real scale = radius > real(0) ? sin(theta) / radius : real(0);
  return real3(point.x * scale, point.y * scale, cos(theta));
}

FOAM_FN bool kannalaBrandtRay(real2 point, real4 k, real range, FOAM_OUT(real3) direction) {
  real radius = sqrt(point.x * point.x + point.y * point.y);
  direction = directionAtAngle(point, radius, invertRadius(false, radius, k, k, range));
  return radius <= kannalaBrandtRadius(range, k);
}

// Where a ray with the tangents `ray` meets the image of a radial-tangential lens, and the derivative of that, a
// symmetric matrix (xx, xy, yy).
FOAM_FN real2 distortTangents(real2 ray, real4 first, real4 second, FOAM_OUT(real3) jacobian) {
  real x = ray.x;
  real y = ray.y;
  real square = x * x + y * y;
  real4 parts = radialParts(square, first, second);
  real factor = radialFactor(parts);
  real growth = real(2) * radialGrowth(parts);
  real p1 = first.z;
  real p2 = first.w;
  jacobian =
      real3(factor + x * x * growth + real(2) * p1 * y + real(6) * p2 * x, x * y * growth + real(2) * (p1 * x + p2 * y),
            factor + y * y * growth + real(6) * p1 * y + real(2) * p2 * x);
  return real2(x * factor + real(2) * p1 * x * y + p2 * (square + real(2) * x * x),
               y * factor + p1 * (square + real(2) * y * y) + real(2) * p2 * x * y);
}

// From the solution of the radial part alone. Valid: the ray lies in the range, the lens does not fold there, and it
// maps the ray back to the point.
FOAM_FN bool radialTangentialRay(real2 point, real4 first, real4 second, real range, FOAM_OUT(real3) direction) {
  real radius = sqrt(point.x * point.x + point.y * point.y);
  real extent = invertRadius(true, radius, first, second, range);
  real2 ray = point * (radius > real(0) ? extent / radius : real(1));
  real3 jacobian = real3(real(1), real(0), real(1));
  real determinant = real(1);
  real2 miss = real2(real(0), real(0));
  for (int i = 0; i < kMostLensSteps; ++i) {
    miss = distortTangents(ray, first, second, jacobian) - point;
    determinant = jacobian.x * jacobian.z - jacobian.y * jacobian.y;
    if (!(determinant > real(0))) break;
    real2 next =
        ray - real2(jacobian.z * miss.x - jacobian.y * miss.y, jacobian.x * miss.y - jacobian.y * miss.x) / determinant;
    real2 moved = next - ray;
    ray = next;
    if (dot(moved, moved) <= real(1e-14) * (real(1) + dot(ray, ray))) break;
  }
  direction = real3(ray.x, ray.y, real(1));
  return determinant > real(0) && dot(ray, ray) <= range * range &&
         dot(miss, miss) <= real(1e-8) * (real(1) + dot(point, point));
}

// Each direction once: beyond half a turn of longitude or a quarter of latitude there is none.
FOAM_FN bool equirectangularRay(real2 point, FOAM_OUT(real3) direction) {
  real slack = real(1) + real(1e-6);
  real pi = lensPi(point.x) * slack;
  direction = real3(sin(point.x) * cos(point.y), sin(point.y), cos(point.x) * cos(point.y));
  return abs(point.x) <= pi && abs(point.y) <= real(0.5) * pi;
}

// Direction of the ray that a point of the image sees, not normalized; false: it sees nothing. An orthographic lens
// sees along the axis; its rays start at (point, 0). A ray map's directions lie outside of this.
FOAM_FN bool lensRay(int kind, real2 point, real4 first, real4 second, real range, FOAM_OUT(real3) direction) {
  direction = real3(real(0), real(0), real(1));
  if (kind == kLensFisheye) {
    real theta = sqrt(dot(point, point));
    direction = directionAtAngle(point, theta, theta);
    return theta <= lensPi(theta);
  }
  if (kind == kLensKannalaBrandt) return kannalaBrandtRay(point, first, range, direction);
  if (kind == kLensRadialTangential) return radialTangentialRay(point, first, second, range, direction);
  if (kind == kLensEquirectangular) return equirectangularRay(point, direction);
  if (kind == kLensPinhole) direction = real3(point.x, point.y, real(1));
  return true;
}

// The other way: the point of the image that a direction of any length [> 0] is seen at; false: nowhere. Not of ray
// maps and orthographic lenses.
FOAM_FN bool lensPoint(int kind, real3 direction, real4 first, real4 second, real range, FOAM_OUT(real2) point) {
  real2 across = real2(direction.x, direction.y);
  real extent = sqrt(dot(across, across));
  point = real2(real(0), real(0));
  if (kind == kLensPinhole || kind == kLensRadialTangential) {
    if (!(direction.z > real(0))) return false;
    point = across / direction.z;
    if (kind == kLensPinhole) return true;
    bool isInRange = dot(point, point) <= range * range;
    real3 jacobian;
    point = distortTangents(point, first, second, jacobian);
    return isInRange && jacobian.x * jacobian.z > jacobian.y * jacobian.y;
  }
  if (kind == kLensEquirectangular) {
    point = real2(atan(direction.x, direction.z),
                  atan(direction.y, sqrt(direction.x * direction.x + direction.z * direction.z)));
    return true;
  }
  real theta = atan(extent, direction.z);
  real radius = kind == kLensKannalaBrandt ? kannalaBrandtRadius(theta, first) : theta;
  if (extent > real(0)) point = across * (radius / extent);
  return kind == kLensFisheye ? extent > real(0) || direction.z > real(0) : theta <= range;
}

#include "postlude.h"
#endif
