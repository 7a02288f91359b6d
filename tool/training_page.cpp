#include "tool/training_page.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "base/atomic_file.h"
#include "tool/photo_image.h"

namespace froth {
namespace {

constexpr size_t kShownAtEachEnd = 3;  // the worst and the best photos

// By growing PSNR; of many those at both ends.
std::vector<size_t> chooseTests(const std::vector<double>& psnrs) {
  std::vector<size_t> tests(psnrs.size());
  std::iota(tests.begin(), tests.end(), size_t{0});
  std::stable_sort(tests.begin(), tests.end(), [&](size_t a, size_t b) { return psnrs[a] < psnrs[b]; });
  if (tests.size() > 2 * kShownAtEachEnd) tests.erase(tests.begin() + kShownAtEachEnd, tests.end() - kShownAtEachEnd);
  return tests;
}

}  // namespace

Status TrainingPage::write(const TrainingMoment& moment, const TrainingSet& set) {
  report_.points.push_back({moment.stepsDone, moment.seconds, moment.cells, moment.psnr});
  report_.position = moment.position;
  report_.pictures.clear();
  std::vector<glm::vec4> shown;
  for (const size_t test : chooseTests(moment.testPsnrs)) {
    if (Status drawn = moment.showTest(test, shown); !drawn) return drawn;
    const Photo& photo = set.testing[test];
    Result<ReportImage> pair = makePair(set.testNames[test], fmt::format("{:.2f} dB", moment.testPsnrs[test]),
                                        imageOf(photo), imageOf(photo, shown));
    if (!pair) return pair.error();
    report_.pictures.push_back(std::move(*pair));
  }
  const std::string html = trainingAsHtml(report_);
  return writeFileAtomically(path_, {reinterpret_cast<const uint8_t*>(html.data()), html.size()});
}

}  // namespace froth
