// Keeps what an interrupted report has measured.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"
#include "measure/report/report.h"

namespace froth {

class ReportLog {
 public:
  // `signature`: what figures depend on; a log with another is refused. Without `resumes` an old log is dropped.
  static Result<ReportLog> open(std::filesystem::path file, const std::string& signature, bool resumes);

  const std::vector<ReportPoint>& found() const { return found_; }  // the newest of each id
  Status append(const ReportPoint& point);

 private:
  Status read(const std::string& signature);

  std::filesystem::path file_;
  std::vector<ReportPoint> found_;
};

}  // namespace froth
