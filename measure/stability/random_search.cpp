#include "measure/stability/random_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <map>

#include "base/counter_random.h"
#include "measure/stability/cases/random_case.h"
#include "measure/stability/shrink.h"

namespace froth {
namespace {

using Clock = std::chrono::steady_clock;

// "float: over its bound" as part of a file's name.
std::string nameOfKind(const std::string& kind) {
  std::string name;
  for (const char letter : kind) {
    if (std::isalnum(static_cast<unsigned char>(letter))) {
      name += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  return name;
}

}  // namespace

Result<SearchResult> searchCases(const SearchOptions& options, const CaseJudge& judge, const Progress& progress) {
  const Clock::time_point start = Clock::now();
  const auto secondsGone = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  SearchResult result;
  std::map<std::string, uint32_t> shrunkOfKind;
  for (; secondsGone() < options.seconds; ++result.tried) {
    if (!report(progress, "search", static_cast<uint64_t>(secondsGone()), static_cast<uint64_t>(options.seconds))) {
      return stoppedOnRequest("search");
    }
    const StiffCase drawn = drawCase(mixBits(options.seed) + result.tried);
    const Result<std::optional<CaseFault>> fault = judge(drawn);
    if (!fault) return fault.error();
    if (!*fault) continue;
    ++result.failing;
    if (shrunkOfKind[(*fault)->kind]++ >= options.mostOfOneKind) continue;
    Result<ShrunkCase> shrunk = shrinkCase(drawn, **fault, judge, options.mostTries, progress);
    if (!shrunk) return shrunk.error();
    FoundCase found{std::move(shrunk->smallest), std::move(shrunk->fault), drawn.foam.cellCount};
    found.shrunk.name = fmt::format("found/{}_{}_{}", nameOfKind(found.fault.kind), options.seed, result.tried);
    found.shrunk.what = found.fault.kind + "; " + found.fault.what;
    found.shrunk.analysis = "found by the random search and shrunk";
    if (options.onFound) {
      if (Status kept = options.onFound(found); !kept) return kept.error();
    }
    result.found.push_back(std::move(found));
  }
  return result;
}

}  // namespace froth
