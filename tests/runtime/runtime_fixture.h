// What the tests of the public API share: a log of messages, contexts with and without a device, frames.
#pragma once

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "format/write/asset_writer.h"
#include "froth/froth_query.h"
#include "host/host.h"
#include "host/make_struct.h"
#include "tests/format/sample_asset.h"
#include "tests/kept_pipelines.h"

namespace froth {

struct LoggedMessage {
  FrothSeverity severity;
  FrothResult code;
  std::string object, text;
};

inline void logMessage(void* user, FrothSeverity severity, FrothResult code, const char* object, const char* text) {
  static_cast<std::vector<LoggedMessage>*>(user)->push_back({severity, code, object, text});
}

// A null context by default: everything but the GPU.
class RuntimeTest : public ::testing::Test {
 protected:
  void TearDown() override {
    frothDestroyContext(context_, UINT64_MAX);
    std::filesystem::remove_all(folder_);
  }

  void createContext(FrothContextInfo info = nullContextInfo()) {
    info.onMessage = logMessage;
    info.messageUser = &messages_;
    ASSERT_EQ(frothCreateContext(&info, &context_), FROTH_OK) << lastText();
  }

  static FrothContextInfo nullContextInfo() {
    auto info = makeStruct<FrothContextInfo>();
    info.abiVersion = FROTH_ABI_VERSION;
    return info;
  }

  std::string lastText() const { return messages_.empty() ? "no message" : messages_.back().text; }

  std::filesystem::path folder() {
    if (folder_.empty()) {
      std::string name = (std::filesystem::temp_directory_path() / "froth_test_XXXXXX").string();
      folder_ = mkdtemp(name.data());
    }
    return folder_;
  }

  std::string writeFile(const std::string& name, const std::vector<uint8_t>& bytes) {
    const std::filesystem::path path = folder() / name;
    std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
    return path.string();
  }

  static std::vector<uint8_t> encodeSample(const SampleOptions& options = {}) {
    Result<std::vector<uint8_t>> bytes = encodeAsset(makeSampleAsset(options));
    EXPECT_TRUE(bytes);
    return *bytes;
  }

  FrothAsset openBytes(std::vector<uint8_t> givenBytes) {
    const std::vector<uint8_t>& bytes = openedBytes_.emplace_back(std::move(givenBytes));
    auto info = makeStruct<FrothAssetInfo>();
    info.data = bytes.data();
    info.dataSize = bytes.size();
    FrothAsset asset{};
    EXPECT_EQ(frothOpenAsset(context_, &info, &asset), FROTH_OK) << lastText();
    return asset;
  }

  FrothAsset openPath(const std::string& path) {
    auto info = makeStruct<FrothAssetInfo>();
    info.path = path.c_str();
    FrothAsset asset{};
    EXPECT_EQ(frothOpenAsset(context_, &info, &asset), FROTH_OK) << lastText();
    return asset;
  }

  FrothAssetStatus statusOf(FrothAsset asset) {
    auto status = makeStruct<FrothAssetStatus>();
    EXPECT_EQ(frothGetAssetStatus(context_, asset, &status), FROTH_OK) << lastText();
    return status;
  }

  FrothInstance createInstance(FrothAsset asset) {
    auto info = makeStruct<FrothInstanceInfo>();
    info.asset = asset;
    FrothInstance instance{};
    EXPECT_EQ(frothCreateInstance(context_, &info, &instance), FROTH_OK) << lastText();
    return instance;
  }

  FrothView createView(VkExtent2D maxExtent) {
    auto info = makeStruct<FrothViewInfo>();
    info.maxExtent = maxExtent;
    FrothView view{};
    EXPECT_EQ(frothCreateView(context_, &info, &view), FROTH_OK) << lastText();
    return view;
  }

  // Of a frame that follows a completed one.
  FrothResult update(uint64_t serial, uint64_t uploadBytes = 0) {
    auto frame = makeStruct<FrothFrame>();
    frame.serial = serial;
    frame.completedSerial = serial - 1;
    frame.uploadBytes = uploadBytes;
    return frothUpdate(context_, &frame, nullptr);
  }

  FrothContext* context_ = nullptr;
  std::vector<LoggedMessage> messages_;

 private:
  std::filesystem::path folder_;
  std::list<std::vector<uint8_t>> openedBytes_;  // kept while assets load from them
};

// The device of all tests of the program, with core and synchronization validation; null, and the test fails, if there
// is none. It stays to the end: the loader unloads a driver with its last instance, and of NVIDIA's (580.159) the 31st
// load in a process failed: vkCreateInstance gave VK_ERROR_INCOMPATIBLE_DRIVER.
inline Host* sharedHost() {
  static const Result<std::unique_ptr<Host>> host = Host::create({.device = "", .useValidation = true});
  EXPECT_TRUE(host) << host.error().message;
  return host ? host->get() : nullptr;
}

// A context on the shared device, whose validation layers must stay silent.
class RuntimeGpuTest : public RuntimeTest {
 protected:
  void SetUp() override {
    host_ = sharedHost();
    ASSERT_NE(host_, nullptr);
  }

  void TearDown() override {
    RuntimeTest::TearDown();
    if (host_) {
      EXPECT_THAT(host_->validationMessages(), ::testing::IsEmpty());
      host_->forgetValidationMessages();  // they are of this test alone
    }
  }

  // On the shared device contexts share what shaders compile to.
  void createContext(FrothContextInfo info = nullContextInfo()) {
    if (info.device == sharedHost()->device && info.getInstanceProcAddr == vkGetInstanceProcAddr) {
      info.getInstanceProcAddr = test::getInstanceProcAddrKeepingPipelines;
    }
    RuntimeTest::createContext(info);
  }

  // One frame: update, upload, then `record`. It is submitted and waited for.
  void runFrame(uint64_t uploadBytes = 0, const std::function<void(VkCommandBuffer)>& record = {}) {
    ASSERT_EQ(update(host_->nextSerial(), uploadBytes), FROTH_OK) << lastText();
    const Status status = host_->submit([&](VkCommandBuffer commands, uint64_t) {
      EXPECT_EQ(frothRecordUpload(context_, commands), FROTH_OK) << lastText();
      if (record) record(commands);
      return Status();
    });
    ASSERT_TRUE(status) << status.error().message;
  }

  Host* host_ = nullptr;  // the shared one, unless a test has its own
};

// A camera at the origin that looks along +z with a square field of 90 degrees.
inline FrothCamera makeCamera(uint32_t width, uint32_t height) {
  FrothCamera camera{};
  camera.viewFromWorld[0] = camera.viewFromWorld[4] = camera.viewFromWorld[8] = 1;
  camera.clipFromView[0] = camera.clipFromView[5] = 1;
  camera.clipFromView[11] = 1;     // w = z
  camera.clipFromView[14] = 0.1f;  // depth: infinite, reversed
  camera.viewport = {0, 0, static_cast<float>(width), static_cast<float>(height), 0, 1};
  return camera;
}

// Of 16 x 16 pixels in GENERAL, for checks that a null context makes: no call looks behind its handles.
inline FrothImage fakeImage(VkFormat format) {
  FrothImage image{};
  image.image = reinterpret_cast<VkImage>(1);
  image.view = reinterpret_cast<VkImageView>(1);
  image.format = format;
  image.extent = {16, 16};
  image.layoutIn = image.layoutOut = VK_IMAGE_LAYOUT_GENERAL;
  image.stageIn = VK_PIPELINE_STAGE_2_COPY_BIT;
  return image;
}

}  // namespace froth
