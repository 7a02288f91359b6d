// froth compare-bench: what a change did to the times.
#include <memory>

#include <fmt/format.h>

#include "base/atomic_file.h"
#include "base/json_input.h"
#include "measure/bench/bench_comparison.h"
#include "measure/figures.h"
#include "tool/commands.h"
#include "tool/options.h"

namespace froth {
namespace {

struct CompareBenchOptions {
  std::filesystem::path a, b;
  FiguresOutput figures;
};

Result<nlohmann::ordered_json> readFigures(const std::filesystem::path& path) {
  const Result<std::vector<uint8_t>> bytes = readFile(path, kMostJsonBytes);
  if (!bytes) return bytes.error();
  Result<nlohmann::ordered_json> figures =
      parseJson<nlohmann::ordered_json>(*bytes, path.string(), "`froth bench --json=FILE` writes it");
  if (!figures || figures->is_object()) return figures;
  return makeError(ErrorKind::kBadInput, "%s: not a JSON object; `froth bench --json=FILE` writes one", path.c_str());
}

std::string describeTimes(const Percentiles& times) {
  return fmt::format("{:.4f} [{:.4f}, {:.4f}]", times.median, times.p5, times.p95);
}

void printComparison(const BenchComparison& comparison) {
  for (const std::string& difference : comparison.differences) fmt::print("differs: {}\n", difference);
  fmt::print("{:<12} {:>28} {:>28} {:>8}\n", "[ms]", "A [p5, p95]", "B [p5, p95]", "B / A");
  for (const TimeComparison& time : comparison.times) {
    fmt::print("{:<12} {:>28} {:>28} {:>8.3f}  {}\n", time.name, describeTimes(time.a), describeTimes(time.b),
               time.ratio(), verdictName(time.verdict));
  }
  for (const CountComparison& count : comparison.counts) {
    fmt::print("{:<41} {:>28.6g} {:>8.6g}\n", count.name, count.a, count.b);
  }
}

nlohmann::ordered_json comparisonAsJson(const BenchComparison& comparison) {
  const auto interval = [](const Percentiles& times) {
    return nlohmann::ordered_json{{"median", times.median}, {"p5", times.p5}, {"p95", times.p95}};
  };
  nlohmann::ordered_json times = nlohmann::ordered_json::object(), counts = times;
  for (const TimeComparison& time : comparison.times) {
    times[time.name] = {{"a", interval(time.a)},
                        {"b", interval(time.b)},
                        {"ratio", time.ratio()},
                        {"verdict", verdictName(time.verdict)}};
  }
  for (const CountComparison& count : comparison.counts) counts[count.name] = {{"a", count.a}, {"b", count.b}};
  return {{"differences", comparison.differences}, {"times", times}, {"counts", counts}};
}

Status runCompareBench(const CompareBenchOptions& options) {
  const Result<nlohmann::ordered_json> a = readFigures(options.a);
  if (!a) return a.error();
  const Result<nlohmann::ordered_json> b = readFigures(options.b);
  if (!b) return b.error();
  const Result<BenchComparison> comparison = compareBench(*a, *b);
  if (!comparison) return comparison.error();
  if (options.figures.wantsTable()) printComparison(*comparison);
  return options.figures.write(comparisonAsJson(*comparison));
}

}  // namespace

void addCompareBenchCommand(CLI::App& program, Tool& tool) {
  CLI::App* command = program.add_subcommand(
      "compare-bench", "Two results of `bench --json` side by side; differences within the noise are ties");
  auto options = std::make_shared<CompareBenchOptions>();
  command->add_option("A", options->a, "The result before")->required();
  command->add_option("B", options->b, "The result after")->required();
  addFiguresOption(*command, options->figures);
  command->callback([&tool, options] { tool.action = [options] { return runCompareBench(*options); }; });
}

}  // namespace froth
