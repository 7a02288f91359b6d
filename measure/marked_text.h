// Text that a command writes into a page between two markers, around what people wrote.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"

namespace froth {

// The page, which must hold the markers of every section: "<!-- SECTIONmade by `froth stability --markdown`: begin -->"
// and, after it, "<!-- end -->", each a line. A page of empty sections where there is no file.
Result<std::string> readMarked(const std::filesystem::path& path, const std::vector<std::string>& sections);

// `text` as readMarked() gave it.
void replaceMarked(std::string& text, const std::string& section, const std::string& inside);

}  // namespace froth
