// froth render: pictures of a checkpoint or an asset, by the reference renderer or through the runtime.
#include <chrono>
#include <functional>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <glm/glm.hpp>

#include "baker/input/foam_input.h"
#include "measure/figures.h"
#include "measure/gpu/gpu_camera.h"
#include "measure/gpu/gpu_renderer.h"
#include "reference/capture/view_selection.h"
#include "reference/render/reference.h"
#include "shaders/foam/colour.h"
#include "tool/commands.h"
#include "tool/options.h"
#include "tool/view_output.h"

namespace froth {
namespace {

struct RenderCommandOptions {
  std::filesystem::path input, output;
  ViewOptions views;
  std::string renderer, precision = "double", channel = "colour";
  double cutoff = 0;
  bool isLinear = false;
  uint32_t layers = kAllLayers;
  GpuDeviceOptions device;
  FiguresOutput figures;

  bool isReference() const { return renderer == "reference"; }
};

// What the two kinds of renderers have in common: draws a view, says what it met.
struct Drawing {
  RenderedImages images;
  FrothViewStatus status{};  // zero from the reference
};
using DrawView = std::function<Result<Drawing>(const View&)>;

void decodeColour(RenderedImages& images) {
  for (size_t pixel = 0; pixel < images.alpha.values.size(); ++pixel) {
    float* colour = &images.colour.values[pixel * 3];
    const glm::vec3 linear =
        foam::linearPremultiplied<float>({colour[0], colour[1], colour[2]}, images.alpha.values[pixel]);
    for (int channel = 0; channel < 3; ++channel) colour[channel] = linear[channel];
  }
}

Image& pickChannel(RenderedImages& images, const std::string& channel) {
  if (channel == "alpha") return images.alpha;
  if (channel == "depth") return images.distance;
  if (channel == "normal") return images.normal;
  return images.colour;
}

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string describeBits(uint32_t bits) {
  std::string text;
  if (bits & FROTH_VIEW_CELL_OVERFLOW) text += ", cells overflowed";
  if (bits & FROTH_VIEW_PAIR_OVERFLOW) text += ", pairs overflowed";
  if (bits & FROTH_VIEW_STEP_LIMIT) text += ", walks hit the step limit";
  if (bits & FROTH_VIEW_ENTRY_LIMIT) text += ", tiles hit the limit of their lists";
  if (bits & FROTH_VIEW_NOT_READY) text += ", the asset was not ready";
  return text;
}

// Draws and writes every view; `figures` gets an entry for each.
Status drawViews(const RenderCommandOptions& options, const std::vector<SelectedView>& views,
                 const std::vector<std::filesystem::path>& paths, const DrawView& draw,
                 nlohmann::ordered_json& figures) {
  for (size_t i = 0; i < views.size(); ++i) {
    const View& view = views[i].view;
    const auto start = std::chrono::steady_clock::now();
    Result<Drawing> drawing = draw(view);
    if (!drawing) return drawing.error();
    const double seconds = secondsSince(start);
    if (Status written = writeOutput(paths[i], pickChannel(drawing->images, options.channel)); !written) return written;
    if (options.figures.wantsTable()) {
      fmt::print("{}: view {}, {}x{}, {:.3f} s{}\n", paths[i].string(), views[i].index, view.width, view.height,
                 seconds, describeBits(drawing->status.bits));
    }
    figures["views"].push_back({{"view", views[i].index},
                                {"name", view.name},
                                {"file", paths[i].string()},
                                {"width", view.width},
                                {"height", view.height},
                                {"seconds", seconds},
                                {"cellOverflow", (drawing->status.bits & FROTH_VIEW_CELL_OVERFLOW) != 0},
                                {"pairOverflow", (drawing->status.bits & FROTH_VIEW_PAIR_OVERFLOW) != 0},
                                {"stepLimit", (drawing->status.bits & FROTH_VIEW_STEP_LIMIT) != 0},
                                {"entryLimit", (drawing->status.bits & FROTH_VIEW_ENTRY_LIMIT) != 0},
                                {"longestList", drawing->status.longestList},
                                {"visibleCells", drawing->status.visibleCells},
                                {"pairs", drawing->status.pairs},
                                {"viewBytes", drawing->status.deviceBytes}});
  }
  return {};
}

Status renderReference(const RenderCommandOptions& options, const std::vector<SelectedView>& views,
                       const std::vector<std::filesystem::path>& paths, const Progress& progress,
                       nlohmann::ordered_json& figures) {
  const Result<FoamInput> input = loadFoam(options.input, progress, options.layers);
  if (!input) return input.error();
  const ReferenceRenderer renderer(input->foam);
  figures["precision"] = options.precision;
  return drawViews(
      options, views, paths,
      [&](const View& view) -> Result<Drawing> {
        ReferenceOptions reference;
        reference.precision = options.precision == "float" ? Precision::kFloat : Precision::kDouble;
        reference.cutoff = options.cutoff;
        reference.nearRatio = view.nearRatio.value_or(input->nearRatio);
        reference.nearDepth = view.nearDepth.value_or(input->nearDepth);
        reference.detailSharpness = input->detailSharpness;
        Result<RenderedImages> images = renderer.render(view, reference, progress);
        if (!images) return images.error();
        if (options.isLinear) decodeColour(*images);
        return Drawing{std::move(*images), {}};
      },
      figures);
}

Status renderOnDevice(const RenderCommandOptions& options, const std::vector<SelectedView>& views,
                      const std::vector<std::filesystem::path>& paths, const Progress& progress,
                      nlohmann::ordered_json& figures) {
  const Result<AssetInput> asset = loadAsset(options.input, progress, options.layers);
  if (!asset) return asset.error();
  GpuDeviceOptions device = options.device;
  device.lensClasses = lensClassesOf(views);
  Result<std::unique_ptr<GpuRenderer>> renderer = GpuRenderer::create(device);
  if (!renderer) return renderer.error();
  if (Status loaded = (*renderer)->load(*asset, progress); !loaded) return loaded;
  figures["device"] = (*renderer)->device().name;
  figures["driver"] = (*renderer)->device().driver;

  GpuRenderOptions gpu;
  gpu.method = findMethod(options.renderer)->method;
  gpu.cutoff = static_cast<float>(options.cutoff);
  gpu.isLinear = options.isLinear;
  return drawViews(
      options, views, paths,
      [&](const View& view) -> Result<Drawing> {
        Result<GpuFrame> frame = (*renderer)->render(view, gpu);
        if (!frame) return frame.error();
        return Drawing{std::move(frame->images), frame->status};
      },
      figures);
}

// PNG holds display-coded values within 0..1, and nothing else.
Status checkOptions(const CLI::App& command, const RenderCommandOptions& options) {
  const bool isColour = options.channel == "colour";
  if (options.isLinear && !isColour) {
    return makeError(ErrorKind::kUsage, "--linear: channel %s has no display coding; leave it out",
                     options.channel.c_str());
  }
  if (options.output.extension() == ".png" && (options.isLinear || (!isColour && options.channel != "alpha"))) {
    return makeError(ErrorKind::kUsage, "-o %s: a png cannot hold %s; name a .pfm", options.output.c_str(),
                     options.isLinear ? "linear colour" : options.channel.c_str());
  }
  if (!options.isReference() && command.count("--precision") > 0) {
    return makeError(ErrorKind::kUsage, "--precision belongs to the reference renderer; the GPU computes in float");
  }
  if (options.isReference() && command.count("--device") + command.count("--validate") > 0) {
    return makeError(ErrorKind::kUsage,
                     "--device and --validate belong to raster and walk; the reference uses the CPU");
  }
  return checkLayers(options.input, options.layers);
}

Status runRender(const CLI::App& command, RenderCommandOptions options, const Progress& progress) {
  if (Status good = checkOptions(command, options); !good) return good;
  if (command.count("--cutoff") == 0) options.cutoff = options.isReference() ? 0.0 : 1e-3;
  const Result<std::vector<SelectedView>> views = selectViews(options.views);
  if (!views) return views.error();
  const Result<std::vector<std::filesystem::path>> paths = outputPaths(options.views, *views, options.output);
  if (!paths) return paths.error();

  nlohmann::ordered_json figures{{"input", options.input.string()}, {"renderer", options.renderer},
                                 {"channel", options.channel},      {"linear", options.isLinear},
                                 {"layers", options.layers},        {"cutoff", options.cutoff}};
  const auto render = options.isReference() ? renderReference : renderOnDevice;
  if (Status rendered = render(options, *views, *paths, progress, figures); !rendered) return rendered;
  return options.figures.write(figures);
}

}  // namespace

void addRenderCommand(CLI::App& program, Tool& tool) {
  CLI::App* command = program.add_subcommand("render", "Draw views of a checkpoint or an asset");
  auto options = std::make_shared<RenderCommandOptions>();
  command->add_option("INPUT", options->input, "A checkpoint or a .froth file")->required();
  command->add_option("-o,--output", options->output, "With --view an image (.pfm, .png), else a folder")->required();
  command->add_option("--cameras", options->views.cameras, kCamerasHelp)->required();
  addViewOptions(*command, options->views);
  command->add_option("--renderer", options->renderer, "reference (CPU), raster or walk (Vulkan)")
      ->required()
      ->check(CLI::IsMember(methodNames({"reference"})));
  command->add_option("--precision", options->precision, "Of the reference")
      ->capture_default_str()
      ->check(CLI::IsMember({"float", "double"}));
  command->add_option("--cutoff", options->cutoff, "A ray ends below this transmittance; default 1e-3, reference 0")
      ->check(numberBetween(0, 1));
  command->add_option("--channel", options->channel, "What to write")
      ->capture_default_str()
      ->check(CLI::IsMember({"colour", "alpha", "depth", "normal"}));
  command->add_flag("--linear", options->isLinear, "Colour in linear light instead of display-coded");
  addLayersOption(*command, options->layers);
  command->add_option("--device", options->device.device, "Index or part of a name (`froth devices`)");
  command->add_flag_callback(
      "--validate", [options] { options->device.validate = options->device.checkIndices = true; },
      "Validation layers and checked indices; fail on a message");
  addFiguresOption(*command, options->figures);
  command->callback([&tool, command, options] {
    tool.action = [&tool, command, options] { return runRender(*command, *options, tool.progress.callback()); };
  });
}

}  // namespace froth
