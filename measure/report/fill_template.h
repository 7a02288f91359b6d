// The Mustache templates of templates/, filled.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace froth {

// "page.html" and its text: every file of templates/, built into the program (CMakeLists.txt).
const std::vector<std::pair<std::string, std::string>>& allTemplates();

// The template `name` with members of `values`; other templates are its partials. Texts are escaped. Numbers are
// written as their member's name asks: "psnr" as decibels; one without a rule as a coordinate. Empty texts and null
// count as absent.
std::string fillTemplate(const std::string& name, const nlohmann::ordered_json& values);

// A coordinate of a drawing: "12", "12.5".
std::string coordinate(double value);

}  // namespace froth
