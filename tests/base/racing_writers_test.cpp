// Writers of one file, each of which removes leftovers before it starts, take nothing from each other.
#include <atomic>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "base/atomic_file.h"

namespace froth::test {
namespace {

TEST(RacingWriters, AllEndWellAndTheFileIsWhole) {
  std::string folder = (std::filesystem::temp_directory_path() / "froth_race_XXXXXX").string();
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  const std::filesystem::path path = std::filesystem::path(folder) / "out.froth";
  std::atomic<int> failures{0};
  const auto write = [&](uint8_t mark) {
    const std::vector<uint8_t> bytes(1000, mark);
    for (int i = 0; i < 300; ++i) failures += !writeFileAtomically(path, bytes);
  };
  std::vector<std::thread> writers;
  for (uint8_t mark = 1; mark <= 4; ++mark) writers.emplace_back(write, mark);
  for (std::thread& writer : writers) writer.join();

  EXPECT_EQ(failures, 0);
  const Result<std::vector<uint8_t>> found = readFile(path);
  ASSERT_TRUE(found);
  EXPECT_EQ(*found, std::vector<uint8_t>(1000, found->at(0)));
  EXPECT_EQ(std::filesystem::remove_all(folder), 2u);  // folder and file
}

}  // namespace
}  // namespace froth::test
