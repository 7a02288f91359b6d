// The arrays of a foam, listed once.
#pragma once

#include "foam/foam.h"

namespace froth {

// What an array of a foam is indexed by.
enum class FoamIndex { kCell, kDetailSite, kLobe };

struct FoamArray {
  const char* name;
  FoamIndex index;
  bool canBeEmpty = false;
};

// Calls visit(FoamArray, &Foam::values) for every array of values, for whoever copies, compares or counts them all.
// `lobeOffsets` is none of them: it tells which lobes belong to a detail site.
template <class Visit>
void visitArrays(Visit&& visit) {
  visit(FoamArray{"sites", FoamIndex::kCell}, &Foam::sites);
  visit(FoamArray{"radii", FoamIndex::kCell}, &Foam::radii);
  visit(FoamArray{"densities", FoamIndex::kCell}, &Foam::densities);
  visit(FoamArray{"orientations", FoamIndex::kCell}, &Foam::orientations);
  visit(FoamArray{"detailSites", FoamIndex::kDetailSite}, &Foam::detailSites);
  visit(FoamArray{"detailHeights", FoamIndex::kDetailSite}, &Foam::detailHeights);
  visit(FoamArray{"lobeAxes", FoamIndex::kLobe}, &Foam::lobeAxes);
  visit(FoamArray{"lobeColours", FoamIndex::kLobe}, &Foam::lobeColours);
  visit(FoamArray{"baseColours", FoamIndex::kDetailSite, true}, &Foam::baseColours);
}

}  // namespace froth
