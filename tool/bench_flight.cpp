#include "tool/bench_flight.h"

#include <vector>

#include "measure/flight/flight_figures.h"
#include "measure/flight/pops_figures.h"
#include "tool/options.h"

namespace froth {
namespace {

Result<std::vector<Pose>> keyPoses(const std::filesystem::path& cameras) {
  const Result<CameraSet> set = readViews(cameras);
  if (!set) return set.error();
  std::vector<Pose> keys;
  for (const View& view : set->flight.empty() ? set->views : set->flight) {
    if (view.lens.kind != LensKind::kPinhole) {
      return makeError(ErrorKind::kUsage, "%s: '%s' has a lens; a flight takes pinhole cameras",
                       cameras.string().c_str(), view.name.c_str());
    }
    keys.push_back(poseFromMatrix(view.worldFromCamera.data(), view.height / (2 * view.fy)));
  }
  return keys;
}

}  // namespace

void addFlightOptions(CLI::App& command, FlightFlags& flags) {
  FlightOptions& options = flags.flight;
  constexpr const char* kGroup = "Flight with streaming";
  const auto needsFlight = [&](CLI::Option* option) { option->needs("--flight")->group(kGroup); };
  CLI::Option* const flight =
      command
          .add_option("--flight", options.frames, "Fly so many frames along the cameras, and stream levels of detail")
          ->check(countBetween(2, 10000000))
          ->group(kGroup);
  for (const char* other : {"--view", "--counters", "--frames", "--warmup", "--layers"}) flight->excludes(other);
  const auto addBytes = [&](const char* name, uint64_t& bytes, const char* description) {
    return command.add_option(name, bytes, description)->transform(CLI::AsSizeValue(false));
  };
  needsFlight(
      command.add_option("--copies", options.scene.copies, "Open INPUT so often, and set the assets beside each other")
          ->capture_default_str()
          ->check(countBetween(1, kMostCopies)));
  needsFlight(addBytes("--budget", options.scene.budget, "Device memory, as 64MB; 0: no limit"));
  needsFlight(command
                  .add_option("--reserve-cells", options.scene.reserveCells,
                              "Cells that the view has room for ahead of what frames show; 0: 1048576")
                  ->check(countBetween(0, UINT32_MAX)));
  needsFlight(command.add_option("--detail", options.scene.detail, "Errors may be 1 / DETAIL pixels large")
                  ->capture_default_str()
                  ->check(numberBetween(1e-6, 1e6)));
  needsFlight(command.add_option("--most-cells", options.scene.mostCells, "Live cells above the floor; 0: no limit"));
  needsFlight(
      command.add_option("--fade", options.scene.fadeFrames, "Frames in which a change of levels fades, 0 to 64")
          ->check(countBetween(0, 64)));
  needsFlight(addDurationOption(command, "--disk-latency", options.scene.disk.latency,
                                "From a request to its first byte", 0, 60));
  needsFlight(
      command.add_option("--disk-rate", options.scene.disk.bytesPerSecond, "Bytes a second, as 200MB; 0: at once")
          ->transform(CLI::AsSizeValue(false)));
  needsFlight(
      command.add_option("--fail-once", options.scene.disk.failOnce, "Share of the ranges whose first read fails")
          ->check(numberBetween(0, 1)));
  needsFlight(command.add_flag("--bad-chunk", options.scene.disk.hasBadRange, "One range cannot be read at all"));
  CLI::Option* const jumps =
      command.add_option("--jump-every", options.jumpEvery, "After so many frames the camera goes on elsewhere")
          ->check(countBetween(1, 10000000));
  CLI::Option* const images =
      command.add_option("--image-every", options.imageEvery, "Frames between images that are compared")
          ->capture_default_str()
          ->check(countBetween(1, 10000000));
  needsFlight(command.add_flag("--from-rest", options.isFromRest, "Begin when all that the first view wants is drawn"));
  needsFlight(jumps);
  needsFlight(images);
  needsFlight(command
                  .add_flag("--pops", flags.wantsPops,
                            "Move slowly forwards from the first view instead, and tell how pixels change by frame")
                  ->excludes(jumps)
                  ->excludes(images));
}

namespace {

Status runPops(const CameraPath& path, const FlightOptions& options, const FiguresOutput& output,
               const Progress& progress) {
  const Result<Pops> pops = measurePops(viewOf(path, options, 0), options, progress);
  if (!pops) return pops.error();
  if (output.wantsTable()) printPops(*pops, options);
  return output.write(popsAsJson(*pops, options));
}

}  // namespace

Status runFlight(const FlightFlags& flags, const ViewOptions& views, const FiguresOutput& output,
                 const Progress& progress) {
  const Result<std::vector<SelectedView>> selected = selectViews(views);
  if (!selected) return selected.error();
  Result<std::vector<Pose>> keys = keyPoses(views.cameras);
  if (!keys) return keys.error();
  FlightOptions sized = flags.flight;
  sized.scene.extent = {selected->front().view.width, selected->front().view.height};
  const CameraPath path(std::move(*keys));
  if (flags.wantsPops) return runPops(path, sized, output, progress);
  const Result<Flight> flight = fly(path, sized, progress);
  if (!flight) return flight.error();
  if (output.wantsTable()) printFlight(*flight, sized);
  return output.write(flightAsJson(*flight, sized));
}

}  // namespace froth
