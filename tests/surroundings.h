// What a test finds around it: the repository's files, data beside it, programs, and what it does without them.
// Environment variables take the place of compiled-in paths, so that a packed suite runs anywhere (scripts/test-gpu).
#pragma once

#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <gtest/gtest.h>

namespace froth::test {

inline std::filesystem::path pathFrom(const char* variable, const std::filesystem::path& otherwise) {
  const char* value = std::getenv(variable);
  return value ? std::filesystem::path(value) : otherwise;
}

// FROTH_SOURCE, else the folder that was built.
inline std::filesystem::path sourceFolder() { return pathFrom("FROTH_SOURCE", FROTH_SOURCE_DIR); }

// Real foams and scenes: FROTH_DATA, else ../shared/data beside the repository.
inline std::filesystem::path dataFolder() { return pathFrom("FROTH_DATA", sourceFolder() / "../shared/data"); }

// A program that was built: the one of its name in FROTH_PROGRAMS, if there is one, else itself.
inline std::filesystem::path programPath(const std::filesystem::path& built) {
  const std::filesystem::path packed = pathFrom("FROTH_PROGRAMS", built.parent_path()) / built.filename();
  return std::filesystem::exists(packed) ? packed : built;
}

// FROTH_REQUIRE_ALL=1, as .ci/run sets it: what a test needs must be there.
inline bool isAllRequired() {
  const char* value = std::getenv("FROTH_REQUIRE_ALL");
  return value && std::strcmp(value, "1") == 0;
}

}  // namespace froth::test

// Leaves a test that lacks a device, layers, data or a program: FROTH_SKIP() << "no ..."; fails it where all is
// required.
#define FROTH_SKIP()                                                 \
  return GTEST_MESSAGE_(                                             \
      ::froth::test::isAllRequired() ? "FROTH_REQUIRE_ALL=1: " : "", \
      ::froth::test::isAllRequired() ? ::testing::TestPartResult::kFatalFailure : ::testing::TestPartResult::kSkip)
