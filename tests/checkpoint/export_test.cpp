#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "base/atomic_file.h"
#include "foam/cech_pairs.h"
#include "foam/cell_graph.h"
#include "foam/checkpoint/zip_reader.h"
#include "foam/checkpoint/zip_writer.h"
#include "tests/checkpoint/import_checks.h"

namespace froth {
namespace {

std::string readAll(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Foam randomFoam(uint32_t cells, uint32_t details, uint32_t lobes) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> number(-1, 1), positive(0.01f, 0.5f);
  Foam foam;
  foam.cellCount = cells;
  foam.detailCount = details;
  foam.lobeCount = lobes;
  for (uint32_t i = 0; i < cells; ++i) {
    foam.sites.emplace_back(number(random), number(random), number(random));
    foam.radii.push_back(positive(random));
    foam.densities.push_back(i % 3 == 0 ? 0 : 40 * positive(random));
    foam.orientations.push_back(glm::normalize(glm::vec4(number(random), number(random), number(random), 1)));
  }
  for (uint32_t i = 0; i < cells * details; ++i) {
    foam.detailSites.emplace_back(number(random), number(random));
    foam.detailHeights.push_back(number(random));
  }
  for (uint32_t i = 0; i < cells * details * lobes; ++i) {
    foam.lobeAxes.emplace_back(number(random), number(random), number(random));
    foam.lobeColours.emplace_back(number(random), number(random), number(random));
  }
  return foam;
}

// A folder of its own, removed with all that is in it.
class ExportCheckpoint : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directory(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::vector<std::string> filesInFolder() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      names.push_back(entry.path().filename());
    }
    return names;
  }

  const std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) /
      (std::string("froth_export_") + testing::UnitTest::GetInstance()->current_test_info()->name());
  const std::filesystem::path path_ = folder_ / "model.pt";
};

TEST_F(ExportCheckpoint, WritesWhatTheImporterReadsBackBitByBit) {
  for (const auto& [details, lobes] : {std::pair{1u, 1u}, {8u, 8u}, {3u, 2u}}) {
    const Foam foam = randomFoam(50, details, lobes);
    const Status written = exportCheckpoint(path_, foam);
    ASSERT_TRUE(written) << written.error().message;
    const Result<Foam> read = importCheckpoint(path_);
    ASSERT_TRUE(read) << read.error().message;
    expectSameFoam(foam, *read);
  }
}

TEST_F(ExportCheckpoint, WritesASingleCellWithoutNeighbours) {
  const Foam foam = randomFoam(1, 1, 1);
  ASSERT_TRUE(exportCheckpoint(path_, foam));
  const Result<Foam> read = importCheckpoint(path_);
  ASSERT_TRUE(read) << read.error().message;
  expectSameFoam(foam, *read);
}

TEST_F(ExportCheckpoint, GivesTheSameBytesForTheSameFoam) {
  const Foam foam = randomFoam(20, 2, 2);
  ASSERT_TRUE(exportCheckpoint(path_, foam));
  const std::string first = readAll(path_);
  ASSERT_TRUE(exportCheckpoint(path_, foam));
  EXPECT_TRUE(readAll(path_) == first);
}

TEST_F(ExportCheckpoint, StoresTheCechGraphOfTheSpheres) {
  const Foam foam = randomFoam(50, 1, 1);
  ASSERT_TRUE(exportCheckpoint(path_, foam));
  const std::string bytes = readAll(path_);
  const NamedBytes file{{reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, "model.pt"};
  const Result<ZipArchive> archive = readZipArchive(file);
  ASSERT_TRUE(archive) << archive.error().message;
  const CellGraph expected = findCechPairs(foam.sites, foam.radii);
  ASSERT_FALSE(expected.neighbours.empty());
  const auto holds = [&](const char* name, const std::vector<uint32_t>& numbers) {
    const ZipMember* member = archive->find(name);
    return member && std::string(member->bytes.begin(), member->bytes.end()) == packNumbers(numbers);
  };
  EXPECT_TRUE(holds("model/data/8", expected.neighbours));
  EXPECT_TRUE(holds("model/data/9", expected.offsets));
}

TEST_F(ExportCheckpoint, RefusesFoamsThatCouldNotBeReadBack) {
  const auto refuse = [&](void (*spoil)(Foam&), const char* part) {
    Foam foam = randomFoam(4, 1, 1);
    spoil(foam);
    const Status status = exportCheckpoint(path_, foam);
    ASSERT_FALSE(status) << part;
    EXPECT_EQ(status.error().kind, ErrorKind::kUsage);
    EXPECT_THAT(status.error().message, testing::HasSubstr(part));
  };
  refuse([](Foam& foam) { foam.radii[2] = 0; }, "radius <= 0");
  refuse([](Foam& foam) { foam.densities[2] = -1; }, "density < 0");
  refuse([](Foam& foam) { foam.sites[2].y = NAN; }, "sites hold nan at place 2");
  refuse([](Foam& foam) { foam.lobeAxes.pop_back(); }, "3 lobeAxes");
  refuse([](Foam& foam) { foam = Foam{}; }, "0 cells");
  refuse([](Foam& foam) { foam.orientations[2] = {}; }, "orientation of length 0");
  EXPECT_TRUE(filesInFolder().empty());
}

TEST_F(ExportCheckpoint, LeavesTheOldFileAndNoOtherWhenStopped) {
  std::ofstream(path_) << "old";
  const Status status = exportCheckpoint(path_, randomFoam(4, 1, 1), [](auto, auto, auto) { return false; });
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().kind, ErrorKind::kCancelled);
  EXPECT_EQ(readAll(path_), "old");
  EXPECT_THAT(filesInFolder(), testing::ElementsAre("model.pt"));
}

TEST_F(ExportCheckpoint, SaysWhereItCannotWrite) {
  const Status status = exportCheckpoint(folder_ / "missing" / "model.pt", randomFoam(1, 1, 1));
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().kind, ErrorKind::kIo);
  EXPECT_THAT(status.error().message, testing::HasSubstr("missing"));
  EXPECT_FALSE(exportCheckpoint(folder_, randomFoam(1, 1, 1))) << "a directory";
}

TEST(ZipWriter, PutsLargeMembersIntoZip64RecordsThatTheReaderReads) {
  std::string bytes;
  const auto sink = [&](std::span<const uint8_t> piece) {
    bytes.append(piece.begin(), piece.end());
    return Status{};
  };
  ZipWriter writer(sink, /*zip64From=*/100);
  const std::string small = "small", large(150, 'x');
  ASSERT_TRUE(writer.add("a", small) && writer.add("b", large) && writer.add("c", small) && writer.finish());
  const NamedBytes file{{reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()}, "model.pt"};
  const Result<ZipArchive> archive = readZipArchive(file);
  ASSERT_TRUE(archive) << archive.error().message;
  for (const auto& [name, content] : {std::pair{"a", small}, {"b", large}, {"c", small}}) {
    const ZipMember* member = archive->find(name);
    ASSERT_TRUE(member);
    EXPECT_EQ(std::string(member->bytes.begin(), member->bytes.end()), content);
    EXPECT_TRUE(checkZipMember(file, *member));
    EXPECT_EQ((member->bytes.data() - file.bytes.data()) % 64, 0);
  }
}

TEST(ZipWriter, PassesTheSinksErrorOn) {
  ZipWriter writer([](std::span<const uint8_t>) -> Status { return Error{ErrorKind::kIo, "disk full"}; });
  const Status status = writer.add("a", "bytes");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().message, "disk full");
}

}  // namespace
}  // namespace froth
