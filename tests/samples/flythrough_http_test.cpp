// froth_flythrough with an asset on an HTTP server.
#include <chrono>
#include <cstdlib>
#include <memory>

#include <gmock/gmock.h>

#include "tests/http/range_server.h"
#include "tests/samples/level_gallery.h"

namespace froth::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class FlythroughHttp : public LevelGallery {
 protected:
  void SetUp() override {
#ifndef FROTH_HAS_CURL
    FROTH_SKIP() << "no libcurl";
#endif
    LevelGallery::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    server_ = std::make_unique<RangeServer>(folder_);
    if (server_->port() == 0) FROTH_SKIP() << "no python3";
  }

  ProgramRun fly(const std::string& asset, const std::string& output) const {
    return runProgram(FROTH_FLYTHROUGH,
                      {asset, "--headless", "--validate", "--size", "96x64", "--cameras", "cameras.json", "--frames",
                       "2", "--settled", "-o", output},
                      folder_);
  }

  std::unique_ptr<RangeServer> server_;
};

TEST_F(FlythroughHttp, ShowsWhatTheFileShowsThoughTheServerFailsNowAndThen) {
  const ProgramRun file = fly("gallery.froth", "file");
  ASSERT_EQ(file.exitCode, 0) << file.err;
  for (const char* fault : {"plain", "cut"}) {
    const ProgramRun run = fly(server_->url(fault, "gallery.froth"), fault);
    ASSERT_EQ(run.exitCode, 0) << run.err;
    for (const char* frame : {"frame_0000.png", "frame_0001.png"}) {
      EXPECT_EQ(readBytes(folder_ / fault / frame), readBytes(folder_ / "file" / frame)) << fault;
    }
  }
}

TEST_F(FlythroughHttp, TellsWhatTheServerAnswered) {
  const ProgramRun none = fly(server_->url("plain", "none.froth"), "none");
  EXPECT_EQ(none.exitCode, 3);
  EXPECT_THAT(none.err, HasSubstr("/plain/none.froth: cannot be read: HTTP status 404"));
  const ProgramRun broken = fly(server_->url("broken", "gallery.froth"), "broken");
  EXPECT_EQ(broken.exitCode, 3);
  EXPECT_THAT(broken.err, AllOf(HasSubstr("the reader answered FROTH_ERROR_FILE"), HasSubstr("HTTP status 500")));
}

}  // namespace
}  // namespace froth::test
