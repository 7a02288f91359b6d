// froth evaluate: how well the runtime draws what photos show.
#include <memory>

#include <fmt/format.h>

#include "baker/input/foam_input.h"
#include "measure/figures.h"
#include "measure/gpu/gpu_camera.h"
#include "measure/gpu/gpu_renderer.h"
#include "reference/image/flip.h"
#include "reference/image/metrics.h"
#include "tool/commands.h"
#include "tool/options.h"
#include "tool/photo_image.h"
#include "tool/view_output.h"
#include "trainer/loop/evaluate.h"
#include "trainer/photos/exposure.h"
#include "trainer/photos/photo_order.h"

namespace froth {
namespace {

struct EvaluateOptions {
  std::filesystem::path input, scene, output;
  std::string renderer = "raster";
  uint32_t testPeriod = 8;
  bool isAll = false, isPremultiplied = false, evensExposure = false;
  double cutoff = 1e-3;
  PhotoOptions photos;
  GpuDeviceOptions device;
  FiguresOutput figures;
};

struct PhotoErrors {
  double psnr = 0, ssim = 0, flip = 0;
};

template <class Item>
std::vector<Item> pick(std::vector<Item>& items, const std::vector<uint32_t>& indices) {
  std::vector<Item> picked;
  for (const uint32_t i : indices) picked.push_back(std::move(items[i]));
  return picked;
}

Result<std::vector<Photo>> readChosen(const EvaluateOptions& options, const Progress& progress) {
  Result<Capture> capture = readCapture(options.scene);
  if (!capture) return capture.error();
  std::vector<uint32_t> tests;
  if (!options.isAll) {
    Result<PhotoSplit> split = splitPhotos(capture->views, options.testPeriod);
    if (!split) return split.error();
    tests = std::move(split->test);
    if (tests.empty()) {
      return makeError(ErrorKind::kUsage, "%s: no photo is for testing; give --test-every, or --all for all photos",
                       options.scene.c_str());
    }
  }
  // Exposures are relative to those of all photos.
  const bool readsAll = options.isAll || options.evensExposure;
  if (!readsAll) capture->views = pick(capture->views, tests);
  Result<std::vector<Photo>> photos = readPhotos(capture->views, options.photos, progress);
  if (!photos) return photos.error();
  if (options.evensExposure) {
    if (Status even = evenExposures(*capture, *photos); !even) return even.error();
  }
  return readsAll && !options.isAll ? pick(*photos, tests) : std::move(*photos);
}

Result<PhotoErrors> compareWith(const Photo& photo, Image drawn) {
  std::vector<glm::vec4> rendered;
  for (size_t i = 0; i < drawn.values.size() / 3; ++i) {
    rendered.emplace_back(drawn.values[3 * i], drawn.values[3 * i + 1], drawn.values[3 * i + 2], 0);
    if (photo.counted.empty() || photo.counted[i]) continue;
    for (size_t c = 0; c < 3; ++c) drawn.values[3 * i + c] = 0;
  }
  const Image wanted = imageOf(photo);
  const Result<ImageDifference> difference = compareImages(wanted, drawn);
  if (!difference) return difference.error();
  const Result<FlipImage> reference = prepareFlip(wanted), test = prepareFlip(drawn);
  if (!reference) return reference.error();
  if (!test) return test.error();
  const Result<FlipDifference> flip = compareFlip(*reference, *test);
  if (!flip) return flip.error();
  return PhotoErrors{psnrOf(photo, rendered), difference->ssim, flip->mean};
}

nlohmann::ordered_json errorsAsJson(const std::string& name, const PhotoErrors& errors) {
  return {{"view", name}, {"psnr", errors.psnr}, {"ssim", errors.ssim}, {"flip", errors.flip}};
}

void printErrors(const EvaluateOptions& options, const std::string& name, const PhotoErrors& errors) {
  if (!options.figures.wantsTable()) return;
  fmt::print("{}: PSNR {:.2f} dB, SSIM {:.4f}, FLIP {:.4f}\n", name, errors.psnr, errors.ssim, errors.flip);
}

Result<std::unique_ptr<GpuRenderer>> makeRenderer(const EvaluateOptions& options, const std::vector<Photo>& photos,
                                                  const Progress& progress) {
  const Result<AssetInput> asset = loadAsset(options.input, progress, kAllLayers);
  if (!asset) return asset.error();
  std::vector<SelectedView> views;
  for (const Photo& photo : photos) views.push_back({views.size(), photo.view});
  GpuDeviceOptions device = options.device;
  device.lensClasses = lensClassesOf(views);
  Result<std::unique_ptr<GpuRenderer>> renderer = GpuRenderer::create(device);
  if (!renderer) return renderer;
  if (Status loaded = (*renderer)->load(*asset, progress); !loaded) return loaded.error();
  return renderer;
}

Status evaluatePhotos(const EvaluateOptions& options, const std::vector<Photo>& photos, GpuRenderer& renderer,
                      const Progress& progress, nlohmann::ordered_json& figures) {
  GpuRenderOptions gpu;
  gpu.method = findMethod(options.renderer)->method;
  gpu.cutoff = static_cast<float>(options.cutoff);
  PhotoErrors sum;
  for (size_t i = 0; i < photos.size(); ++i) {
    if (!report(progress, "evaluate", i, photos.size())) return stoppedOnRequest("evaluation");
    const std::string& name = photos[i].view.name;
    Result<GpuFrame> frame = renderer.renderColour(photos[i].view, gpu);
    if (!frame) return frame.error();
    if (!options.output.empty()) {
      const std::filesystem::path file = (options.output / name).replace_extension(".png");
      if (Status written = writeOutput(file, frame->images.colour); !written) return written;
    }
    const Result<PhotoErrors> errors = compareWith(photos[i], std::move(frame->images.colour));
    if (!errors) return errors.error();
    sum = {sum.psnr + errors->psnr, sum.ssim + errors->ssim, sum.flip + errors->flip};
    printErrors(options, name, *errors);
    figures["views"].push_back(errorsAsJson(name, *errors));
  }
  const auto count = static_cast<double>(photos.size());
  const PhotoErrors mean{sum.psnr / count, sum.ssim / count, sum.flip / count};
  printErrors(options, fmt::format("mean of {} photos", photos.size()), mean);
  figures["mean"] = {{"psnr", mean.psnr}, {"ssim", mean.ssim}, {"flip", mean.flip}};
  return {};
}

Status runEvaluate(EvaluateOptions options, const Progress& progress) {
  options.photos.alpha = options.isPremultiplied ? AlphaForm::kPremultiplied : AlphaForm::kStraight;
  const Result<std::vector<Photo>> photos = readChosen(options, progress);
  if (!photos) return photos.error();
  const Result<std::unique_ptr<GpuRenderer>> renderer = makeRenderer(options, *photos, progress);
  if (!renderer) return renderer.error();
  nlohmann::ordered_json figures{{"input", options.input.string()},      {"scene", options.scene.string()},
                                 {"renderer", options.renderer},         {"cutoff", options.cutoff},
                                 {"device", (*renderer)->device().name}, {"driver", (*renderer)->device().driver}};
  if (Status done = evaluatePhotos(options, *photos, **renderer, progress, figures); !done) return done;
  return options.figures.write(figures);
}

}  // namespace

void addEvaluateCommand(CLI::App& program, Tool& tool) {
  auto options = std::make_shared<EvaluateOptions>();
  CLI::App& command = *program.add_subcommand("evaluate", "How well the runtime draws what test photos show");
  command.add_option("INPUT", options->input, "A .froth file, or a checkpoint")->required();
  command.add_option("scene", options->scene, "A folder with a COLMAP model or transforms.json")->required();
  command.add_option("-o,--output", options->output, "A folder for what was drawn, as PNG");
  command.add_option("--test-every", options->testPeriod, "The photos that `froth train` tested with this")
      ->check(countBetween(0, 1000000));
  command.add_flag("--all", options->isAll, "All photos, those that trained too");
  command.add_option("--downscale", options->photos.downscale, "Divides the sides of photos")
      ->check(numberBetween(1, 64));
  command.add_flag("--premultiplied", options->isPremultiplied, "Alpha of photos is premultiplied");
  command.add_flag("--mask-as-alpha", options->photos.isMaskAlpha, "Masks cut the object out");
  command.add_flag("--even-exposure", options->evensExposure, "As `froth train` was told");
  command.add_option("--renderer", options->renderer, "raster or walk")
      ->capture_default_str()
      ->check(CLI::IsMember(methodNames()));
  command.add_option("--cutoff", options->cutoff, "A ray ends below this transmittance")
      ->capture_default_str()
      ->check(numberBetween(0, 1));
  command.add_option("--device", options->device.device, "Index or part of a name (`froth devices`)");
  addFiguresOption(command, options->figures);
  command.callback(
      [options, &tool] { tool.action = [options, &tool] { return runEvaluate(*options, tool.progress.callback()); }; });
}

}  // namespace froth
