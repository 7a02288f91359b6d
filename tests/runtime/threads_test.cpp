// The calls that froth.h allows at once, at once. For the thread sanitizer; without it the pictures must
// still be right.
#include <array>
#include <atomic>
#include <deque>
#include <mutex>
#include <random>
#include <set>
#include <thread>
#include <utility>

#include "froth/froth_pool.h"
#include "froth/froth_reader.h"
#include "froth/froth_stream.h"
#include "runtime_fixture.h"
#include "tests/surroundings.h"

namespace froth {
namespace {

constexpr VkExtent2D kExtent{40, 40};

// What a thread records into.
class Recorder {
 public:
  Recorder(VkDevice device, uint32_t queueFamily) : device_(device) {
    const VkCommandPoolCreateInfo poolInfo{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0, queueFamily};
    EXPECT_EQ(vkCreateCommandPool(device, &poolInfo, nullptr, &pool_), VK_SUCCESS);
    const VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool_,
                                           VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    EXPECT_EQ(vkAllocateCommandBuffers(device, &info, &commands), VK_SUCCESS);
  }
  ~Recorder() { vkDestroyCommandPool(device_, pool_, nullptr); }
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  void begin() {
    vkResetCommandPool(device_, pool_, 0);
    const VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr, 0, nullptr};
    vkBeginCommandBuffer(commands, &info);
  }

  VkCommandBuffer commands = VK_NULL_HANDLE;

 private:
  VkDevice device_;
  VkCommandPool pool_ = VK_NULL_HANDLE;
};

class Threads : public RuntimeGpuTest {
 protected:
  class Levels;

  FrothRenderInfo infoFor(const HostImage& image) {
    auto info = makeStruct<FrothRenderInfo>();
    info.camera = makeCamera(kExtent.width, kExtent.height);
    info.camera.eye[2] = 1e6 - 1;  // where the sample lies
    info.colour = host_->describe(image);
    return info;
  }

  FrothAsset openForQueries() {
    auto info = makeStruct<FrothAssetInfo>();
    info.data = bytes_.data();
    info.dataSize = bytes_.size();
    info.keepForQueries = 1;
    FrothAsset asset{};
    EXPECT_EQ(frothOpenAsset(context_, &info, &asset), FROTH_OK);
    return asset;
  }

  std::vector<uint8_t> bytes_ = encodeSample();
};

TEST_F(Threads, RasterizeAndWalkTwoViewsWhileOthersAskAndCast) {
  createContext(host_->contextInfo());
  const FrothAsset asset = openForQueries();
  const FrothInstance instance = createInstance(asset);
  const std::array<FrothView, 2> views{createView(kExtent), createView(kExtent)};
  runFrame();
  ASSERT_EQ(statusOf(asset).state, FROTH_ASSET_READY);
  std::array<HostImage, 4> images;
  for (HostImage& image : images) image = *host_->createImage(VK_FORMAT_R32G32B32A32_SFLOAT, kExtent);
  Recorder recorders[2] = {{host_->device, host_->queueFamily}, {host_->device, host_->queueFamily}};

  std::atomic<bool> isEnding = false;
  std::thread asker([&] {
    do {
      auto requirements = makeStruct<FrothRequirements>();
      EXPECT_EQ(frothGetRequirements(vkGetInstanceProcAddr, host_->instance, host_->physicalDevice, &requirements),
                FROTH_OK);
    } while (!isEnding);
  });
  for (int frame = 0; frame < 10; ++frame) {
    runFrame();
    std::vector<std::thread> threads;
    for (size_t i = 0; i < 2; ++i) {
      threads.emplace_back([&, i] {
        recorders[i].begin();
        const FrothRenderInfo raster = infoFor(images[2 * i]), walk = infoFor(images[2 * i + 1]);
        EXPECT_EQ(frothRecordRaster(context_, views[i], recorders[i].commands, &raster), FROTH_OK);
        EXPECT_EQ(frothRecordWalk(context_, views[i], recorders[i].commands, &walk), FROTH_OK);
        vkEndCommandBuffer(recorders[i].commands);
      });
      threads.emplace_back([&] {
        FrothRay ray{};
        ray.origin[2] = 1e6 - 1;
        ray.direction[2] = 1;
        FrothRayHit hit;
        for (int cast = 0; cast < 50; ++cast) EXPECT_GE(frothCastRays(context_, nullptr, &ray, &hit, 1), FROTH_OK);
      });
    }
    for (std::thread& thread : threads) thread.join();
    const VkCommandBuffer commands[2] = {recorders[0].commands, recorders[1].commands};
    const VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO, nullptr, 0, nullptr, nullptr, 2, commands, 0, nullptr};
    ASSERT_EQ(vkQueueSubmit(host_->queue, 1, &submit, VK_NULL_HANDLE), VK_SUCCESS);
    ASSERT_EQ(vkQueueWaitIdle(host_->queue), VK_SUCCESS);
  }
  isEnding = true;
  asker.join();
  const std::vector<float> raster = *host_->readImage(images[0]), walk = *host_->readImage(images[1]);
  EXPECT_NE(raster, std::vector<float>(raster.size()));
  EXPECT_EQ(*host_->readImage(images[2]), raster);
  EXPECT_EQ(*host_->readImage(images[3]), walk);
  for (HostImage& image : images) host_->destroyImage(image);
  EXPECT_EQ(frothDestroyInstance(context_, instance), FROTH_OK);
}

TEST_F(Threads, OwnContextsOfOneDeviceShareNothing) {
  std::vector<std::thread> threads;
  for (int i = 0; i < 2; ++i) {
    threads.emplace_back([&] {
      FrothContextInfo info = host_->contextInfo();
      FrothContext* context = nullptr;
      ASSERT_EQ(frothCreateContext(&info, &context), FROTH_OK);
      auto assetInfo = makeStruct<FrothAssetInfo>();
      assetInfo.data = bytes_.data();
      assetInfo.dataSize = bytes_.size();
      FrothAsset asset{};
      EXPECT_EQ(frothOpenAsset(context, &assetInfo, &asset), FROTH_OK);
      auto viewInfo = makeStruct<FrothViewInfo>();
      viewInfo.maxExtent = kExtent;
      FrothView view{};
      EXPECT_EQ(frothCreateView(context, &viewInfo, &view), FROTH_OK);
      auto frame = makeStruct<FrothFrame>();
      frame.serial = 1;
      EXPECT_EQ(frothUpdate(context, &frame, nullptr), FROTH_OK);
      EXPECT_EQ(frothDropFrame(context, 1), FROTH_OK);
      EXPECT_EQ(frothDestroyContext(context, 0), FROTH_OK);
    });
  }
  for (std::thread& thread : threads) thread.join();
}

// Answers reads on a thread of its own.
class ReadingThread {
 public:
  ReadingThread(FrothContext* context, const std::vector<uint8_t>& bytes)
      : context_(context), bytes_(bytes), thread_([this] { run(); }) {}
  ~ReadingThread() {
    isEnding_ = true;
    thread_.join();
  }

  FrothReader reader() {
    auto reader = makeStruct<FrothReader>();
    reader.user = this;
    reader.size = bytes_.size();
    reader.read = [](void* user, uint64_t request, uint64_t offset, uint64_t size, void* destination) {
      ReadingThread& self = *static_cast<ReadingThread*>(user);
      const std::lock_guard lock(self.mutex_);
      self.asked_.push_back({request, offset, size, destination});
    };
    reader.cancel = [](void*, uint64_t) {};
    return reader;
  }

 private:
  struct Request {
    uint64_t number, offset, size;
    void* destination;
  };

  void run() {
    while (!isEnding_) {
      Request request{};
      {
        const std::lock_guard lock(mutex_);
        if (asked_.empty()) continue;
        request = asked_.front();
        asked_.pop_front();
      }
      std::memcpy(request.destination, bytes_.data() + request.offset, request.size);
      EXPECT_EQ(frothCompleteRead(context_, request.number, FROTH_OK), FROTH_OK);
    }
  }

  FrothContext* context_;
  const std::vector<uint8_t>& bytes_;
  std::mutex mutex_;
  std::deque<Request> asked_;
  std::atomic<bool> isEnding_ = false;
  std::thread thread_;
};

TEST_F(Threads, AnswerReadsWhileFramesGoOnAndAssetsAndContextsEnd) {
  const std::vector<uint8_t> bytes = encodeSample({.chunkCount = 5, .cellsPerChunk = 20, .localBits = 8});
  for (int round = 0; round < 20; ++round) {
    createContext();
    ReadingThread thread(context_, bytes);
    const FrothReader reader = thread.reader();
    auto info = makeStruct<FrothAssetInfo>();
    info.reader = &reader;
    FrothAsset loaded{}, closed{}, left{};
    for (FrothAsset* asset : {&loaded, &closed}) ASSERT_EQ(frothOpenAsset(context_, &info, asset), FROTH_OK);
    uint64_t serial = 0;
    ASSERT_EQ(update(++serial), FROTH_OK);
    ASSERT_EQ(frothCloseAsset(context_, closed), FROTH_OK);
    while (statusOf(loaded).state == FROTH_ASSET_OPENING) ASSERT_EQ(update(++serial), FROTH_OK);
    EXPECT_EQ(statusOf(loaded).state, FROTH_ASSET_READY) << lastText();
    ASSERT_EQ(frothOpenAsset(context_, &info, &left), FROTH_OK);
    ASSERT_EQ(update(++serial), FROTH_OK);
    while (frothDestroyContext(context_, UINT64_MAX) == FROTH_PENDING) std::this_thread::yield();
    context_ = nullptr;
  }
}

// An asset with levels of detail, in a context whose jobs run on threads: what it wants, and what is asked of it.
class Threads::Levels {
 public:
  explicit Levels(Threads& test) : test_(test) {
    EXPECT_EQ(frothCreateJobPool(2, &pool_), FROTH_OK);
    FrothContextInfo info = test.host_->contextInfo();
    info.runJob = frothRunInPool;
    info.jobUser = pool_;
    test.createContext(info);
    const std::filesystem::path path = test::sourceFolder() / "tests/format/golden/version_3_0.froth";
    test.bytes_.resize(std::filesystem::file_size(path));
    std::ifstream(path, std::ios::binary).read(reinterpret_cast<char*>(test.bytes_.data()), std::ssize(test.bytes_));
    asset_ = test.openForQueries();
    instance_ = test.createInstance(asset_);
    while (test.statusOf(asset_).state == FROTH_ASSET_OPENING) test.runFrame();
    EXPECT_EQ(test.statusOf(asset_).state, FROTH_ASSET_READY) << test.lastText();
    floorBytes_ = test.statusOf(asset_).deviceBytes;
  }
  ~Levels() {
    EXPECT_EQ(frothDestroyContext(std::exchange(test_.context_, nullptr), UINT64_MAX), FROTH_OK);
    frothDestroyJobPool(pool_);
  }

  // From now on: the floor, or all that there is room for.
  void want(bool isNear, bool hasRoom) {
    const FrothStreamPoint point{{0, 0, isNear ? 0.0 : 1e6}, 0, 1e-3f, 0};
    auto info = makeStruct<FrothStreamInfo>();
    info.pointCount = 1;
    info.points = &point;
    EXPECT_EQ(frothSetStreaming(test_.context_, &info), FROTH_OK) << test_.lastText();
    EXPECT_EQ(frothSetBudget(test_.context_, hasRoom ? 0 : 2 * floorBytes_), FROTH_OK) << test_.lastText();
  }
  std::set<uint32_t> drawn() const {
    uint32_t count = 0;
    EXPECT_EQ(frothGetChunks(test_.context_, asset_, 0, nullptr, &count), FROTH_OK);
    std::vector<FrothChunk> chunks(count);
    EXPECT_EQ(frothGetChunks(test_.context_, asset_, count, chunks.data(), &count), FROTH_OK);
    std::set<uint32_t> numbers;
    for (uint32_t i = 0; i < count; ++i) {
      if (chunks[i].state == FROTH_CHUNK_DRAWN) numbers.insert(i);
    }
    return numbers;
  }
  FrothStreamStatus status() const {
    auto status = makeStruct<FrothStreamStatus>();
    EXPECT_EQ(frothGetStreamStatus(test_.context_, &status), FROTH_OK);
    return status;
  }
  // All answers are from these chunks.
  void ask(uint32_t seed, const std::set<uint32_t>& chunks) const {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int i = 0; i < 20; ++i) {
      FrothRay ray{};
      for (double& value : ray.origin) value = uniform(random);
      for (double& value : ray.direction) value = uniform(random);
      FrothRayHit hit;
      EXPECT_GE(frothCastRays(test_.context_, nullptr, &ray, &hit, 1), FROTH_OK);
      EXPECT_TRUE(std::isinf(hit.distance) || chunks.contains(hit.chunk)) << hit.chunk;
      auto location = makeStruct<FrothLocation>();
      EXPECT_EQ(frothLocate(test_.context_, instance_, ray.origin, &location), FROTH_OK);
      EXPECT_TRUE(chunks.contains(location.chunk)) << location.chunk;
      auto sphere = makeStruct<FrothSphere>();
      std::copy_n(ray.origin, 3, sphere.centre);
      sphere.radius = 0.2;
      auto contact = makeStruct<FrothContact>();
      EXPECT_GE(frothOverlapSphere(test_.context_, &sphere, &contact), FROTH_OK);
      EXPECT_TRUE(contact.isTouching == 0 || chunks.contains(contact.chunk)) << contact.chunk;
    }
  }

 private:
  Threads& test_;
  FrothJobPool* pool_ = nullptr;
  FrothAsset asset_{};
  FrothInstance instance_{};
  uint64_t floorBytes_ = 0;
};

TEST_F(Threads, AskWhatIsDrawnWhileJobsBringOtherChunks) {
  Levels levels(*this);
  std::set<uint32_t> before = levels.drawn();
  uint32_t changes = 0;
  for (uint32_t frame = 0; frame < 120; ++frame) {
    if (frame % 15 == 0) levels.want(frame % 30 == 0, frame % 60 < 30);
    runFrame(0, [&](VkCommandBuffer) {
      const std::set<uint32_t> now = levels.drawn();
      changes += now != before ? 1 : 0;
      before = now;
      std::thread first([&] { levels.ask(2 * frame, now); }), second([&] { levels.ask(2 * frame + 1, now); });
      first.join();
      second.join();
    });
  }
  EXPECT_GE(changes, 2u) << "how many depends on how fast jobs are";
  EXPECT_GT(levels.status().evictions, 0u);
  EXPECT_EQ(levels.status().failures, 0u);
}

}  // namespace
}  // namespace froth
