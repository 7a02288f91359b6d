#include "reference/capture/capture_names.h"

#include <filesystem>

#include "foam/checkpoint/bad_input.h"

namespace froth {

Status checkPhotoName(const std::string& name, const std::string& place) {
  const std::filesystem::path path = std::filesystem::path(name).lexically_normal();
  const bool leadsOut = path.is_absolute() || (path.begin() != path.end() && *path.begin() == "..");
  const bool isName = path.has_filename() && path != "." && name.find('\0') == std::string::npos;
  if (isName && !leadsOut) return {};
  return badInput(place, "found {}; give the name of a file below the folder of the photos",
                  name.empty() ? std::string("nothing") : froth::quoted(name));
}

}  // namespace froth
