// Files that others wrote. Found through FROTH_DATA, by default beside the repository; skipped where they are
// absent.
#include <cstdlib>
#include <filesystem>
#include <span>

#include "foam/checkpoint/checkpoint_views.h"
#include "foam/checkpoint/mapped_file.h"
#include "foam/checkpoint/pickle_writer.h"
#include "foam/checkpoint/zip_reader.h"
#include "tests/checkpoint/import_checks.h"
#include "tests/surroundings.h"

namespace froth {
namespace {

using test::dataFolder;

class PublishedFoam : public testing::Test {
 protected:
  std::filesystem::path find(const char* name) const { return dataFolder() / "foams" / name / "model.pt"; }
  void SetUp() override {
    if (!std::filesystem::exists(find("miku_plush")) || !std::filesystem::exists(find("tankard_rough"))) {
      FROTH_SKIP() << "no trained foams in " << dataFolder() << " (set FROTH_DATA)";
    }
  }
};

TEST_F(PublishedFoam, MikuPlushHasItsCellsDetailsAndLobes) {
  const Result<Foam> foam = importCheckpoint(find("miku_plush"));
  ASSERT_TRUE(foam) << foam.error().message;
  EXPECT_EQ(foam->cellCount, 39'999u);
  EXPECT_EQ(foam->detailCount, 8u);
  EXPECT_EQ(foam->lobeCount, 8u);
  // Read with Python's zipfile and struct.
  EXPECT_EQ(foam->sites[0], glm::vec3(-4.729837894439697f, 2.7020556926727295f, 2.604684829711914f));
  EXPECT_EQ(foam->radii[0], 0.11314577137258607f);
  EXPECT_EQ(foam->densities[0], 8.882392883300781f);
  EXPECT_EQ(foam->lobeAxes.back().z, -3.5871329307556152f);
  EXPECT_EQ(foam->lobeColours.back().z, -0.21790830790996552f);
}

TEST_F(PublishedFoam, TankardRoughHasItsCellsDetailsAndLobes) {
  const Result<Foam> foam = importCheckpoint(find("tankard_rough"));
  ASSERT_TRUE(foam) << foam.error().message;
  EXPECT_EQ(foam->cellCount, 59'999u);
  EXPECT_EQ(foam->detailCount, 4u);
  EXPECT_EQ(foam->lobeCount, 2u);
}

TEST_F(PublishedFoam, ComesBackBitByBitFromItsExport) {
  const Result<Foam> foam = importCheckpoint(find("tankard_rough"));
  ASSERT_TRUE(foam) << foam.error().message;
  const std::filesystem::path copy = std::filesystem::path(testing::TempDir()) / "froth_tankard_rough.pt";
  ASSERT_TRUE(exportCheckpoint(copy, *foam));
  const Result<Foam> read = importCheckpoint(copy);
  std::filesystem::remove(copy);
  ASSERT_TRUE(read) << read.error().message;
  expectSameFoam(*foam, *read);
}

// So that whatever loads the published files loads ours: the pickle of the same shapes is the same, byte for
// byte.
TEST_F(PublishedFoam, HasThePickleThatTheExporterWrites) {
  for (const char* name : {"miku_plush", "tankard_rough"}) {
    const Result<MappedFile> file = MappedFile::open(find(name));
    ASSERT_TRUE(file) << file.error().message;
    const Result<ZipArchive> archive = readZipArchive({file->bytes(), name});
    ASSERT_TRUE(archive) << archive.error().message;
    const ZipMember* pickle = archive->find("model/data.pkl");
    ASSERT_TRUE(pickle);
    const auto entries = readPickledTensors({pickle->bytes, name});
    ASSERT_TRUE(entries) << entries.error().message;
    std::vector<TensorDeclaration> declarations;
    for (const PickledEntry& entry : *entries) {
      declarations.push_back({entry.key, entry.tensor.type, entry.tensor.shape});
    }
    EXPECT_TRUE(pickleTensors(declarations) == std::string(pickle->bytes.begin(), pickle->bytes.end())) << name;
  }
}

TEST(MalformedFiles, OfOtherFormatsAreAllRefused) {
  const std::filesystem::path folder = dataFolder() / "malformed";
  if (!std::filesystem::exists(folder)) {
    FROTH_SKIP() << "no " << folder << " (set FROTH_DATA)";
  }
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const Result<Foam> foam = importCheckpoint(entry.path());
    ASSERT_FALSE(foam) << entry.path();
    EXPECT_EQ(foam.error().kind, ErrorKind::kBadInput);
    EXPECT_THAT(foam.error().message, testing::StartsWith(entry.path().string()));
  }
}

}  // namespace
}  // namespace froth
