// froth_quality.h against simulated frames: cost = fixed + work * area ^ power, with noise, slow single frames, jumps,
// and times that come late.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "froth/froth_quality.h"
#include "runtime_fixture.h"

namespace froth {
namespace {

using ::testing::HasSubstr;

constexpr double kTarget = 8;  // [ms]

struct Plant {
  double fixed = 1, work = 6, power = 1;  // [ms] work: of the whole area
  double noise = 0;                       // relative, either way
  uint32_t slowEvery = 0;                 // a frame of 5 times its cost; 0: none
  uint32_t latency = 2;                   // frames until a time is known
};

// An engine that draws with what it is told, and what its frames took.
class Engine {
 public:
  explicit Engine(const Plant& given, uint32_t seed = 1) : plant(given), random_(seed) {
    info.targetMilliseconds = static_cast<float>(kTarget);
  }

  // Without noise, as the next frame is drawn.
  double cost() const {
    const double share = quality.cutoff > 2e-3f ? 0.95 : 1;
    return plant.fixed + share * plant.work * std::pow(areaOf(quality.scale), plant.power);
  }

  void frame() {
    const uint64_t serial = times_.size() + 1;
    const float before = quality.scale;
    auto times = makeStruct<FrothQualityTimes>();
    times.serial = serial;
    if (serial > plant.latency) {
      times.measuredSerial = serial - plant.latency;
      times.milliseconds = times_[times.measuredSerial - 1];
    }
    ASSERT_EQ(frothStepQuality(&info, &times, &quality), FROTH_OK);
    ASSERT_GE(quality.scale, 0.5f);
    ASSERT_LE(quality.scale, 1);
    if (serial > 1) {
      ASSERT_GE(areaOf(quality.scale), 0.4999 * areaOf(before)) << "a step is bounded";
      ASSERT_LE(areaOf(quality.scale), 1.1501 * areaOf(before));
      changes += quality.scale != before;
    }
    double taken = cost() * std::uniform_real_distribution(1 - plant.noise, 1 + plant.noise)(random_);
    if (plant.slowEvery != 0 && serial % plant.slowEvery == 0) taken *= 5;
    times_.push_back(taken);
  }

  void run(uint32_t count) {
    for (uint32_t i = 0; i < count && !testing::Test::HasFatalFailure(); ++i) frame();
  }

  // Frames until `isThere`, or `most`.
  template <class Condition>
  uint32_t framesUntil(uint32_t most, Condition isThere) {
    for (uint32_t count = 0; count < most; ++count) {
      if (isThere()) return count;
      frame();
      if (testing::Test::HasFatalFailure()) break;
    }
    return most;
  }

  static double areaOf(float scale) { return double{scale} * scale; }

  Plant plant;
  FrothQualityInfo info = makeStruct<FrothQualityInfo>();
  FrothQuality quality = makeStruct<FrothQuality>();
  uint32_t changes = 0;  // of the scale

 private:
  std::mt19937 random_;
  std::vector<double> times_;
};

TEST(Quality, StaysWholeWhileThereIsTime) {
  Engine engine({.noise = 0.1});
  engine.run(300);
  EXPECT_EQ(engine.quality.scale, 1);
  EXPECT_EQ(engine.quality.cutoff, 1e-3f);
  EXPECT_EQ(engine.changes, 0u);
}

TEST(Quality, AnswersAJumpWithinTheFramesInFlightAndTwoMore) {
  for (const uint32_t latency : {1u, 2u, 3u, 8u}) {
    Engine engine({.fixed = 0, .latency = latency});
    engine.run(100);
    engine.plant.work = 12;
    EXPECT_EQ(engine.framesUntil(100, [&] { return engine.cost() <= kTarget; }), latency + 2) << latency;
    EXPECT_EQ(engine.quality.cutoff, 1e-2f);
    const float answer = engine.quality.scale;
    engine.run(100);
    EXPECT_EQ(engine.quality.scale, answer) << "frames in flight are of the old scale, and move nothing further";
  }
}

// Each answer leaves the share of the fixed part too much.
TEST(Quality, ComesBelowTheTargetThoughHalfOfTheTimeIsFixed) {
  Engine engine({.fixed = 4, .work = 3});
  engine.run(100);
  engine.plant.work = 9;
  EXPECT_LE(engine.framesUntil(200, [&] { return engine.cost() <= kTarget; }), 24u);
}

TEST(Quality, ComesBackWhenTheJumpIsOver) {
  Engine engine({.work = 24});
  engine.run(300);
  EXPECT_LT(engine.quality.scale, 0.6f);
  engine.plant.work = 4.5;
  EXPECT_LE(engine.framesUntil(1000, [&] { return engine.quality.scale == 1; }), 120u);
  EXPECT_EQ(engine.quality.cutoff, 1e-3f);
}

// A step is judged by frames that were drawn with it.
TEST(Quality, RaisesTheScaleByEightFramesOfThePresentOne) {
  Engine engine({.work = 24, .latency = 3});
  engine.run(300);
  engine.plant.work = 3;
  uint32_t raised = 0, since = 0;
  while (engine.quality.scale < 1 && raised < 20) {
    const float before = engine.quality.scale;
    engine.frame();
    ++since;
    if (engine.quality.scale == before) continue;
    if (raised++ > 0) {
      EXPECT_EQ(since, engine.plant.latency + 7);
    }
    since = 0;
  }
  EXPECT_GT(raised, 3u);
}

TEST(Quality, IsDeafToSingleSlowFrames) {
  Engine engine({.slowEvery = 30});
  engine.run(1000);
  EXPECT_EQ(engine.changes, 0u);
}

// They do not hold it back either: of any eight frames one is slow.
TEST(Quality, ComesBackInSpiteOfSingleSlowFrames) {
  Engine engine({.work = 24, .slowEvery = 8});
  engine.run(300);
  engine.plant.work = 4.5;
  EXPECT_LE(engine.framesUntil(1000, [&] { return engine.quality.scale == 1; }), 240u);
}

TEST(Quality, EndsAtTheLeastScaleWhereTheTargetCannotBeMet) {
  Engine engine({.fixed = 12, .noise = 0.1});
  engine.run(300);
  EXPECT_EQ(engine.quality.scale, 0.5f);
}

// Any engine: settled, it holds still in the band.
TEST(Quality, SettlesBelowTheTargetForRandomEngines) {
  std::mt19937 random(7);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  for (uint32_t seed = 0; seed < 500; ++seed) {
    Plant plant{.fixed = uniform(0, 0.5 * kTarget), .work = uniform(1, 30), .power = uniform(0.7, 1.5)};
    plant.noise = uniform(0, 0.06);
    plant.slowEvery = seed % 2 == 0 ? 0 : 20 + seed % 17;
    plant.latency = 1 + seed % 8;
    Engine engine(plant, seed);
    for (const double jump : {1.0, uniform(0.3, 3), uniform(0.3, 3)}) {
      engine.plant.work = plant.work * jump;
      engine.run(800);
      engine.changes = 0;
      engine.run(400);
      if (testing::Test::HasFatalFailure()) FAIL() << "seed " << seed;
      const std::string what = "seed " + std::to_string(seed) + ", scale " + std::to_string(engine.quality.scale) +
                               ", cost " + std::to_string(engine.cost());
      EXPECT_LE(engine.changes, 1u) << what << ": it does not hold still";
      EXPECT_TRUE(engine.cost() <= 1.06 * kTarget || engine.quality.scale == 0.5f) << what << ": too slow";
      EXPECT_TRUE(engine.cost() >= 0.70 * kTarget || engine.quality.scale == 1) << what << ": too coarse";
    }
  }
}

class QualityCall : public ::testing::Test {
 protected:
  QualityCall() {
    info_.targetMilliseconds = 8;
    info_.onMessage = logMessage;
    info_.messageUser = &messages_;
    times_.serial = 1;
  }
  void expectRefused(const char* text) {
    const FrothQuality before = quality_;
    EXPECT_EQ(frothStepQuality(&info_, &times_, &quality_), FROTH_ERROR_ARGUMENT);
    ASSERT_FALSE(messages_.empty());
    EXPECT_THAT(messages_.back().text, HasSubstr(text));
    EXPECT_EQ(std::memcmp(&before, &quality_, sizeof(before)), 0) << "it is as it was";
  }

  std::vector<LoggedMessage> messages_;
  FrothQualityInfo info_ = makeStruct<FrothQualityInfo>();
  FrothQualityTimes times_ = makeStruct<FrothQualityTimes>();
  FrothQuality quality_ = makeStruct<FrothQuality>();
};

TEST_F(QualityCall, RefusesWhatHasNoMeaningAndNamesIt) {
  info_.targetMilliseconds = 0;
  expectRefused("targetMilliseconds: 0; must be positive");
  info_.targetMilliseconds = std::numeric_limits<float>::quiet_NaN();
  expectRefused("targetMilliseconds: nan");
  info_.targetMilliseconds = 8;
  info_.mostScale = 1.5f;
  expectRefused("mostScale: 1.5");
  info_.mostScale = 0.5f;
  info_.leastScale = 0.75f;
  expectRefused("leastScale: 0.75");
  info_.leastScale = 0.25f;
  info_.cutoff = 1;
  expectRefused("cutoff: 1");
  info_.cutoff = 0;
  times_.milliseconds = -1;
  expectRefused("milliseconds: -1");
  times_.milliseconds = std::numeric_limits<double>::infinity();
  expectRefused("milliseconds: inf");
  times_.milliseconds = 0;
  times_.serial = 0;
  expectRefused("serial: 0 after 0; must grow");
  times_.serial = 5;
  ASSERT_EQ(frothStepQuality(&info_, &times_, &quality_), FROTH_OK);
  EXPECT_EQ(quality_.scale, 0.5f);
  expectRefused("serial: 5 after 5");
  EXPECT_EQ(frothStepQuality(nullptr, &times_, &quality_), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothStepQuality(&info_, nullptr, &quality_), FROTH_ERROR_ARGUMENT);
  EXPECT_EQ(frothStepQuality(&info_, &times_, nullptr), FROTH_ERROR_ARGUMENT);
}

// Memory that nobody has set, as bits of all kinds: any answer, within the limits.
TEST_F(QualityCall, SurvivesAnyMemory) {
  std::mt19937 random(3);
  for (int run = 0; run < 2000; ++run) {
    auto* bytes = reinterpret_cast<unsigned char*>(&quality_);
    for (size_t i = 0; i < sizeof(quality_); ++i) bytes[i] = static_cast<unsigned char>(random());
    if (run % 2 == 0) std::fill(std::begin(quality_.costs), std::end(quality_.costs), NAN);
    if (run % 3 == 0) quality_.drawnCount = 40, std::fill_n(quality_.drawnSerials, 16, 7);
    quality_.structSize = sizeof(quality_);
    times_.serial = UINT64_MAX;
    times_.measuredSerial = 7;
    times_.milliseconds = 1e300;
    if (frothStepQuality(&info_, &times_, &quality_) == FROTH_OK && !std::isnan(quality_.scale)) {
      ASSERT_GE(quality_.scale, 0.5f);
      ASSERT_LE(quality_.scale, 1);
    }
  }
}

// Frames that were not measured, or dropped, or of another view.
TEST_F(QualityCall, CountsAFrameOnceAndOnlyIfItKnowsIt) {
  info_.targetMilliseconds = 1;
  for (times_.serial = 10; times_.serial < 100; ++times_.serial) {
    times_.milliseconds = 50;
    times_.measuredSerial = times_.serial % 2 == 0 ? 5 : 10;  // of one frame it has drawn
    if (times_.serial == 10) times_.measuredSerial = 0;
    ASSERT_EQ(frothStepQuality(&info_, &times_, &quality_), FROTH_OK);
  }
  EXPECT_EQ(quality_.scale, 1);
  EXPECT_EQ(quality_.measuredCount, 1u);
}

}  // namespace
}  // namespace froth
