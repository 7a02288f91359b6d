#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <utility>

#include "measure/report/report.h"

namespace froth {

std::vector<size_t> orderOfRound(const std::vector<std::string>& groups, uint64_t seed, uint32_t round) {
  std::mt19937_64 random(seed);
  random.discard(uint64_t{round} * 2 * groups.size());
  std::map<std::string, uint64_t> groupKeys;
  std::vector<std::pair<uint64_t, uint64_t>> keys;  // of the group, of the member
  for (const std::string& group : groups) {
    const uint64_t key = random();
    keys.emplace_back(groupKeys.emplace(group, key).first->second, random());
  }
  std::vector<size_t> order(groups.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return keys[a] < keys[b]; });
  return order;
}

}  // namespace froth
