#include "base/output_file.h"

#include <cerrno>
#include <cstring>
#include <system_error>

#include <unistd.h>

namespace froth {

Status checkWritable(const std::filesystem::path& path, WriteProtected isProtected) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    return makeError(ErrorKind::kIo, "%s: is a directory; name a file", path.c_str());
  }
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    return makeError(ErrorKind::kIo, "%s: cannot be written: folder %s: %s; make it or choose another", path.c_str(),
                     folder.c_str(), std::strerror(errno));
  }
  return checkTarget(path, isProtected);
}

}  // namespace froth
