// An engine's archive: it keeps what Froth asks of it, and answers when the test says so.
#pragma once

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "froth/froth_reader.h"
#include "runtime_fixture.h"

namespace froth {

struct Archive {
  struct Request {
    uint64_t number, offset, size;
    void* destination;
  };

  FrothContext* const& context;
  std::vector<uint8_t> bytes;
  bool answersWithinRead = false, answersWithinCancel = false;
  std::vector<Request> pending{};     // in the order of the calls
  std::vector<Request> asked{};       // the same, with those that are answered
  std::vector<uint64_t> cancelled{};  // numbers
  uint64_t mostPending = 0, mostPendingBytes = 0;

  static void read(void* user, uint64_t request, uint64_t offset, uint64_t size, void* destination) {
    Archive& archive = *static_cast<Archive*>(user);
    archive.pending.push_back({request, offset, size, destination});
    archive.asked.push_back(archive.pending.back());
    archive.mostPending = std::max<uint64_t>(archive.mostPending, archive.pending.size());
    uint64_t pendingBytes = 0;
    for (const Request& kept : archive.pending) pendingBytes += kept.size;
    archive.mostPendingBytes = std::max(archive.mostPendingBytes, pendingBytes);
    if (archive.answersWithinRead) {
      EXPECT_EQ(archive.answer(archive.pending.size() - 1), FROTH_OK);
    }
  }

  static void cancel(void* user, uint64_t request) {
    Archive& archive = *static_cast<Archive*>(user);
    archive.cancelled.push_back(request);
    if (!archive.answersWithinCancel) return;
    const auto isIt = [&](const Request& kept) { return kept.number == request; };
    const auto found = std::ranges::find_if(archive.pending, isIt);
    EXPECT_EQ(archive.answer(static_cast<size_t>(found - archive.pending.begin()), FROTH_ERROR_STATE), FROTH_OK);
  }

  FrothReader reader() {
    auto reader = makeStruct<FrothReader>();
    reader.user = this;
    reader.name = "packed scene";
    reader.size = bytes.size();
    reader.read = read;
    reader.cancel = cancel;
    return reader;
  }

  // Brings the bytes, whatever the answer is.
  FrothResult answer(size_t index, FrothResult result = FROTH_OK) {
    const Request request = pending[index];
    pending.erase(pending.begin() + static_cast<ptrdiff_t>(index));
    const uint64_t end = std::min<uint64_t>(request.offset + request.size, bytes.size());
    if (end > request.offset) std::memcpy(request.destination, bytes.data() + request.offset, end - request.offset);
    return frothCompleteRead(context, request.number, result);
  }

  void answerAll(FrothResult result = FROTH_OK) {
    while (!pending.empty()) EXPECT_EQ(answer(0, result), FROTH_OK);
  }
};

inline FrothAssetInfo infoOf(const FrothReader& reader) {
  auto info = makeStruct<FrothAssetInfo>();
  info.reader = &reader;
  return info;
}

// Without a device.
class Reader : public RuntimeTest {
 protected:
  void SetUp() override { createContext(); }

  void TearDown() override {
    archive_.answerAll(FROTH_ERROR_STATE);
    RuntimeTest::TearDown();
  }

  FrothAsset open(std::vector<uint8_t> bytes, uint32_t layers = 0) {
    archive_.bytes = std::move(bytes);
    return openReader(archive_.reader(), layers);
  }

  FrothAsset openReader(const FrothReader& reader, uint32_t layers = 0) {
    FrothAssetInfo info = infoOf(reader);
    info.layers = layers;
    FrothAsset asset{};
    EXPECT_EQ(frothOpenAsset(context_, &info, &asset), FROTH_OK) << lastText();
    return asset;
  }

  void runFrame() {
    ASSERT_EQ(update(++serial_), FROTH_OK) << lastText();
    ASSERT_EQ(frothRecordUpload(context_, nullptr), FROTH_OK);
  }

  FrothAssetState stateOf(FrothAsset asset) { return statusOf(asset).state; }

  // Answers whatever is asked for, in every frame.
  void load(FrothAsset asset) {
    for (int frame = 0; frame < 100 && stateOf(asset) == FROTH_ASSET_OPENING; ++frame) {
      runFrame();
      archive_.answerAll();
    }
  }

  // It has failed, with one message, and frames go on.
  void expectFailure(FrothAsset asset, FrothResult error) {
    runFrame();
    EXPECT_EQ(stateOf(asset), FROTH_ASSET_FAILED);
    EXPECT_EQ(statusOf(asset).error, error) << frothResultName(statusOf(asset).error);
    ASSERT_EQ(messages_.size(), 1u);
    EXPECT_EQ(messages_[0].object, "packed scene");
    const size_t asked = archive_.asked.size();
    runFrame();
    EXPECT_EQ(archive_.asked.size(), asked) << "nothing is read for it any more";
    EXPECT_EQ(messages_.size(), 1u);
    EXPECT_EQ(frothCloseAsset(context_, asset), FROTH_OK);
  }

  Archive archive_{context_, {}};
  uint64_t serial_ = 0;
  const std::vector<uint8_t> small_ = encodeSample({.chunkCount = 3, .localBits = 16});
  // Of each layer more than the first read.
  const std::vector<uint8_t> large_ = encodeSample(
      {.chunkCount = 4, .cellsPerChunk = 60, .localBits = 8, .detailCount = 16, .lobeCount = 16, .hasLayers = true});
};

}  // namespace froth
