// Points of a scene that came without: places that several photos show alike.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "reference/capture/capture.h"
#include "trainer/photos/photos.h"

namespace froth {

struct MatchedPoints {
  std::vector<CapturedPoint> points;  // with the units of the photos' views
  std::vector<uint32_t> observers;    // indices of photos, ascending for each point
};

// A sweep along the rays of random pixels (Collins 1996): at each depth the surroundings of the pixel are compared with
// what photos taken nearby show there, and the depth counts where they are most alike, if no other depth comes near.
// Photos are reduced for it, so a point is exact to a pixel of an image of some 200. Nothing is found where photos have
// no structure, and none at all where they were taken from one place. The same photos and seed give the same bits, on
// any number of threads.
MatchedPoints matchPoints(std::span<const Photo> photos, uint64_t seed);

// Where a capture has points at fewer than 50 places, those that its training photos show take their place, if they are
// as many. Returns how many were found; 0: the capture is as it was. photos: those of `training`, views in the
// capture's units.
uint32_t replaceFewPoints(Capture& capture, std::span<const uint32_t> training, std::span<const Photo> photos,
                          uint64_t seed);

}  // namespace froth
