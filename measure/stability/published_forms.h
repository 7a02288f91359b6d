// Formulas of the published code that lose digits, beside those that Froth uses instead: the error of both over what
// makes it grow.
#pragma once

#include <string>
#include <vector>

#include "measure/report/svg_plot.h"

namespace froth {

struct FormSeries {
  std::string name;            // "published, fp16"
  std::vector<double> errors;  // [abscissae] largest of some hundred random inputs; at most kLargestError
};

// Larger errors, infinity and NaN are cut to it: nothing of the value is left.
inline constexpr double kLargestError = 10;

struct PublishedForm {
  std::string name;      // "radical_planes"
  std::string what;      // what is computed, and how by either form
  std::string abscissa;  // "distance from the origin [radii]"
  std::string error;     // "error of where a ray meets the plane [radii]"
  std::vector<double> abscissae;
  std::vector<FormSeries> series;  // Froth's last
};

// Against the same formula in double. The same numbers on every call.
std::vector<PublishedForm> comparePublishedForms();

// A table of a form: a row for each abscissa.
std::string tableOf(const PublishedForm& form);
// A figure of it, with logarithmic axes.
Plot plotOf(const PublishedForm& form);

}  // namespace froth
