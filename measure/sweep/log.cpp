#include "measure/sweep/log.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

namespace froth {
namespace {

Error unwritable(const std::filesystem::path& file) {
  return makeError(ErrorKind::kIo, "%s: cannot be written: %s", file.c_str(), std::strerror(errno));
}

}  // namespace

Result<ReportLog> ReportLog::open(std::filesystem::path file, const std::string& signature, bool resumes) {
  ReportLog log;
  log.file_ = std::move(file);
  if (resumes && std::filesystem::exists(log.file_)) {
    if (Status good = log.read(signature); !good) return good.error();
    return log;
  }
  std::ofstream out(log.file_, std::ios::trunc);
  out << nlohmann::json(signature).dump() << '\n' << std::flush;
  if (!out) return unwritable(log.file_);
  return log;
}

// A line that an interruption cut short is the last, and is left out.
Status ReportLog::read(const std::string& signature) {
  std::ifstream in(file_);
  std::string line;
  std::getline(in, line);
  if (line != nlohmann::json(signature).dump()) {
    return makeError(ErrorKind::kUsage,
                     "%s: measured with other inputs or options (%s); leave out --resume to begin anew", file_.c_str(),
                     line.substr(0, 200).c_str());
  }
  while (std::getline(in, line)) {
    const nlohmann::ordered_json json = nlohmann::ordered_json::parse(line, nullptr, false);
    if (json.is_discarded()) break;
    Result<ReportPoint> point = pointFromJson(json);
    if (!point) return makeError(ErrorKind::kBadInput, "%s: %s", file_.c_str(), point.error().message.c_str());
    std::erase_if(found_, [&](const ReportPoint& old) { return old.id == point->id; });
    found_.push_back(std::move(*point));
  }
  return {};
}

Status ReportLog::append(const ReportPoint& point) {
  std::ofstream out(file_, std::ios::app);
  out << pointAsJson(point).dump() << '\n' << std::flush;
  if (!out) return unwritable(file_);
  return {};
}

}  // namespace froth
