// A change of cuts in views that fade, beside a view that does not, in the same frames.
#include <gtest/gtest.h>

#include "tests/levels/streamed.h"
#include "tests/same_bits.h"

namespace froth::test {
namespace {

constexpr uint32_t kFadeFrames = 3;
constexpr VkExtent2D kDrawn = {64, 48}, kWhole = {96, 64};
constexpr VkOffset2D kCorner = {19, 9};
constexpr double kHalfStep = 1.0 / 1024;  // relative, of halves, in whatever way they are rounded

// What one view drew.
struct Picture {
  std::vector<float> colour, distance, id;
  FrothResult result = FROTH_OK;
};

struct Pictures {
  Picture faded, plain;
};

std::vector<float> mixed(const std::vector<float>& a, const std::vector<float>& b, double weight) {
  std::vector<float> values(a.size());
  for (size_t i = 0; i < a.size(); ++i) values[i] = static_cast<float>(a[i] + weight * (b[i] - a[i]));
  return values;
}

double largestChange(const std::vector<float>& a, const std::vector<float>& b) {
  double largest = 0;
  for (size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(double{a[i]} - double{b[i]}));
  return largest;
}

FrothView createView(FrothContext* context, uint32_t fadeFrames, bool keepsHits = true) {
  auto info = makeStruct<FrothViewInfo>();
  info.maxExtent = kDrawn;
  info.measurePasses = 1;
  info.keepsHits = keepsHits;
  info.fadeFrames = fadeFrames;
  FrothView view{};
  check(frothCreateView(context, &info, &view), "frothCreateView");
  return view;
}

// One view that fades and one that does not see a part of images, which a scene's depth covers to the left.
class Fading {
 public:
  explicit Fading(VkFormat colour = VK_FORMAT_R32G32B32A32_SFLOAT)
      : stage_(levelSample(), kDrawn, sharedContext(), 0, 0, true, 0, false),
        fading_(createView(context(), kFadeFrames)),
        plain_(createView(context(), 0)),
        depth_(*sharedHost().createImage(VK_FORMAT_R32_SFLOAT, kWhole)) {
    std::vector<float> depths(kWhole.width * kWhole.height, 0.0f);
    for (size_t i = 0; i < depths.size(); ++i) depths[i] = i % kWhole.width < kWhole.width / 2 ? 0.01f / 5 : 0;
    EXPECT_TRUE(sharedHost().writeImage(depth_, depths));
    for (Images* images : {&fadedImages_, &plainImages_}) {
      images->colour = *sharedHost().createImage(colour, kWhole);
      images->distance = *sharedHost().createImage(VK_FORMAT_R32_SFLOAT, kWhole);
      images->id = *sharedHost().createImage(VK_FORMAT_R32G32_UINT, kWhole);
      for (const auto& [image, channels] : {std::pair(images->colour, 4), {images->distance, 1}, {images->id, 2}}) {
        EXPECT_TRUE(sharedHost().writeImage(image, std::vector<float>(channels * depths.size(), 0.25f)));
      }
    }
  }
  ~Fading() {
    for (FrothView view : {fading_, plain_}) check(frothDestroyView(context(), view), "frothDestroyView");
    for (Images* images : {&fadedImages_, &plainImages_}) {
      for (HostImage* image : {&images->colour, &images->distance, &images->id}) sharedHost().destroyImage(*image);
    }
    sharedHost().destroyImage(depth_);
  }

  Pictures frame(Method method) {
    Pictures pictures;
    const Status submitted = sharedHost().submit([&](VkCommandBuffer commandBuffer, uint64_t serial) -> Status {
      const FrothFrame begun{sizeof(FrothFrame), serial, serial - 1, 0, 0, 0, 0};
      check(frothUpdate(context(), &begun, nullptr), "frothUpdate");
      check(frothRecordUpload(context(), commandBuffer), "frothRecordUpload");
      pictures.faded.result = record(method, fading_, fadedImages_, commandBuffer);
      pictures.plain.result = record(method, plain_, plainImages_, commandBuffer);
      return {};
    });
    EXPECT_TRUE(submitted) << submitted.error().message;
    read(fadedImages_, pictures.faded);
    read(plainImages_, pictures.plain);
    return pictures;
  }
  // The last frame before the cut is drawn.
  Pictures changeTo(const std::vector<uint32_t>& cut, Method method) {
    context()->setCut(stage_.asset(), cut);
    Pictures pictures;
    for (int frames = 0; frames < kMostFrames; ++frames) {
      Pictures newest = frame(method);
      if (std::ranges::equal(cut, drawn())) return first_ = newest, pictures;
      pictures = std::move(newest);
    }
    ADD_FAILURE() << "the cut does not come";
    return pictures;
  }
  // Of the cut that changeTo() was called for.
  const Pictures& first() const { return first_; }
  void show(const std::vector<uint32_t>& cut) {
    changeTo(cut, Method::kRaster);
    for (uint32_t i = 0; i < kFadeFrames; ++i) frame(Method::kRaster);
  }

  FrothContext* context() const { return stage_.context(); }
  FrothAsset asset() const { return stage_.asset(); }
  std::span<const uint32_t> drawn() const { return context()->findAsset(asset())->drawnChunks(); }
  FrothViewStatus status() const {
    auto status = makeStruct<FrothViewStatus>();
    check(frothGetViewStatus(context(), fading_, &status), "frothGetViewStatus");
    return status;
  }

 private:
  struct Images {
    HostImage colour, distance, id;
  };

  FrothResult record(Method method, FrothView view, const Images& images, VkCommandBuffer commandBuffer) {
    FrothRenderInfo info = test::infoOf(lookAt({0.2, 0.3, -5}, {0, 0, 0}, kWhole.width, kWhole.height, 0.4));
    info.camera.scissor = {kCorner, kDrawn};
    info.sceneDepth = sharedHost().describeInput(depth_);
    info.colour = kept(images.colour);
    info.distance = kept(images.distance);
    info.id = kept(images.id);
    const FrothResult result = froth::infoOf(method).record(context(), view, commandBuffer, &info);
    EXPECT_GE(result, FROTH_OK);
    return result;
  }
  // What lies beside the region stays.
  static FrothImage kept(const HostImage& image) {
    FrothImage described = sharedHost().describeInput(image);
    described.accessOut |= sharedHost().describe(image).accessOut;
    described.stageOut |= sharedHost().describe(image).stageOut;
    return described;
  }
  static void read(const Images& images, Picture& picture) {
    picture.colour = *sharedHost().readImage(images.colour);
    picture.distance = *sharedHost().readImage(images.distance);
    picture.id = *sharedHost().readImage(images.id);
  }

  Stage stage_;
  FrothView fading_, plain_;
  HostImage depth_;
  Images fadedImages_, plainImages_;
  Pictures first_;
};

// Each frame of a fade is the mix of the pictures of both cuts, each frame after it that of the new one.
void expectFade(Fading& scene, Method method, double rounding) {
  const Pictures before = scene.changeTo(finestCut(), method);
  EXPECT_TRUE(haveSameBits(before.faded.colour, before.plain.colour)) << "at rest";
  const double pop = largestChange(before.plain.colour, scene.first().plain.colour);
  EXPECT_GT(pop, 0.2);
  std::vector<float> shown = before.faded.colour;
  for (uint32_t i = 1; i <= kFadeFrames + 2; ++i) {
    const Pictures now = i == 1 ? scene.first() : scene.frame(method);
    EXPECT_EQ(now.faded.result, FROTH_OK);
    EXPECT_TRUE(haveSameBits(now.plain.colour, scene.first().plain.colour)) << i;
    EXPECT_TRUE(haveSameBits(now.faded.distance, now.plain.distance)) << i;
    EXPECT_TRUE(haveSameBits(now.faded.id, now.plain.id)) << i;
    if (i > kFadeFrames) {
      EXPECT_TRUE(haveSameBits(now.faded.colour, now.plain.colour)) << i;
    } else {
      const double weight = i / (kFadeFrames + 1.0);
      EXPECT_LE(largestChange(now.faded.colour, mixed(before.plain.colour, now.plain.colour, weight)), rounding) << i;
    }
    if (i <= kFadeFrames + 1) {
      EXPECT_NEAR(largestChange(shown, now.faded.colour), pop / (kFadeFrames + 1), 2 * rounding) << i;
    }
    shown = now.faded.colour;
  }
}

TEST(Fade, MixesThePicturesOfBothCutsByRaster) {
  Fading scene;
  scene.show(floorCut());
  expectFade(scene, Method::kRaster, kHalfStep);
}

TEST(Fade, MixesThePicturesOfBothCutsByWalk) {
  Fading scene;
  scene.show(floorCut());
  expectFade(scene, Method::kWalk, kHalfStep);
}

TEST(Fade, MixesColoursOfHalves) {
  Fading scene(VK_FORMAT_R16G16B16A16_SFLOAT);
  scene.show(floorCut());
  expectFade(scene, Method::kRaster, 2 * kHalfStep);
}

TEST(Fade, HoldsBackOtherChangesUntilItEnds) {
  Fading scene;
  scene.show(floorCut());
  scene.changeTo(finestCut(), Method::kRaster);
  scene.context()->setCut(scene.asset(), floorCut());
  for (uint32_t i = 2; i <= kFadeFrames; ++i) {
    scene.frame(Method::kWalk);
    EXPECT_TRUE(std::ranges::equal(scene.drawn(), finestCut())) << i;
  }
  const Pictures first = scene.frame(Method::kWalk);
  EXPECT_TRUE(std::ranges::equal(scene.drawn(), floorCut()));
  EXPECT_FALSE(haveSameBits(first.faded.colour, first.plain.colour)) << "the next fade began";
}

TEST(Fade, DrawsTwiceOnlyWhileItLasts) {
  Fading scene;
  scene.show(floorCut());
  const auto countPasses = [&](const char* name) {
    uint32_t count = 0;
    const FrothViewStatus status = scene.status();
    for (uint32_t i = 0; i < status.passCount; ++i) count += std::string(status.passes[i].name) == name;
    return count;
  };
  scene.changeTo(finestCut(), Method::kRaster);
  for (uint32_t i = 2; i <= kFadeFrames + 4; ++i) {
    scene.frame(Method::kRaster);  // the status is that of the frame before
    const bool wasFading = i - 1 <= kFadeFrames;
    EXPECT_EQ(countPasses("raster"), wasFading ? 2u : 1u) << i;
    EXPECT_EQ(countPasses("fade"), wasFading ? 2u : 0u) << i;
  }
}

TEST(Fade, IsGoneWithItsView) {
  Fading scene;
  scene.show(floorCut());
  const FrothView longest = createView(scene.context(), 64);
  scene.changeTo(finestCut(), Method::kRaster);
  for (uint32_t i = 0; i < 3 * kFadeFrames; ++i) scene.frame(Method::kRaster);
  EXPECT_NE(scene.context()->findAsset(scene.asset())->before(), nullptr) << "the longest fade counts";
  check(frothDestroyView(scene.context(), longest), "frothDestroyView");
  scene.frame(Method::kRaster);
  EXPECT_EQ(scene.context()->findAsset(scene.asset())->before(), nullptr);
}

TEST(Fade, OfAViewThatDoesNotFadeTakesNoMemory) {
  Fading scene;
  const auto bytesOf = [&](uint32_t fadeFrames) {
    const FrothView view = createView(scene.context(), fadeFrames, false);
    scene.frame(Method::kRaster);
    auto status = makeStruct<FrothViewStatus>();
    check(frothGetViewStatus(scene.context(), view, &status), "frothGetViewStatus");
    check(frothDestroyView(scene.context(), view), "frothDestroyView");
    for (uint32_t i = 0; i < status.memoryCount; ++i) {
      if (std::string(status.memory[i].name) == "fade") return status.memory[i].bytes;
    }
    return uint64_t{0};
  };
  EXPECT_EQ(bytesOf(0), 0u);
  EXPECT_EQ(bytesOf(1), 8u * kDrawn.width * kDrawn.height);
}

TEST(Fade, IsRefusedAboveItsMaximum) {
  std::string text;
  FrothContextInfo context = checkedContextInfo(0);
  context.messageUser = &text;
  context.onMessage = [](void* user, FrothSeverity, FrothResult, const char*, const char* message) {
    *static_cast<std::string*>(user) = message;
  };
  FrothContext* made = nullptr;
  check(frothCreateContext(&context, &made), "frothCreateContext");
  auto info = makeStruct<FrothViewInfo>();
  info.maxExtent = kDrawn;
  info.fadeFrames = 64;
  FrothView view{};
  EXPECT_EQ(frothCreateView(made, &info, &view), FROTH_OK);
  info.fadeFrames = 65;
  EXPECT_EQ(frothCreateView(made, &info, &view), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(text, "fadeFrames: 65; at most 64");
  info.structSize = offsetof(FrothViewInfo, fadeFrames);  // of a caller who does not know it
  EXPECT_EQ(frothCreateView(made, &info, &view), FROTH_OK);
  check(frothDestroyContext(made, UINT64_MAX), "frothDestroyContext");
}

TEST(Fade, StaysWithinTheBudget) {
  constexpr uint32_t kLong = 24;  // longer than the streamer keeps chunks whose room it needs
  Reader reader;
  uint64_t whole = 0;
  {
    Streamed unlimited(reader, 0, kLong);
    unlimited.settle(kNear);
    whole = unlimited.mostBytes;
  }
  for (uint64_t sixteenths = 10; sixteenths <= 22; sixteenths += 6) {
    Streamed streamed(reader, whole * sixteenths / 16, kLong);
    for (int i = 0; i < 64; ++i) streamed.frame(i % 32 < 16 ? kNear : kBetween, i % 2 == 1);
    streamed.settle(kNear);
    EXPECT_LE(streamed.mostBytes, whole * sixteenths / 16);
  }
}

TEST(Fade, EndsWhereTheRoomOfItsChunksIsNeeded) {
  constexpr int kLong = 64;
  Reader reader;
  Streamed streamed(reader, 0, kLong);
  const auto isFading = [&] { return streamed.context()->findAsset(streamed.asset())->before() != nullptr; };
  streamed.settle(kNear);
  const uint64_t used = streamed.status().usedBytes;
  for (int i = 0; i < 8 && !isFading(); ++i) streamed.frame(kFar);
  ASSERT_TRUE(isFading());
  for (int i = 0; i < 4; ++i) streamed.frame(kFar);
  EXPECT_EQ(streamed.status().usedBytes, used) << "chunks that leave stay";
  check(frothSetBudget(streamed.context(), streamed.mostBytes / 2), "frothSetBudget");
  int frames = 0;
  for (; frames < kLong && isFading(); ++frames) streamed.frame(kFar, frames % 2 == 1);
  EXPECT_LT(frames, kLong / 2);
  streamed.settle(kFar);
  EXPECT_EQ(streamed.drawn(), floorCut());
  EXPECT_LT(streamed.status().usedBytes, used);
}

TEST(Fade, IsOverOnceTheStatusSaysThatItIsSettled) {
  Reader reader;
  Streamed streamed(reader, 0, 5);
  streamed.settle(kFar);
  streamed.settle(kNear);
  EXPECT_EQ(streamed.drawn(), finestCut());
  EXPECT_EQ(streamed.context()->findAsset(streamed.asset())->before(), nullptr);
}

}  // namespace
}  // namespace froth::test
