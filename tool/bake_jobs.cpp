#include "tool/bake_jobs.h"

#include <algorithm>
#include <system_error>

#include "baker/input/foam_input.h"

namespace froth {
namespace {

namespace fs = std::filesystem;

Status checkJob(const BakeJob& job) {
  if (!isAssetPath(job.output)) {
    return makeError(ErrorKind::kUsage, "-o %s: an asset's name ends in .froth", job.output.c_str());
  }
  if (!isAssetPath(job.input)) return {};
  return makeError(ErrorKind::kUsage, "%s is an asset already; bake the checkpoint that it came from",
                   job.input.c_str());
}

// The job of an entry of a folder; without input: it holds no checkpoint.
BakeJob jobOf(const fs::path& entry, const fs::path& outputs) {
  std::error_code ignored;
  const bool isFolder = fs::is_directory(entry, ignored);
  BakeJob job;
  if (isFolder ? fs::is_regular_file(entry / "model.pt", ignored) : entry.extension() == ".pt") {
    const fs::path name = isFolder ? entry.filename() : entry.stem();
    const fs::path cameras =
        isFolder ? entry / "cameras.json" : entry.parent_path() / (name.string() + ".cameras.json");
    job = {isFolder ? entry / "model.pt" : entry, outputs / (name.string() + ".froth"),
           fs::is_regular_file(cameras, ignored) ? cameras : fs::path()};
  }
  return job;
}

}  // namespace

Result<std::vector<BakeJob>> findBakeJobs(const BakeJob& given) {
  std::error_code error;
  if (!fs::is_directory(given.input, error)) {
    if (const Status status = checkJob(given); !status) return status.error();
    return std::vector{given};
  }
  if (!given.cameras.empty()) {
    return makeError(ErrorKind::kUsage,
                     "--cameras: of a folder each checkpoint has its own; name NAME.cameras.json beside NAME.pt");
  }
  std::vector<BakeJob> jobs;
  for (fs::directory_iterator entry(given.input, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    BakeJob job = jobOf(entry->path(), given.output);
    if (!job.input.empty()) jobs.push_back(std::move(job));
  }
  if (error) {
    return makeError(ErrorKind::kBadInput, "%s: cannot be read: %s", given.input.c_str(), error.message().c_str());
  }
  if (jobs.empty()) {
    return makeError(ErrorKind::kBadInput,
                     "%s: is a directory that holds no checkpoint; expected NAME.pt or NAME/model.pt",
                     given.input.c_str());
  }
  std::ranges::sort(jobs, {}, &BakeJob::output);
  const auto twin = std::ranges::adjacent_find(jobs, {}, &BakeJob::output);
  if (twin != jobs.end()) {
    return makeError(ErrorKind::kUsage, "%s and %s would both become %s; rename one", twin->input.c_str(),
                     (twin + 1)->input.c_str(), twin->output.c_str());
  }
  fs::create_directories(given.output, error);
  if (error) {
    return makeError(ErrorKind::kIo, "-o %s: cannot be made: %s", given.output.c_str(), error.message().c_str());
  }
  return jobs;
}

}  // namespace froth
