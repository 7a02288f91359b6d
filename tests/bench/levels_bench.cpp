// froth_bench_levels FOAM CAMERAS: what a level of detail costs in likeness, and the CPU time of its parts.
//
// Merges cells without locks, in --groups alone, until --part of them is left, and compares with the foam before and
// after reviews and fit: in every fourth view at the sizes of --widths, point-sampled, or each pixel the mean of
// --rays^2 rays. Other views measure what cells contribute, review and fit.
#include <fmt/format.h>
#include <tbb/global_control.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <iterator>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "baker/input/foam_input.h"
#include "baker/lod/choose_pairs.h"
#include "baker/lod/contributions.h"
#include "baker/lod/fit_views.h"
#include "baker/lod/level_errors.h"
#include "baker/lod/level_fit.h"
#include "baker/lod/merge_plan.h"
#include "baker/lod/merge_review.h"
#include "base/image/mean_square.h"
#include "foam/foam_arrays.h"
#include "foam/pick_foam.h"
#include "reference/camera/view_rays.h"
#include "reference/capture/view_selection.h"
#include "reference/render/reference.h"

namespace froth {
namespace {

// Pairs of a round, of its cells: cells that show little merge again, and fewer of the others have to.
constexpr uint32_t kRoundPart = 4;

struct Options {
  std::string foam, cameras, seen;
  double part = 0.5;  // of the cells that are left
  uint32_t groups = 1, threads = 2, rays = 2;
  std::vector<uint32_t> widths{660, 330, 165, 82};
};

template <class T>
T valueOf(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

// CPU time of all threads.
double secondsOf(const auto& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

// Each pixel the mean of factor^2.
Image reduce(const Image& image, uint32_t factor) {
  Image small{image.width / factor, image.height / factor, 3, {}};
  small.values.assign(size_t{small.width} * small.height * 3, 0.0f);
  for (uint32_t y = 0; y < small.height * factor; ++y) {
    for (uint32_t x = 0; x < small.width * factor; ++x) {
      for (int c = 0; c < 3; ++c) {
        small.pixel(x / factor, y / factor)[c] += image.pixel(x, y)[c] / static_cast<float>(factor * factor);
      }
    }
  }
  return small;
}

class LevelsBench {
 public:
  explicit LevelsBench(const Options& options)
      : options_(options),
        input_(valueOf(loadFoam(options.foam, {}))),
        cameras_(valueOf(readCameras(options.cameras))),
        fine_(input_.foam) {
    for (size_t v = 0; v < cameras_.views.size(); ++v) {
      if (options.seen.empty() || v % 4 == 2) (v % 4 == 2 ? tests_ : others_).push_back(cameras_.views[v]);
    }
    if (options.seen.empty()) return;
    constexpr double kSame = 1e-3;  // of the scene's units, which are about a metre
    for (const View& view : valueOf(readViews(options.seen)).views) {
      const bool isTest = std::ranges::any_of(
          cameras_.views, [&](const View& test) { return glm::distance(eyeOf(test), eyeOf(view)) < kSame; });
      if (!isTest) others_.push_back(view);
    }
    fmt::print("{} views of {}\n", others_.size(), options.seen);
  }

  void run() {
    std::vector<double> contributions;
    const double measured = secondsOf([&] {
      contributions = valueOf(measureContributions(
          input_.foam, others_, {input_.nearRatio, input_.nearDepth, others_.size() > 20 ? 20'000u : 80'000u}));
    });
    fmt::print("contributions of {} views: {:.2f} s\n", others_.size(), measured);
    for (const View& view : others_) eyes_.emplace_back(eyeOf(view));
    std::vector<uint32_t> cells(input_.foam.cellCount);
    std::iota(cells.begin(), cells.end(), 0u);
    const auto check = [](const Status& status) {
      if (!status) throw std::runtime_error(status.error().message);
    };
    LevelErrors errors(others_, {input_.nearRatio, input_.nearDepth});
    check(errors.takeFinest(input_.foam, cells, {}));
    std::vector<uint8_t> staysApart(cells.size(), 0);
    LevelFit fit(others_, {input_.nearRatio, input_.nearDepth});
    check(fit.takeFinest(input_.foam, {}));
    const auto merge = [&] { return mergeGroups(split(cells, options_.groups), contributions, staysApart); };
    const auto fitted = [&](const MergedFoam& merged, size_t viewCount) {
      Foam foam = merged.cells;
      std::vector<uint8_t> isFree;
      for (const std::vector<uint32_t>& members : merged.members) isFree.push_back(members.size() > 1 ? 1 : 0);
      const double seconds = secondsOf([&] { check(fit.fit(foam, isFree, viewCount, {})); });
      fmt::print("fit through {} views: {:.2f} s\n", viewCount, seconds);
      return foam;
    };
    MergedFoam merged = merge();
    double before = INFINITY;
    std::vector<uint8_t> apartBefore;
    for (uint64_t review = 0; review < kReviews; ++review) {
      const Foam drawn = fitted(merged, kViewsOfReview);
      compare(drawn);
      std::vector<uint8_t> apart = staysApart;
      const Review found = lookAt(errors, drawn, merged.members, apart);
      const bool isBack = found.error > kKeptByReview * before;
      if (!isBack && found.outliers == 0) break;
      before = found.error;
      apartBefore = std::exchange(staysApart, isBack ? apartBefore : apart);
      merged = merge();
      if (isBack) break;
    }
    compare(merged.cells);
    compare(fitted(merged, kFitViews));
  }

 private:
  // All groups behind each other, without their locks.
  MergedFoam mergeGroups(const std::vector<std::vector<uint32_t>>& groups, const std::vector<double>& contributions,
                         const std::vector<uint8_t>& staysApart) const {
    MergedFoam all;
    for (const std::vector<uint32_t>& group : groups) {
      MergedFoam merged{pick(group), {}, {}, {}};
      for (const uint32_t cell : group) {
        merged.contributions.push_back(contributions[cell]);
        merged.isLocked.push_back(staysApart[cell]);
        merged.members.push_back({cell});
      }
      mergeRounds(merged);
      append(merged.cells, all.cells);
      std::ranges::move(merged.members, std::back_inserter(all.members));
    }
    return all;
  }

  struct Review {
    double error;  // of all pixels
    size_t outliers;
  };

  // Marks the cells of the merges that stand out, as the bake does.
  static Review lookAt(const LevelErrors& errors, const Foam& drawn, const std::vector<std::vector<uint32_t>>& members,
                       std::vector<uint8_t>& staysApart) {
    std::vector<uint32_t> owners, merges;
    for (uint32_t cell = 0; cell < drawn.cellCount; ++cell) {
      const bool isMerged = members[cell].size() > 1;
      owners.push_back(isMerged ? static_cast<uint32_t>(merges.size()) : kNoOwner);
      if (isMerged) merges.push_back(cell);
    }
    const LevelErrors::OwnerErrors sums =
        valueOf(errors.sumByOwner(drawn, owners, static_cast<uint32_t>(merges.size()), {}));
    const std::vector<uint32_t> outliers = findOutliers(sums.ofOwners);
    for (const uint32_t outlier : outliers) {
      for (const uint32_t cell : members[merges[outlier]]) staysApart[cell] = 1;
    }
    fmt::print("error {:.3f}; {} of {} merges stand out\n", sums.ofAll, outliers.size(), merges.size());
    return {sums.ofAll, outliers.size()};
  }

  // Halves by the median along the longest side.
  std::vector<std::vector<uint32_t>> split(std::vector<uint32_t> cells, uint32_t groups) const {
    if (groups <= 1) return {std::move(cells)};
    const std::vector<glm::vec3>& sites = input_.foam.sites;
    glm::vec3 low(INFINITY), high(-INFINITY);
    for (const uint32_t cell : cells) low = glm::min(low, sites[cell]), high = glm::max(high, sites[cell]);
    const glm::vec3 size = high - low;
    const int axis = size.x >= std::max(size.y, size.z) ? 0 : size.y >= size.z ? 1 : 2;
    std::sort(cells.begin(), cells.end(), [&](uint32_t a, uint32_t b) { return sites[a][axis] < sites[b][axis]; });
    const auto middle = cells.begin() + static_cast<std::ptrdiff_t>(cells.size() / 2);
    std::vector<std::vector<uint32_t>> parts = split({cells.begin(), middle}, groups / 2);
    for (std::vector<uint32_t>& part : split({middle, cells.end()}, groups / 2)) parts.push_back(std::move(part));
    return parts;
  }

  Foam pick(const std::vector<uint32_t>& cells) const {
    std::vector<uint64_t> details;
    for (const uint32_t cell : cells) {
      for (uint32_t k = 0; k < input_.foam.detailCount; ++k) {
        details.push_back(uint64_t{cell} * input_.foam.detailCount + k);
      }
    }
    return pickFoam(input_.foam, {cells, details, input_.foam.detailCount, input_.foam.lobeCount});
  }

  static void append(const Foam& part, Foam& foam) {
    foam.cellCount += part.cellCount;
    foam.detailCount = part.detailCount;
    foam.lobeCount = part.lobeCount;
    visitArrays([&](const FoamArray&, auto values) {
      (foam.*values).insert((foam.*values).end(), (part.*values).begin(), (part.*values).end());
    });
  }

  void mergeRounds(MergedFoam& merged) const {
    const auto left = static_cast<uint32_t>(options_.part * merged.cells.cellCount);
    while (merged.cells.cellCount > left) {
      const uint32_t count = merged.cells.cellCount;
      std::vector<CellPair> pairs;
      const size_t most = std::min<size_t>(count - left, count / kRoundPart);
      const double chosen =
          secondsOf([&] { pairs = choosePairs(merged.cells, merged.isLocked, merged.contributions, most, eyes_); });
      const double joined = secondsOf([&] { merged = mergeRound(merged, pairs, eyes_); });
      fmt::print("{} cells: {} pairs chosen in {:.2f} s, merged in {:.2f} s\n", count, pairs.size(), chosen, joined);
      if (pairs.empty()) break;
    }
  }

  void compare(const Foam& coarse) const {
    const ReferenceRenderer after(coarse);
    for (const uint32_t width : options_.widths) {
      for (const uint32_t rays : {1u, options_.rays}) {
        double worst = INFINITY, sum = 0;
        for (const View& view : tests_) {
          const double psnr = compareView(after, view, width, rays);
          worst = std::min(worst, psnr);
          sum += psnr;
        }
        fmt::print("width {:4}, {} rays per pixel: worst {:.2f} dB, mean {:.2f} dB\n", width, rays * rays, worst,
                   sum / double(tests_.size()));
        std::fflush(stdout);
      }
    }
  }

  double compareView(const ReferenceRenderer& after, const View& view, uint32_t width, uint32_t rays) const {
    const auto height = static_cast<uint32_t>(std::lround(double(width) * view.height / view.width));
    const View sized = resizeView(view, width * rays, height * rays);
    ReferenceOptions reference;
    reference.precision = Precision::kFloat;
    reference.cutoff = 1e-3;
    reference.nearRatio = view.nearRatio.value_or(double{input_.nearRatio});
    reference.nearDepth = view.nearDepth.value_or(double{input_.nearDepth});
    return decibels(meanSquare(reduce(valueOf(fine_.render(sized, reference)).colour, rays),
                               reduce(valueOf(after.render(sized, reference)).colour, rays)));
  }

  const Options& options_;
  const FoamInput input_;
  const CameraSet cameras_;
  const ReferenceRenderer fine_;
  std::vector<View> tests_, others_;
  std::vector<glm::vec3> eyes_;
};

}  // namespace
}  // namespace froth

int main(int argc, char** argv) {
  froth::Options options;
  CLI::App program("What a level of detail costs in likeness");
  program.add_option("FOAM", options.foam)->required();
  program.add_option("CAMERAS", options.cameras)->required();
  program.add_option("--seen", options.seen, "cameras.json, a COLMAP folder or transforms.json");
  program.add_option("--part", options.part);
  program.add_option("--groups", options.groups, "a power of two");
  program.add_option("--widths", options.widths);
  program.add_option("--rays", options.rays);
  program.add_option("--threads", options.threads);
  CLI11_PARSE(program, argc, argv);
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, options.threads);
  try {
    froth::LevelsBench(options).run();
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
