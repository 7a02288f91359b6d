// Where the published formulas lose digits, Froth's do not.
#include "measure/stability/published_forms.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace froth {
namespace {

const PublishedForm& formOf(const std::string& name) {
  static const std::vector<PublishedForm> forms = comparePublishedForms();
  const auto found =
      std::find_if(forms.begin(), forms.end(), [&](const PublishedForm& form) { return form.name == name; });
  EXPECT_NE(found, forms.end()) << name;
  return *found;
}

double errorAt(const PublishedForm& form, size_t series, double abscissa) {
  for (size_t i = 0; i < form.abscissae.size(); ++i) {
    if (std::abs(form.abscissae[i] / abscissa - 1) < 1e-6) return form.series.at(series).errors[i];
  }
  ADD_FAILURE() << form.name << " at " << abscissa;
  return 0;
}

double largest(const FormSeries& series) { return *std::max_element(series.errors.begin(), series.errors.end()); }

TEST(PublishedForms, RadicalPlanesKeepTheirPlaceFarFromTheOriginInTheCellsFrameOnly) {
  const PublishedForm& form = formOf("radical_planes");
  EXPECT_LE(largest(form.series.back()), 1e-5);
  EXPECT_GE(errorAt(form, 0, 100), 1e-2);
  EXPECT_GE(errorAt(form, 1, 1e4), 1e-1);
  EXPECT_EQ(errorAt(form, 1, 1e9), kLargestError);
}

TEST(PublishedForms, ChordsOfFarBallsStay) {
  const PublishedForm& form = formOf("balls");
  EXPECT_GE(errorAt(form, 0, 1e4), 1);
  EXPECT_LE(errorAt(form, 1, 1e4), 1e-2);
}

TEST(PublishedForms, TheNearLimitDoesNotDependOnTheLens) {
  const PublishedForm& form = formOf("forward_vectors");
  EXPECT_NEAR(errorAt(form, 0, 0.1), kLargestError, 0);
  EXPECT_LE(errorAt(form, 0, 1), 1e-6);
  EXPECT_LE(largest(form.series.back()), 1e-6);
}

TEST(PublishedForms, ThinStretchesKeepTheirOpacity) {
  const PublishedForm& form = formOf("opacities");
  EXPECT_GE(errorAt(form, 0, 1e-8), 0.5);
  EXPECT_LE(largest(form.series.back()), 1e-6);
}

TEST(PublishedForms, AreTabledAndDrawn) {
  for (const PublishedForm& form : comparePublishedForms()) {
    for (const FormSeries& series : form.series) {
      EXPECT_EQ(series.errors.size(), form.abscissae.size());
      EXPECT_THAT(tableOf(form), testing::HasSubstr(series.name));
      EXPECT_THAT(drawPlotFile(plotOf(form)), testing::HasSubstr(series.name));
    }
    EXPECT_EQ(tableOf(form).find("nan"), std::string::npos);
  }
}

}  // namespace
}  // namespace froth
