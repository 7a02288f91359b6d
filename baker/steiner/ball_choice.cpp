#include "baker/steiner/ball_choice.h"

#include <algorithm>
#include <numeric>
#include <queue>

#include "foam/site_tree.h"

namespace froth {
namespace {

// A power cell is seldom much wider than its ball. Rays that pass the site at more than this many radii are
// not asked.
constexpr double kReach = 1.6;
constexpr int64_t kLeastSaving = 3;  // of all rays together: fewer are chance
// A ball is good enough if it saves nearly as much as the next one in the queue did when it was last looked
// at: savings seldom grow with the balls chosen.
constexpr double kNearlyBest = 0.9;

class BallChoice {
 public:
  BallChoice(std::span<const EmptyBall> balls, std::span<const WalkRay> rays, std::span<RayCells> walks)
      : balls_(balls), rays_(rays), walks_(walks), first_(balls.size() + 1, 0) {}

  void findCrossings(Steps& steps) {
    std::vector<glm::vec3> sites;
    std::vector<float> reaches;
    for (const EmptyBall& ball : balls_) {
      sites.push_back(ball.site);
      reaches.push_back(static_cast<float>(kReach) * ball.radius);
    }
    std::vector<uint32_t> all(balls_.size());
    std::iota(all.begin(), all.end(), 0u);
    const SiteTree tree(sites, reaches, std::move(all));
    std::vector<std::vector<uint32_t>> crossed(rays_.size());
    steps.forAll(rays_.size(), [&](size_t ray) {
      tree.searchRay(rays_[ray].origin, rays_[ray].direction, [&](uint32_t ball) {
        if (isWithinReach(ray, ball) && walks_[ray].isCutBy(line(ball, ray))) crossed[ray].push_back(ball);
      });
    });
    gather(crossed);
  }

  std::vector<EmptyBall> choose(Steps& steps) {
    std::vector<int64_t> savings(balls_.size());
    steps.forAll(balls_.size(), [&](size_t ball) { savings[ball] = savingOf(static_cast<uint32_t>(ball)); });
    std::priority_queue<Rated> queue;
    for (uint32_t ball = 0; ball < balls_.size(); ++ball) {
      if (savings[ball] >= kLeastSaving) queue.push({savings[ball], ball});
    }
    std::vector<EmptyBall> chosen;
    const size_t triesPerStep = queue.size() / Steps::kPerLoop + 1;
    for (size_t tries = 0; !queue.empty(); ++tries) {
      if (tries % triesPerStep == 0 && !steps.advance()) break;
      const uint32_t ball = queue.top().ball;
      queue.pop();
      const int64_t saving = savingOf(ball);
      if (saving < kLeastSaving) continue;
      if (!queue.empty() && static_cast<double>(saving) < kNearlyBest * static_cast<double>(queue.top().saving)) {
        queue.push({saving, ball});
        continue;
      }
      for (const uint32_t ray : crossingsOf(ball)) walks_[ray].add(line(ball, ray));
      chosen.push_back(balls_[ball]);
    }
    return chosen;
  }

 private:
  struct Rated {
    int64_t saving;
    uint32_t ball;
    bool operator<(const Rated& other) const {
      return saving != other.saving ? saving < other.saving : ball > other.ball;
    }
  };

  BallLine line(uint32_t ball, size_t ray) const { return lineOf(balls_[ball].site, balls_[ball].radius, rays_[ray]); }

  bool isWithinReach(size_t ray, uint32_t ball) const {
    const glm::dvec3 centre = glm::dvec3(balls_[ball].site) - glm::dvec3(rays_[ray].origin),
                     direction(rays_[ray].direction);
    const double reach = kReach * balls_[ball].radius, along = std::max(glm::dot(centre, direction), 0.0);
    const glm::dvec3 apart = centre - along * direction;
    return glm::dot(apart, apart) < reach * reach;
  }

  // From balls by ray to rays by ball.
  void gather(const std::vector<std::vector<uint32_t>>& crossed) {
    for (const std::vector<uint32_t>& some : crossed) {
      for (const uint32_t ball : some) ++first_[ball + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    crossings_.resize(first_.back());
    std::vector<size_t> next(first_.begin(), first_.end() - 1);
    for (uint32_t ray = 0; ray < crossed.size(); ++ray) {
      for (const uint32_t ball : crossed[ray]) crossings_[next[ball]++] = ray;
    }
  }

  std::span<const uint32_t> crossingsOf(uint32_t ball) const {
    return std::span(crossings_).subspan(first_[ball], first_[ball + 1] - first_[ball]);
  }

  int64_t savingOf(uint32_t ball) const {
    int64_t saving = 0;
    for (const uint32_t ray : crossingsOf(ball)) saving += walks_[ray].savingOf(line(ball, ray));
    return saving;
  }

  std::span<const EmptyBall> balls_;
  std::span<const WalkRay> rays_;
  std::span<RayCells> walks_;
  std::vector<size_t> first_;        // [balls + 1] into crossings_
  std::vector<uint32_t> crossings_;  // rays
};

}  // namespace

std::vector<EmptyBall> chooseBalls(std::span<const EmptyBall> balls, std::span<const WalkRay> rays,
                                   std::span<RayCells> walks, Steps& steps) {
  BallChoice choice(balls, rays, walks);
  choice.findCrossings(steps);
  return choice.choose(steps);
}

}  // namespace froth
