// froth compare: how far two images are apart.
#include <memory>

#include <fmt/format.h>

#include "base/image/image.h"
#include "measure/figures.h"
#include "reference/image/metrics.h"
#include "tool/commands.h"
#include "tool/options.h"

namespace froth {
namespace {

struct CompareOptions {
  std::filesystem::path a, b;
  FiguresOutput output;
};

bool isRaw(const std::filesystem::path& path) { return path.extension() == ".f16"; }

Result<ImageDifference> compareFiles(const CompareOptions& options) {
  if (isRaw(options.a) && isRaw(options.b)) {
    return makeError(ErrorKind::kUsage, "%s and %s are both raw: one image must be a pfm, png or jpg, to give the size",
                     options.a.c_str(), options.b.c_str());
  }
  const bool isSwapped = isRaw(options.a);
  const Result<Image> shaped = readImage(isSwapped ? options.b : options.a);
  if (!shaped) return shaped.error();
  const Result<Image> other = readImage(isSwapped ? options.a : options.b, &*shaped);
  if (!other) return other.error();
  Result<ImageDifference> difference = compareImages(*shaped, *other);
  if (difference) return difference;
  return makeError(difference.error().kind, "%s and %s: %s", options.a.c_str(), options.b.c_str(),
                   difference.error().message.c_str());
}

Status runCompare(const CompareOptions& options) {
  const Result<ImageDifference> difference = compareFiles(options);
  if (!difference) return difference.error();
  if (options.output.wantsTable()) {
    fmt::print("PSNR              {:.3f} dB (mean over channels {:.3f} dB)\n", difference->psnr,
               difference->psnrChannelMean);
    fmt::print("SSIM              {:.5f}\n", difference->ssim);
    fmt::print("largest error     {:.6g}\n", difference->maxError);
    fmt::print("pixels off by     > 1/255: {:.6f}, > 2/255: {:.6f}\n", difference->overOneStep,
               difference->overTwoSteps);
  }
  // JSON has no infinity: the PSNR of equal images is null.
  return options.output.write({{"a", options.a.string()},
                               {"b", options.b.string()},
                               {"psnr", difference->psnr},
                               {"psnrChannelMean", difference->psnrChannelMean},
                               {"ssim", difference->ssim},
                               {"maxError", difference->maxError},
                               {"overOneStep", difference->overOneStep},
                               {"overTwoSteps", difference->overTwoSteps}});
}

}  // namespace

void addCompareCommand(CLI::App& program, Tool& tool) {
  CLI::App* command =
      program.add_subcommand("compare", "Difference of two images; PSNR and SSIM of values clamped to 0..1");
  auto options = std::make_shared<CompareOptions>();
  command->add_option("A", options->a, "pfm, png, jpg, or raw f16 with the size of B")->required();
  command->add_option("B", options->b, "pfm, png, jpg, or raw f16 with the size of A")->required();
  addFiguresOption(*command, options->output);
  command->callback([&tool, options] { tool.action = [options] { return runCompare(*options); }; });
}

}  // namespace froth
