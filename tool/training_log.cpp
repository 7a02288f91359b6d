#include "tool/training_log.h"

#include <nlohmann/json.hpp>

namespace froth {

Status TrainingLog::open(const std::filesystem::path& path, bool goesOn) {
  path_ = path;
  file_.open(path, goesOn ? std::ios::app : std::ios::trunc);
  if (file_) return {};
  return makeError(ErrorKind::kIo, "%s: cannot be written; give --log a file in a folder that you may write to",
                   path.c_str());
}

Status TrainingLog::write(const TrainingMoment& moment) {
  nlohmann::ordered_json line = {{"steps", moment.stepsDone}, {"seconds", moment.seconds}, {"cells", moment.cells}};
  line["psnr"] = moment.psnr > 0 ? nlohmann::ordered_json(moment.psnr) : nlohmann::ordered_json();
  file_ << line.dump() << std::endl;  // a reader follows it
  if (file_) return {};
  return makeError(ErrorKind::kIo, "%s: cannot be written, is the disk full?", path_.c_str());
}

}  // namespace froth
