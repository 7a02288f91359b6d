#include "measure/stability/table.h"

#include <cmath>

#include <fmt/format.h>

#include "base/atomic_file.h"
#include "base/output_file.h"
#include "measure/marked_text.h"
#include "measure/stability/published_forms.h"

namespace froth {
namespace {

constexpr const char* kTables = "";
constexpr const char* kFormsSection = "published forms, ";
constexpr const char* kFigure = "published_forms.svg";

std::string numberText(double value) { return value == 0 ? "0" : fmt::format("{:.1e}", value); }

std::string psnrText(double psnr) { return std::isinf(psnr) ? "equal" : fmt::format("{:.1f}", psnr); }

const RendererOutcome* findRenderer(const PresetOutcome& preset, const std::string& name) {
  for (const RendererOutcome& renderer : preset.renderers) {
    if (renderer.renderer == name) return &renderer;
  }
  return nullptr;
}

// Largest error, and how much of their bounds the worst colour and the worst of all channels take.
std::string errorText(const PresetOutcome& preset, const std::string& name) {
  const RendererOutcome* renderer = findRenderer(preset, name);
  if (!renderer) return "-";
  return fmt::format("{} ({:.2g}, {:.2g})", numberText(renderer->maxError), renderer->colourExcess,
                     renderer->worstExcess);
}

std::string markdownOf(const JudgedCase& judged) {
  const StiffCase& stiff = judged.stiff;
  std::string text = fmt::format("| `{}` | {} | {} ", stiff.name, stiff.what, verdictName(judged.outcome.verdict));
  if (judged.outcome.presets.empty()) return text + "| - | - | - | - | - | - | - | - | - | - |\n";
  bool isFirst = true;
  for (const PresetOutcome& preset : judged.outcome.presets) {
    if (!isFirst) text += "| | | ";
    isFirst = false;
    text +=
        fmt::format("| {} | {} / {} |", preset.preset, numberText(preset.boundLargest), numberText(preset.boundMean));
    for (const char* renderer : {"float", "raster", "walk", "rays", "queries", "raster shipped", "walk shipped"}) {
      text += fmt::format(" {} |", errorText(preset, renderer));
    }
    text += fmt::format(" {} |\n", psnrText(preset.encodingPsnr));
  }
  return text;
}

std::string tables(const std::vector<JudgedCase>& cases, const HostDeviceInfo& device) {
  std::string text = fmt::format("Drawn on {} ({}).\n\n", device.name, device.driver);
  text +=
      "| case | what | verdict | preset | bound: largest / mean | CPU float | raster | walk | GPU rays | CPU queries | "
      "raster, as shipped | "
      "walk, as shipped | encoding [dB] |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const JudgedCase& judged : cases) text += markdownOf(judged);
  text += "\n## What conditions each image\n\n";
  for (const JudgedCase& judged : cases) {
    text += fmt::format("- `{}`: {}\n", judged.stiff.name, judged.stiff.analysis);
    if (!judged.outcome.refusal.empty()) text += fmt::format("  Refused: \"{}\".\n", judged.outcome.refusal);
    for (const KnownFault& known : judged.stiff.known) {
      text += fmt::format("  **Falls short** ({}, {}): {}.\n", known.preset, known.renderer, known.cause);
    }
    for (const SeenFault& fault : judged.outcome.faults) text += fmt::format("  - {}\n", fault.text);
  }
  return text;
}

std::filesystem::path imagesBeside(const std::filesystem::path& path) { return path.parent_path() / "images"; }

std::string publishedForms(const std::vector<PublishedForm>& forms) {
  std::string text = fmt::format("![{}](images/{})\n", forms.front().what, kFigure);
  for (const PublishedForm& form : forms) text += fmt::format("\n### `{}`\n\n{}", form.name, tableOf(form));
  return text;
}

}  // namespace

void printCase(const JudgedCase& judged) {
  fmt::print("{:<30} {}\n", judged.stiff.name, verdictName(judged.outcome.verdict));
  for (const PresetOutcome& preset : judged.outcome.presets) {
    fmt::print("  {:<8} bound {:>8} / {:>8}", preset.preset, numberText(preset.boundLargest),
               numberText(preset.boundMean));
    for (const RendererOutcome& run : preset.renderers) {
      fmt::print(", {} {}", run.renderer, errorText(preset, run.renderer));
    }
    fmt::print(", encoding {} dB\n", psnrText(preset.encodingPsnr));
  }
  for (const SeenFault& fault : judged.outcome.faults) fmt::print("  {}\n", fault.text);
  for (const std::string& line : judged.outcome.unexplained) fmt::print("  not known: {}\n", line);
  std::fflush(stdout);
}

nlohmann::ordered_json caseAsJson(const JudgedCase& judged) {
  nlohmann::ordered_json json = {{"name", judged.stiff.name},
                                 {"what", judged.stiff.what},
                                 {"analysis", judged.stiff.analysis},
                                 {"verdict", verdictName(judged.outcome.verdict)},
                                 {"refusal", judged.outcome.refusal},
                                 {"faults", nlohmann::ordered_json::array()},
                                 {"unexplained", judged.outcome.unexplained}};
  for (const SeenFault& fault : judged.outcome.faults) {
    json["faults"].push_back({{"preset", fault.preset},
                              {"renderer", fault.renderer},
                              {"kind", fault.kind},
                              {"factor", fault.factor},
                              {"text", fault.text}});
  }
  for (const PresetOutcome& preset : judged.outcome.presets) {
    nlohmann::ordered_json renderers = nlohmann::ordered_json::object();
    for (const RendererOutcome& run : preset.renderers) {
      renderers[run.renderer] = {
          {"maxError", run.maxError},         {"worstExcess", run.worstExcess}, {"colourExcess", run.colourExcess},
          {"shareOver", run.shareOver},       {"worstPlace", placeText(run)},   {"isFinite", run.isFinite},
          {"isRepeatable", run.isRepeatable}, {"tilesExcess", run.tilesExcess}, {"endsInTime", run.endsInTime}};
    }
    json["presets"].push_back({{"preset", preset.preset},
                               {"boundLargest", preset.boundLargest},
                               {"boundMean", preset.boundMean},
                               {"renderers", renderers},
                               {"rasterWalkExcess", preset.rasterWalkExcess},
                               {"walks",
                                {{"rays", preset.walks.rays},
                                 {"steps", preset.walks.steps},
                                 {"mostSteps", preset.walks.mostSteps},
                                 {"violations", preset.walks.violations},
                                 {"lost", preset.walks.lost}}},
                               {"encodingPsnr", preset.encodingPsnr},
                               {"encodingMax", preset.encodingMax}});
  }
  return json;
}

Status checkMarkdown(const std::filesystem::path& path) {
  if (Status writable = checkWritable(path); !writable) return writable;
  std::error_code error;
  std::filesystem::create_directories(imagesBeside(path), error);
  if (error) {
    return makeError(ErrorKind::kIo, "%s: cannot be made: %s", imagesBeside(path).c_str(), error.message().c_str());
  }
  const Result<std::string> text = readMarked(path, {kTables, kFormsSection});
  if (!text) return text.error();
  return {};
}

Status writeMarkdown(const std::filesystem::path& path, const std::vector<JudgedCase>& cases,
                     const HostDeviceInfo& device) {
  Result<std::string> text = readMarked(path, {kTables, kFormsSection});
  if (!text) return text.error();
  const std::vector<PublishedForm> forms = comparePublishedForms();
  replaceMarked(*text, kTables, tables(cases, device));
  replaceMarked(*text, kFormsSection, publishedForms(forms));
  const auto write = [](const std::filesystem::path& file, const std::string& bytes) {
    return writeFileAtomically(file, {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
  };
  if (Status written = write(imagesBeside(path) / kFigure, drawPlotFile(plotOf(forms.front()))); !written) {
    return written;
  }
  return write(path, *text);
}

}  // namespace froth
