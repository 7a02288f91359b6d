#include "tool/bench_open.h"

#include <vector>

#include "measure/opening/opening_figures.h"
#include "tool/options.h"

namespace froth {

void addOpenOptions(CLI::App& command, OpeningOptions& options) {
  constexpr const char* kGroup = "Time to the first image";
  CLI::Option* const open =
      command
          .add_option("--open", options.runs, "Open INPUT, a .froth file or its URL, so often, and draw its first view")
          ->check(countBetween(1, 10000))
          ->group(kGroup);
  for (const char* other : {"--flight", "--counters", "--frames", "--warmup", "--layers"}) open->excludes(other);
  command.add_flag("--keep-cache", options.keepsCache, "Do not drop the file from the system's cache before each run")
      ->needs(open)
      ->group(kGroup);
}

Status runOpen(const OpeningOptions& options, const ViewOptions& views, const FiguresOutput& output,
               const Progress& progress) {
  const Result<std::vector<SelectedView>> selected = selectViews(views);
  if (!selected) return selected.error();
  OpeningOptions sized = options;
  sized.view = selected->front().view;
  const Result<Openings> openings = openAndDraw(sized, progress);
  if (!openings) return openings.error();
  if (output.wantsTable()) printOpenings(*openings, sized);
  return output.write(openingsAsJson(*openings, sized));
}

}  // namespace froth
