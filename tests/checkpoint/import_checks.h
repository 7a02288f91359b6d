// What several tests of the importer ask.
#pragma once

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foam/checkpoint/checkpoint.h"
#include "tests/checkpoint/checkpoint_builder.h"

namespace froth {

inline Result<Foam> importBytes(const std::string& bytes) {
  return importCheckpointBytes({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, "model.pt");
}

inline Result<Foam> importSpec(const CheckpointSpec& checkpoint) { return importBytes(buildCheckpoint(checkpoint)); }

// The import fails as bad input, and the message names the file and holds `part`.
inline void expectRefusal(const Result<Foam>& result, const std::string& part) {
  ASSERT_FALSE(result) << "imported, expected: " << part;
  EXPECT_EQ(result.error().kind, ErrorKind::kBadInput);
  EXPECT_THAT(result.error().message, testing::StartsWith("model.pt"));
  EXPECT_THAT(result.error().message, testing::HasSubstr(part));
}

inline void expectSameFoam(const Foam& a, const Foam& b) {
  EXPECT_EQ(a.cellCount, b.cellCount);
  EXPECT_EQ(a.detailCount, b.detailCount);
  EXPECT_EQ(a.lobeCount, b.lobeCount);
  EXPECT_TRUE(a.sites == b.sites);
  EXPECT_TRUE(a.radii == b.radii);
  EXPECT_TRUE(a.densities == b.densities);
  EXPECT_TRUE(a.orientations == b.orientations);
  EXPECT_TRUE(a.detailSites == b.detailSites);
  EXPECT_TRUE(a.detailHeights == b.detailHeights);
  EXPECT_TRUE(a.lobeAxes == b.lobeAxes);
  EXPECT_TRUE(a.lobeColours == b.lobeColours);
}

}  // namespace froth
