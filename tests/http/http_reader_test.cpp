// Assets over HTTP, from a server on this machine that fails as it is told.
#include <chrono>
#include <thread>

#include <nlohmann/json.hpp>

#include "host/http_reader.h"
#include "tests/http/range_server.h"
#include "tests/runtime/reader_fixture.h"

namespace froth {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// Of the large sample: ranges that do not lie within its first 64 KiB; those that begin behind it.
constexpr uint64_t kRanges = 6, kRangesBehind = 5;

class Http : public Reader {
 protected:
  void SetUp() override {
    Reader::SetUp();
#ifndef FROTH_HAS_CURL
    FROTH_SKIP() << "no libcurl";
#endif
    writeFile("scene.froth", large_);
    server_ = std::make_unique<test::RangeServer>(folder());
    if (server_->port() == 0) FROTH_SKIP() << "no python3";
  }

  // Within a second, whatever the server does.
  void TearDown() override {
    const auto start = std::chrono::steady_clock::now();
    if (frothDestroyContext(context_, UINT64_MAX) == FROTH_PENDING) {
      reader_.reset();
      EXPECT_EQ(frothDestroyContext(context_, UINT64_MAX), FROTH_OK);
    }
    context_ = nullptr;
    reader_.reset();
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
    Reader::TearDown();
  }

  FrothAsset openUrl(const std::string& fault, const HttpOptions& options = {}) {
    Result<std::unique_ptr<HttpReader>> reader =
        HttpReader::open(server_->url(fault, "scene.froth"), context_, options);
    EXPECT_TRUE(reader) << reader.error().message;
    if (!reader) return {};
    reader_ = std::move(*reader);
    return openReader(reader_->reader());
  }

  std::string refusalOf(const std::string& url) {
    const Result<std::unique_ptr<HttpReader>> reader = HttpReader::open(url, context_);
    EXPECT_FALSE(reader);
    return reader ? "" : reader.error().message;
  }

  void waitFor(FrothAsset asset) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (stateOf(asset) == FROTH_ASSET_OPENING && std::chrono::steady_clock::now() < end) {
      runFrame();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  void expectReady(FrothAsset asset) {
    waitFor(asset);
    EXPECT_EQ(stateOf(asset), FROTH_ASSET_READY) << lastText() << ": " << reader_->lastFault();
  }

  void expectFault(FrothAsset asset, const std::string& text) {
    waitFor(asset);
    EXPECT_EQ(stateOf(asset), FROTH_ASSET_FAILED);
    EXPECT_EQ(statusOf(asset).error, FROTH_ERROR_FILE);
    EXPECT_THAT(reader_->lastFault(),
                AllOf(HasSubstr("/scene.froth: "), HasSubstr(" bytes at byte "), HasSubstr(text)));
  }

  nlohmann::json serverStats() {
    const std::string path = (folder() / "stats").string();
    const std::string get = "curl -s http://127.0.0.1:" + std::to_string(server_->port()) + "/stats -o " + path;
    EXPECT_EQ(std::system(get.c_str()), 0);
    return nlohmann::json::parse(std::ifstream(path));
  }

  std::unique_ptr<test::RangeServer> server_;
  std::unique_ptr<HttpReader> reader_;
};

TEST_F(Http, LoadsRangesSideBySideOverConnectionsThatStayOpen) {
  expectReady(openUrl("slow"));
  const nlohmann::json stats = serverStats();
  EXPECT_EQ(stats["requests"], 1 + kRanges) << "the head and what lies behind it";
  EXPECT_GE(stats["mostInFlight"], 3);
  EXPECT_LE(stats["connections"], 6 + 1) << "the last one asks for these figures";
  EXPECT_EQ(reader_->retries(), 0u);
}

TEST_F(Http, TriesAgainWhatMayPass) {
  expectReady(openUrl("flaky"));
  EXPECT_EQ(reader_->retries(), 1 + kRanges) << "each request once";
}

TEST_F(Http, TriesAgainACutTransfer) {
  expectReady(openUrl("cut"));
  EXPECT_EQ(reader_->retries(), kRangesBehind);
}

TEST_F(Http, FailsTheAssetWhereAServerGoesOnFailing) {
  expectFault(openUrl("broken"), "HTTP status 500");
  EXPECT_GE(reader_->retries(), 2u);
}

TEST_F(Http, FailsTheAssetWhereTransfersStall) {
  expectFault(openUrl("stall", {.stallSeconds = 1}), "no byte came for 1");
}

TEST_F(Http, EndsWhileTransfersStall) {
  const FrothAsset asset = openUrl("stall");
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(300);
  while (std::chrono::steady_clock::now() < end) runFrame();
  EXPECT_EQ(stateOf(asset), FROTH_ASSET_OPENING);
}  // TearDown measures

TEST_F(Http, CancelsReadsOfAnAssetThatIsClosed) {
  const FrothAsset asset = openUrl("stall");
  while (statusOf(asset).chunkCount == 0) runFrame();
  runFrame();
  EXPECT_EQ(frothCloseAsset(context_, asset), FROTH_OK);
  FrothResult ended = FROTH_PENDING;
  for (int wait = 0; ended == FROTH_PENDING && wait < 1000; ++wait) {
    ended = frothDestroyContext(context_, UINT64_MAX);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(ended, FROTH_OK) << "the reader goes on living";
  context_ = nullptr;
}

TEST_F(Http, RefusesAServerWithoutRanges) {
  EXPECT_THAT(refusalOf(server_->url("norange", "scene.froth")), HasSubstr("ignores the range"));
  expectFault(openUrl("whole"), "ignores the range");
  EXPECT_EQ(reader_->retries(), 0u);
}

TEST_F(Http, RefusesAFileThatHasChanged) { expectFault(openUrl("grown"), "bytes now, where it had"); }

TEST_F(Http, TellsWhyAUrlCannotBeOpened) {
  EXPECT_THAT(refusalOf(server_->url("plain", "none.froth")), AllOf(HasSubstr("/none.froth: "), HasSubstr("404")));
  const std::string url = server_->url("plain", "scene.froth");
  server_.reset();
  EXPECT_THAT(refusalOf(url), HasSubstr("Failed to connect"));
}

}  // namespace
}  // namespace froth
