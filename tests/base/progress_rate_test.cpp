#include "base/progress_rate.h"

#include <gtest/gtest.h>

namespace froth {
namespace {

using std::chrono::seconds;

const ProgressRate::Time kStart{};

TEST(ProgressRate, IsNotKnownBeforeAnItemIsDone) {
  ProgressRate rate;
  rate.begin(kStart, 0);
  EXPECT_EQ(rate.update(kStart, 0), 0);
  EXPECT_EQ(rate.update(kStart + seconds(60), 0), 0);
}

TEST(ProgressRate, DoesNotCountWhatAnEarlierRunDid) {
  ProgressRate rate;
  rate.begin(kStart, 9000);
  EXPECT_EQ(rate.update(kStart + seconds(5), 9010), 2);
}

TEST(ProgressRate, FollowsWorkThatBecomesSlower) {
  ProgressRate rate;
  rate.begin(kStart, 0);
  uint64_t done = 0;
  for (int second = 1; second <= 30; ++second) rate.update(kStart + seconds(second), done += 100);
  for (int second = 31; second <= 50; ++second) rate.update(kStart + seconds(second), done += 10);
  EXPECT_EQ(rate.update(kStart + seconds(51), done + 10), 10);
}

TEST(ProgressRate, OfItemsThatTakeMinutesGoesOverTheLastOnes) {
  ProgressRate rate;
  rate.begin(kStart, 0);
  rate.update(kStart + seconds(120), 1);
  rate.update(kStart + seconds(240), 2);
  EXPECT_EQ(rate.update(kStart + seconds(250), 2), 1 / 130.0);
}

TEST(ProgressRate, BeginsAgainWhereTheCountFalls) {
  ProgressRate rate;
  rate.begin(kStart, 0);
  rate.update(kStart + seconds(20), 500);
  rate.update(kStart + seconds(21), 0);
  EXPECT_EQ(rate.update(kStart + seconds(31), 20), 2);
}

}  // namespace
}  // namespace froth
