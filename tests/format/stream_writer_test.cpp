// Writing chunk by chunk: the same file as at once, nothing left behind, and values that do not fit refused
// by name.
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/temporary_file.h"
#include "file_surgery.h"
#include "format/read/asset_reader.h"
#include "format/write/asset_writer.h"
#include "sample_asset.h"

namespace froth {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

template <class T>
std::string errorOf(const Result<T>& result) {
  return result ? "no error" : result.error().message;
}
std::string errorOf(const Status& status) { return status ? "no error" : status.error().message; }

AssetContents fourChunks() {
  return makeSampleAsset({.chunkCount = 4,
                          .cellsPerChunk = 20,
                          .localBits = 8,
                          .isQuantized = true,
                          .hasLayers = true,
                          .codebookSize = 7});
}

// A folder of its own for each test.
class StreamWriter : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              (std::string("froth_stream_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    path_ = folder_ / "scene.froth";
  }
  void TearDown() override { fs::remove_all(folder_); }

  size_t countFiles() const {
    return static_cast<size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator{}));
  }

  fs::path folder_, path_;
};

TEST_F(StreamWriter, WritesTheSameBytesOnAnyNumberOfThreads) {
  const AssetContents contents = fourChunks();
  AssetContents header = contents;
  header.chunks.clear();
  header.statistics = {};
  for (const size_t threadCount : {size_t{1}, size_t{2}, size_t{4}}) {
    Result<AssetStreamWriter> writer = AssetStreamWriter::create(path_, header);
    ASSERT_TRUE(writer) << writer.error().message;
    std::vector<EncodedChunk> encoded(contents.chunks.size());
    std::vector<std::thread> threads;
    for (size_t thread = 0; thread < threadCount; ++thread) {
      threads.emplace_back([&, thread] {
        for (size_t i = thread; i < encoded.size(); i += threadCount) {
          if (Result<EncodedChunk> chunk = writer->encodeChunk(contents.chunks[i])) encoded[i] = std::move(*chunk);
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    for (EncodedChunk& chunk : encoded) ASSERT_EQ(errorOf(writer->append(std::move(chunk))), "no error");
    const Result<uint64_t> size = writer->finish(contents);
    ASSERT_EQ(errorOf(size), "no error");
    const std::vector<uint8_t> bytes = *readFile(path_);
    EXPECT_EQ(*size, bytes.size());
    EXPECT_EQ(bytes, encodeOrFail(contents));
  }
  EXPECT_EQ(countFiles(), 1u);
}

TEST_F(StreamWriter, LeavesNothingBehindIfItIsNotFinished) {
  ASSERT_TRUE(writeFileAtomically(path_, std::vector<uint8_t>{1, 2, 3}));
  {
    Result<AssetStreamWriter> writer = AssetStreamWriter::create(path_, fourChunks());
    ASSERT_TRUE(writer) << writer.error().message;
    ASSERT_TRUE(writer->append(std::move(*writer->encodeChunk(fourChunks().chunks[0]))));
    EXPECT_EQ(countFiles(), 1u) << "what is not finished has no name";
  }
  EXPECT_EQ(countFiles(), 1u);
  EXPECT_EQ(*readFile(path_), (std::vector<uint8_t>{1, 2, 3}));
}

TEST_F(StreamWriter, StopsBetweenSectionsOnRequest) {
  Result<AssetStreamWriter> writer = AssetStreamWriter::create(path_, fourChunks());
  ASSERT_TRUE(writer) << writer.error().message;
  int looks = 0;
  const Result<EncodedChunk> chunk = writer->encodeChunk(fourChunks().chunks[0], [&] { return ++looks == 3; });
  ASSERT_FALSE(chunk);
  EXPECT_EQ(chunk.error().kind, ErrorKind::kCancelled);
  EXPECT_EQ(looks, 3);
}

TEST_F(StreamWriter, FindsAGhostWhoseCellNeverCame) {
  AssetContents contents = fourChunks();
  contents.chunks.pop_back();
  EXPECT_THAT(errorOf(writeAsset(path_, contents)),
              HasSubstr("a ghost lives in cell 19 of chunk 3, which is not there"));
  EXPECT_EQ(countFiles(), 0u);
}

TEST_F(StreamWriter, RefusesATargetThatIsNoFile) {
  fs::create_directory(path_);
  EXPECT_THAT(errorOf(AssetStreamWriter::create(path_, fourChunks())), HasSubstr("no regular file"));
  EXPECT_THAT(errorOf(AssetStreamWriter::create(folder_ / "no" / "a.froth", fourChunks())),
              AllOf(HasSubstr("a.froth: cannot be created"), HasSubstr("check folder, rights and free space")));
}

// Stands in for a disk that is full after that many bytes of one file. Ends the process: 0 if writing failed
// as it should.
[[noreturn]] void writeUnderSizeLimit(const fs::path& path, const AssetContents& contents, rlim_t limit) {
  const rlimit limits{limit, limit};
  ::setrlimit(RLIMIT_FSIZE, &limits);
  std::signal(SIGXFSZ, SIG_IGN);
  const Status status = writeAsset(path, contents);
  const bool isTold = !status && status.error().kind == ErrorKind::kIo &&
                      status.error().message.find("cannot be written") != std::string::npos;
  std::_Exit(isTold ? 0 : 1);
}

TEST_F(StreamWriter, LeavesTheOldFileAndNoOtherWhereverTheDiskIsFull) {
  ASSERT_TRUE(writeFileAtomically(path_, std::vector<uint8_t>{1, 2, 3}));
  const AssetContents contents = fourChunks();
  const size_t size = encodeOrFail(contents).size();
  for (const size_t limit : {size_t{0}, size_t{100}, size / 4, size / 2, size - 1}) {
    EXPECT_EXIT(writeUnderSizeLimit(path_, contents, limit), testing::ExitedWithCode(0), "") << limit;
    EXPECT_EQ(*readFile(path_), (std::vector<uint8_t>{1, 2, 3}));
    EXPECT_EQ(countFiles(), 1u);
  }
}

// ---- Leftovers ----

// A process that is killed while it writes `target`.
void leaveATemporary(const fs::path& target) {
  const pid_t child = ::fork();
  if (child == 0) {
    Result<TemporaryFile> file = TemporaryFile::create(target);
    if (file) (void)file->append(std::vector<uint8_t>(1000));
    ::kill(::getpid(), SIGKILL);
  }
  int state = 0;
  ASSERT_EQ(::waitpid(child, &state, 0), child);
  ASSERT_TRUE(WIFSIGNALED(state));
}

TEST_F(StreamWriter, RemovesWhatAKilledOneLeft) {
  leaveATemporary(path_);
  ASSERT_EQ(countFiles(), 1u);
  ASSERT_EQ(errorOf(writeAsset(path_, fourChunks())), "no error");
  EXPECT_EQ(countFiles(), 1u);
  EXPECT_EQ(errorOf(verifyAsset(path_)), "no error");
}

TEST_F(StreamWriter, LeavesLeftoversOfOtherFilesAlone) {
  leaveATemporary(folder_ / "other.froth");
  leaveATemporary(folder_ / "scene.froth.tmp-x.froth");
  std::ofstream(folder_ / "scene.froth.tmp-notes") << "mine";
  ASSERT_EQ(errorOf(writeAsset(path_, fourChunks())), "no error");
  EXPECT_EQ(countFiles(), 4u);
}

TEST_F(StreamWriter, LeavesTheTemporariesOfAnotherThatStillWritesAlone) {
  Result<TemporaryFile> other = TemporaryFile::create(path_);
  ASSERT_TRUE(other) << other.error().message;
  ASSERT_TRUE(other->append(std::vector<uint8_t>{4, 5}));
  ASSERT_EQ(errorOf(writeAsset(path_, fourChunks())), "no error");
  EXPECT_EQ(countFiles(), 2u);
  ASSERT_EQ(errorOf(other->replaceTarget()), "no error");
  EXPECT_EQ(*readFile(path_), (std::vector<uint8_t>{4, 5}));
  EXPECT_EQ(countFiles(), 1u);
}

// ---- Values off their lattice ----

std::string errorAfter(void (*edit)(ChunkContents&)) {
  AssetContents contents = makeSampleAsset({.isQuantized = true, .hasLayers = true, .codebookSize = 7});
  edit(contents.chunks[0]);
  return errorOf(encodeAsset(contents));
}

TEST(Lattice, RefusesAValueOffItByTheNameOfItsAttribute) {
  EXPECT_THAT(errorAfter([](ChunkContents& c) { c.sites[1].z += 0x1p-13f; }),
              AllOf(HasSubstr("chunk 0, section 'sites': number 5"), HasSubstr("off its lattice; snap it")));
  EXPECT_THAT(errorAfter([](ChunkContents& c) { c.sites[1].z = 0x1p13f; }), HasSubstr("section 'sites'"));
  EXPECT_THAT(errorAfter([](ChunkContents& c) { c.radii[2] += 0x1p-12f; }), HasSubstr("section 'radii': number 2"));
  EXPECT_THAT(errorAfter([](ChunkContents& c) { c.densities[0] += 0x1p-10f; }), HasSubstr("section 'densities'"));
  EXPECT_THAT(errorAfter([](ChunkContents& c) {
                c.orientations[1] = {0.6f, 0.8f, 0, 0};
              }),
              HasSubstr("section 'orientations': number 4"));
  EXPECT_THAT(errorAfter([](ChunkContents& c) { c.cellColours[0].x = 0.5001f; }), HasSubstr("section 'cell_colours'"));
  EXPECT_THAT(errorAfter([](ChunkContents& c) { c.cellColours[0].y = -2; }), HasSubstr("'cell_colours': number 1"));
  EXPECT_THAT(errorAfter([](ChunkContents& c) { c.cellHeights[1] += 0x1p-10f; }), HasSubstr("section 'cell_heights'"));
  EXPECT_THAT(errorAfter([](ChunkContents& c) { c.detailSites[0].x += 0x1p-6f; }), HasSubstr("section 'detail_sites'"));
  EXPECT_THAT(errorAfter([](ChunkContents& c) { c.detailHeights[3] += 0x1p-10f; }),
              HasSubstr("'detail_heights': number 3"));
  EXPECT_THAT(errorAfter([](ChunkContents& c) { c.baseColours[0].z += 0x1p-6f; }), HasSubstr("section 'base_colours'"));
  EXPECT_THAT(errorAfter([](ChunkContents& c) { c.lobeAxes[1].z += 0x1p-11f; }),
              HasSubstr("section 'lobe_labels': number 1"));
  EXPECT_THAT(errorAfter([](ChunkContents& c) { c.lobeColours[0].x += 0x1p-6f; }), HasSubstr("section 'lobe_colours'"));
}

TEST(Lattice, RefusesANumberThatIsNotFinite) {
  EXPECT_THAT(errorAfter([](ChunkContents& c) { c.lobeColours[0].x = NAN; }),
              HasSubstr("lobe_colours: number 0 is nan"));
}

// Axes without codebook lie on the lattice themselves.
TEST(Lattice, RefusesAnAxisOffItWithoutACodebook) {
  AssetContents contents = makeSampleAsset({.isQuantized = true});
  contents.chunks[0].lobeAxes[2].y += 0x1p-5f;
  EXPECT_THAT(errorOf(encodeAsset(contents)), HasSubstr("section 'lobe_axes': number 7"));
}

TEST(Lattice, EveryOctahedralNormalIsItsOwnNearestOne) {
  for (const uint32_t bits : {4u, 5u, 8u}) {
    const uint32_t count = (1u << bits) - 1;
    for (uint32_t y = 0; y < count; ++y) {
      for (uint32_t z = 0; z < count; ++z) {
        const glm::vec4 orientation = orientationOfNormal({y, z}, bits);
        const glm::dvec4 q(orientation);
        const glm::dvec3 normal(1 - 2 * (q.z * q.z + q.w * q.w), 2 * (q.y * q.z - q.x * q.w),
                                2 * (q.y * q.w + q.x * q.z));
        ASSERT_EQ(orientationOfNormal(normalIndices(normal, bits), bits), orientation) << bits << " " << y << " " << z;
      }
    }
  }
}

}  // namespace
}  // namespace froth
