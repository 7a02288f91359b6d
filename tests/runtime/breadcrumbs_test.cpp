// Which passes the GPU has begun and finished: in a frame that is complete, not submitted, or hangs.
#include "froth/froth_breadcrumbs.h"

#include <chrono>
#include <thread>

#include "froth/froth_composite.h"
#include "runtime_fixture.h"

namespace froth {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// What the functions below do and see.
std::vector<std::string> openLabels;
std::string hangingPass;  // its first dispatch waits for `event`; empty: none
VkEvent event = VK_NULL_HANDLE;
uint32_t marks = 0;  // fills of a single number

VKAPI_ATTR void VKAPI_CALL beginLabel(VkCommandBuffer, const VkDebugUtilsLabelEXT* label) {
  openLabels.emplace_back(label->pLabelName);
}

VKAPI_ATTR void VKAPI_CALL endLabel(VkCommandBuffer) { openLabels.pop_back(); }

void hangIfWanted(VkCommandBuffer commands) {
  if (openLabels.empty() || openLabels.back() != hangingPass) return;
  vkCmdWaitEvents(commands, 1, &event, VK_PIPELINE_STAGE_HOST_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, nullptr, 0,
                  nullptr, 0, nullptr);
  hangingPass.clear();
}

VKAPI_ATTR void VKAPI_CALL dispatch(VkCommandBuffer commands, uint32_t x, uint32_t y, uint32_t z) {
  hangIfWanted(commands);
  vkCmdDispatch(commands, x, y, z);
}

VKAPI_ATTR void VKAPI_CALL fill(VkCommandBuffer commands, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size,
                                uint32_t value) {
  marks += size == sizeof(value);
  vkCmdFillBuffer(commands, buffer, offset, size, value);
}

PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name) {
  const auto is = [&](const char* other) { return std::strcmp(name, other) == 0; };
  if (is("vkCmdBeginDebugUtilsLabelEXT")) return reinterpret_cast<PFN_vkVoidFunction>(beginLabel);
  if (is("vkCmdEndDebugUtilsLabelEXT")) return reinterpret_cast<PFN_vkVoidFunction>(endLabel);
  if (is("vkCmdDispatch")) return reinterpret_cast<PFN_vkVoidFunction>(dispatch);
  if (is("vkCmdFillBuffer")) return reinterpret_cast<PFN_vkVoidFunction>(fill);
  return vkGetDeviceProcAddr(device, name);
}

PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name) {
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0) return reinterpret_cast<PFN_vkVoidFunction>(getDeviceProcAddr);
  return vkGetInstanceProcAddr(instance, name);
}

// "R0 cull +": call, eye, pass; begun and finished: +, begun: ?, neither: -
std::string shortOf(const FrothBreadcrumb& crumb) {
  const char* state = crumb.isFinished ? " +" : crumb.isBegun ? " ?" : " -";
  return crumb.call[std::strlen("frothRecord")] + std::to_string(crumb.eye) + ' ' + crumb.pass + state;
}

class Breadcrumbs : public RuntimeGpuTest {
 protected:
  void TearDown() override {
    for (HostImage& image : images_) host_->destroyImage(image);
    RuntimeGpuTest::TearDown();
  }

  FrothContextInfo infoWith(uint32_t breadcrumbs) {
    FrothContextInfo info = host_->contextInfo();
    info.getInstanceProcAddr = getInstanceProcAddr;
    info.breadcrumbs = breadcrumbs;
    info.compositeFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
    return info;
  }

  // A foam, and a view of two eyes.
  void prepare(uint32_t breadcrumbs) {
    createContext(infoWith(breadcrumbs));
    auto viewInfo = makeStruct<FrothViewInfo>();
    viewInfo.maxExtent = {16, 16};
    viewInfo.eyeCount = 2;
    ASSERT_EQ(frothCreateView(context_, &viewInfo, &view_), FROTH_OK) << lastText();
    for (HostImage& image : images_) image = *host_->createImage(VK_FORMAT_R16G16B16A16_SFLOAT, {16, 16});
    createInstance(openBytes(encodeSample()));
    marks = 0;
  }

  FrothRenderInfo drawing(uint32_t eye) {
    auto draw = makeStruct<FrothRenderInfo>();
    draw.camera = makeCamera(16, 16);
    draw.colour = host_->describe(images_[eye]);
    draw.eye = eye;
    return draw;
  }

  void raster(VkCommandBuffer commands) {
    const FrothRenderInfo draw = drawing(0);
    EXPECT_EQ(frothRecordRaster(context_, view_, commands, &draw), FROTH_OK) << lastText();
  }

  void walk(VkCommandBuffer commands) {
    const FrothRenderInfo draw = drawing(1);
    EXPECT_EQ(frothRecordWalk(context_, view_, commands, &draw), FROTH_OK) << lastText();
  }

  void composite(VkCommandBuffer commands) {
    auto info = makeStruct<FrothCompositeInfo>();
    info.eye = 1;
    info.foam = host_->describeInput(images_[1]);
    info.target = host_->describeInput(images_[0]);
    EXPECT_EQ(frothRecordComposite(context_, view_, commands, &info), FROTH_OK) << lastText();
  }

  std::vector<FrothBreadcrumb> list() {
    uint32_t count = 0;
    EXPECT_EQ(frothGetBreadcrumbs(context_, 0, nullptr, &count), FROTH_OK) << lastText();
    std::vector<FrothBreadcrumb> crumbs(count);
    EXPECT_EQ(frothGetBreadcrumbs(context_, count, crumbs.data(), &count), FROTH_OK) << lastText();
    EXPECT_EQ(count, crumbs.size());
    return crumbs;
  }

  std::vector<std::string> listShort() {
    std::vector<std::string> found;
    for (const FrothBreadcrumb& crumb : list()) found.push_back(shortOf(crumb));
    return found;
  }

  FrothView view_{};
  HostImage images_[2];
};

// A command buffer that is submitted without waiting.
class Submission {
 public:
  explicit Submission(const Host& host) : host_(host) {
    VkCommandPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool.queueFamilyIndex = host.queueFamily;
    vkCreateCommandPool(host.device, &pool, nullptr, &pool_);
    VkCommandBufferAllocateInfo buffer{};
    buffer.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    buffer.commandPool = pool_;
    buffer.commandBufferCount = 1;
    vkAllocateCommandBuffers(host.device, &buffer, &commands);
    VkFenceCreateInfo fence{};
    fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    vkCreateFence(host.device, &fence, nullptr, &fence_);
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    vkBeginCommandBuffer(commands, &begin);
  }
  ~Submission() {
    vkDestroyFence(host_.device, fence_, nullptr);
    vkDestroyCommandPool(host_.device, pool_, nullptr);
  }
  Submission(const Submission&) = delete;
  Submission& operator=(const Submission&) = delete;

  void end() const { EXPECT_EQ(vkEndCommandBuffer(commands), VK_SUCCESS); }
  void submit() const {
    VkSubmitInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands;
    EXPECT_EQ(vkQueueSubmit(host_.queue, 1, &info, fence_), VK_SUCCESS);
  }
  void wait() const { EXPECT_EQ(vkWaitForFences(host_.device, 1, &fence_, VK_TRUE, UINT64_MAX), VK_SUCCESS); }

  VkCommandBuffer commands = VK_NULL_HANDLE;

 private:
  const Host& host_;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  VkFence fence_ = VK_NULL_HANDLE;
};

TEST_F(Breadcrumbs, AreFinishedAfterACompleteFrame) {
  prepare(1);
  const uint64_t serial = host_->nextSerial();
  runFrame(0, [&](VkCommandBuffer commands) {
    raster(commands);
    walk(commands);
    composite(commands);
  });
  EXPECT_THAT(listShort(), ElementsAre("R0 cull +", "R0 sort +", "R0 bin +", "R0 raster +", "W1 cull +", "W1 shade +",
                                       "W1 walk +", "C1 composite +"));
  for (const FrothBreadcrumb& crumb : list()) {
    EXPECT_EQ(crumb.serial, serial);
    EXPECT_EQ(crumb.view.index, view_.index);
    EXPECT_EQ(crumb.view.generation, view_.generation);
  }
}

TEST_F(Breadcrumbs, OfAFrameThatIsNotSubmittedAreNotBegunAndGoWhenItIsDropped) {
  prepare(1);
  for (int frame = 0; frame < 40; ++frame) runFrame(0, [&](VkCommandBuffer commands) { raster(commands); });
  const std::vector<std::string> before = listShort();
  EXPECT_THAT(before, ::testing::Each(::testing::EndsWith("+"))) << "from the places of older frames";
  const uint64_t serial = host_->nextSerial();
  for (uint64_t dropped = 0; dropped < 40; ++dropped) {
    auto frame = makeStruct<FrothFrame>();
    frame.serial = serial + dropped;
    frame.completedSerial = serial - 1;
    ASSERT_EQ(frothUpdate(context_, &frame, nullptr), FROTH_OK) << lastText();
    const Submission never(*host_);
    walk(never.commands);
    never.end();
    std::vector<std::string> newest = listShort();
    newest.erase(newest.begin(), newest.end() - 3);
    EXPECT_THAT(newest, ElementsAre("W1 cull -", "W1 shade -", "W1 walk -"));
    ASSERT_EQ(frothDropFrame(context_, serial + dropped), FROTH_OK);
  }
  const std::vector<std::string> left = listShort();
  EXPECT_THAT(left, ::testing::Each(::testing::StartsWith("R0")));
  EXPECT_GT(left.size() + 4, before.size()) << "they took the places of one frame";
}

TEST_F(Breadcrumbs, TellInWhichPassTheGpuHangs) {
  prepare(1);
  runFrame();
  VkEventCreateInfo eventInfo{};
  eventInfo.sType = VK_STRUCTURE_TYPE_EVENT_CREATE_INFO;
  ASSERT_EQ(vkCreateEvent(host_->device, &eventInfo, nullptr, &event), VK_SUCCESS);
  hangingPass = "bin";
  ASSERT_EQ(update(host_->nextSerial()), FROTH_OK) << lastText();
  {
    const Submission hung(*host_);
    raster(hung.commands);
    hung.end();
    ASSERT_EQ(hangingPass, "") << "the wait is recorded";
    hung.submit();
    const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!list()[2].isBegun && std::chrono::steady_clock::now() < limit) std::this_thread::yield();
    EXPECT_THAT(listShort(), ElementsAre("R0 cull +", "R0 sort +", "R0 bin ?", "R0 raster -"));
    EXPECT_EQ(vkSetEvent(host_->device, event), VK_SUCCESS);
    hung.wait();
  }
  EXPECT_THAT(listShort(), ElementsAre("R0 cull +", "R0 sort +", "R0 bin +", "R0 raster +"));
  vkDestroyEvent(host_->device, event, nullptr);
}

TEST_F(Breadcrumbs, OfALostDeviceStayUntilItIsRestored) {
  prepare(1);
  runFrame(0, [&](VkCommandBuffer commands) { raster(commands); });
  const std::vector<std::string> before = listShort();
  ASSERT_EQ(frothDeviceLost(context_), FROTH_OK);
  EXPECT_EQ(listShort(), before);
  for (const uint32_t again : {1u, 0u}) {  // with them, and then without
    FrothContextInfo info = infoWith(again);
    info.onMessage = logMessage;
    info.messageUser = &messages_;
    ASSERT_EQ(frothRestoreDevice(context_, &info), FROTH_OK) << lastText();
    if (again) {
      EXPECT_THAT(listShort(), IsEmpty());
    }
    runFrame(0, [&](VkCommandBuffer commands) {
      const FrothRenderInfo draw = drawing(0);
      EXPECT_GE(frothRecordRaster(context_, view_, commands, &draw), 0) << lastText();
    });
    ASSERT_EQ(frothDeviceLost(context_), FROTH_OK);
  }
}

TEST_F(Breadcrumbs, AreNotRecordedUnlessTheContextWantsThem) {
  prepare(0);
  runFrame(0, [&](VkCommandBuffer commands) { raster(commands); });
  EXPECT_EQ(marks, 0u);
  uint32_t count = 0;
  EXPECT_EQ(frothGetBreadcrumbs(context_, 0, nullptr, &count), FROTH_ERROR_UNSUPPORTED);
  EXPECT_THAT(lastText(), HasSubstr("FrothContextInfo::breadcrumbs"));
  frothDestroyContext(context_, UINT64_MAX);
  for (HostImage& image : images_) host_->destroyImage(image);
  prepare(1);
  runFrame(0, [&](VkCommandBuffer commands) { raster(commands); });
  EXPECT_EQ(marks, 8u);
}

TEST_F(Breadcrumbs, AreCopiedAsFarAsThereIsRoom) {
  prepare(1);
  runFrame(0, [&](VkCommandBuffer commands) { raster(commands); });
  FrothBreadcrumb crumbs[3] = {};
  uint32_t count = 0;
  EXPECT_EQ(frothGetBreadcrumbs(context_, 2, crumbs, &count), FROTH_OK);
  EXPECT_EQ(count, 4u);
  EXPECT_STREQ(crumbs[1].pass, "sort");
  EXPECT_EQ(crumbs[2].pass, nullptr);
  EXPECT_EQ(frothGetBreadcrumbs(context_, 2, nullptr, &count), FROTH_ERROR_ARGUMENT);
  EXPECT_THAT(lastText(), HasSubstr("breadcrumbs: null, with capacity 2"));
  EXPECT_EQ(frothGetBreadcrumbs(context_, 2, crumbs, nullptr), FROTH_ERROR_ARGUMENT);
}

using NullBreadcrumbs = RuntimeTest;

TEST_F(NullBreadcrumbs, AreNone) {
  FrothContextInfo info = nullContextInfo();
  info.breadcrumbs = 1;
  createContext(info);
  createView({16, 16});
  uint32_t count = 1;
  EXPECT_EQ(frothGetBreadcrumbs(context_, 0, nullptr, &count), FROTH_OK);
  EXPECT_EQ(count, 0u);
}

}  // namespace
}  // namespace froth
