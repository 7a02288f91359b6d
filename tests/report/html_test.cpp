// report.html as text; browser_test.cpp opens it.
#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <set>

#include "base/image/formats.h"
#include "measure/report/report.h"
#include "tests/report/sample_report.h"

namespace froth {
namespace {

// The first thing that keeps the tags from being balanced; empty: nothing.
std::string firstUnbalanced(const std::string& html) {
  static const std::set<std::string> kEmpty{"!doctype", "meta", "link", "img", "br"};
  std::vector<std::string> open;
  for (size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at + 1)) {
    const size_t end = html.find('>', at);
    if (end == std::string::npos) return "a tag without an end";
    const bool closes = html[at + 1] == '/', isWhole = html[end - 1] == '/';
    const size_t from = at + 1 + closes;
    const std::string name = html.substr(from, html.find_first_of(" />", from) - from);
    if (closes) {
      if (open.empty() || open.back() != name) return "</" + name + "> at byte " + std::to_string(at);
      open.pop_back();
    } else if (!isWhole && !kEmpty.contains(name)) {
      open.push_back(name);
    }
    at = end;
  }
  return open.empty() ? "" : "<" + open.back() + "> is left open";
}

TEST(ReportHtml, TagsAreBalanced) {
  EXPECT_EQ(firstUnbalanced("<p><b>x</b></p>"), "");
  EXPECT_NE(firstUnbalanced("<p><b>x</p></b>"), "");
  EXPECT_EQ(firstUnbalanced(reportAsHtml(test::makeSampleReport())), "");
}

TEST(ReportHtml, LoadsNothingFromElsewhere) {
  Report report = test::makeSampleReport();
  const std::string html = reportAsHtml(report);
  report.images.clear();  // base64 may hold two slashes
  EXPECT_FALSE(std::regex_search(reportAsHtml(report), std::regex("(https?:)?//[a-z]", std::regex::icase)));
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_EQ(html.find("@import"), std::string::npos);
  EXPECT_EQ(html.find("url("), std::string::npos);
  const std::regex sources(" (?:src|href)=\"([^\"]{0,5})");
  for (std::sregex_iterator it(html.begin(), html.end(), sources), end; it != end; ++it) {
    const std::string target = (*it)[1];
    EXPECT_TRUE(target.starts_with("#") || target.starts_with("data:")) << target;
  }
}

TEST(ReportHtml, LinksWithinThePageLeadSomewhere) {
  const std::string html = reportAsHtml(test::makeSampleReport());
  const std::regex links("href=\"#([a-z]+)\"");
  size_t count = 0;
  for (std::sregex_iterator it(html.begin(), html.end(), links), end; it != end; ++it, ++count) {
    EXPECT_NE(html.find("id=\"" + (*it)[1].str() + "\""), std::string::npos) << (*it)[1];
  }
  EXPECT_EQ(count, 12u);  // all sections
}

TEST(ReportHtml, TheSameReportGivesTheSameBytes) {
  EXPECT_EQ(reportAsHtml(test::makeSampleReport()), reportAsHtml(test::makeSampleReport()));
  EXPECT_EQ(reportAsCsv(test::makeSampleReport()), reportAsCsv(test::makeSampleReport()));
}

TEST(ReportHtml, WithoutPicturesItStaysBelowTwoMegabytes) {
  Report report = test::makeSampleReport();
  report.images.clear();
  const std::string html = reportAsHtml(report);
  EXPECT_LT(html.size(), 2'000'000u);
  EXPECT_EQ(html.find("<img"), std::string::npos);
}

// Every text of a report, put to the test.
TEST(ReportHtml, NoTextReachesThePageUnescaped) {
  const std::string evil = "<script>alert('x')</script>&\"";
  Report report = test::makeSampleReport();
  for (std::string* text :
       {&report.scene, &report.input, &report.credit, &report.device, &report.driver, &report.version, &report.command,
        &report.choice, &report.notes[0], &report.slopes[0].what, &report.slopes[0].note, &report.slopes[0].verdict,
        &report.features[0].feature, &report.features[0].variant, &report.rays[0].rays, &report.rays[0].prepared,
        &report.images[0].title, &report.images[0].caption}) {
    *text = evil;
  }
  for (Sweep& sweep : report.sweeps) {
    sweep.knob += evil;
    sweep.meaning = sweep.unit = sweep.base.value = evil;
  }
  for (ReportPoint& point : report.points) {
    point.renderer += evil;
    for (Setting& setting : point.settings) setting.knob += evil, setting.value += evil;
    for (PassTimes& pass : point.passes) pass.pass = evil;
  }
  const std::string html = reportAsHtml(report);
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_NE(html.find("&lt;script&gt;"), std::string::npos);
  EXPECT_EQ(firstUnbalanced(html), "");
}

TEST(ReportHtml, DegenerateReportsAreStillPages) {
  EXPECT_EQ(firstUnbalanced(reportAsHtml(Report{})), "");
  Report report;
  report.points.resize(1);
  report.points[0].id = report.points[0].renderer = "raster";
  report.points[0].errors.psnr = INFINITY;
  report.points[0].errors.ssim = NAN;
  report.points[0].total = {1, 1, 1};
  report.sweeps.resize(1);
  report.sweeps[0].points = {"raster", "unknown"};
  report.slopes.resize(1);
  report.features.resize(1);
  report.images.resize(1);
  report.chosen = "unknown";
  report.frontOverTime = {"unknown"};
  const std::string html = reportAsHtml(report);
  EXPECT_EQ(firstUnbalanced(html), "");
  EXPECT_NE(html.find("equal the reference"), std::string::npos);
}

TEST(ReportHtml, HasARowForEachKindOfRays) {
  const std::string html = reportAsHtml(test::makeSampleReport());
  const size_t begin = html.find("<section id=\"rays\">"), end = html.find("</section>", begin);
  const std::string section = html.substr(begin, end - begin);
  EXPECT_NE(section.find("nothing 6.60 MB, radiance 28.9 MB for the asset"), std::string::npos) << section;
  EXPECT_NE(section.find("<td class=\"text\">mirrored, base colours</td><td class=\"number\">17"), std::string::npos)
      << section;
  EXPECT_NE(section.find("31.5"), std::string::npos) << section;
  EXPECT_EQ(section.find("31.5"), section.rfind("31.5"));  // the error does not depend on what is prepared
}

TEST(ReportHtml, SaysWhatIsATie) {
  const Report report = test::makeSampleReport();
  const std::string html = reportAsHtml(report);
  EXPECT_NE(html.find(">tie<"), std::string::npos);
  EXPECT_NE(html.find("ties with it in time"), std::string::npos);
}

// Tags, and nothing that is loaded from elsewhere.
TEST(TrainingHtml, IsAPageOfItsOwn) {
  const TrainingReport report = test::makeSampleTraining(0.4);
  const std::string html = trainingAsHtml(report);
  EXPECT_EQ(firstUnbalanced(html), "");
  EXPECT_EQ(html.find("url("), std::string::npos);
  const std::regex sources(" (?:src|href)=\"([^\"]{0,5})");
  for (std::sregex_iterator it(html.begin(), html.end(), sources), end; it != end; ++it) EXPECT_EQ((*it)[1], "data:");
  EXPECT_NE(html.find("1200 steps in 432 s, 40 % of the schedule"), std::string::npos);
  EXPECT_NE(html.find("aria-label=\"PSNR [dB] over seconds\""), std::string::npos);
  EXPECT_NE(html.find("aria-label=\"cells over seconds\""), std::string::npos);
}

TEST(TrainingHtml, IsLoadedAgainAsLongAsTheRunGoesOn) {
  EXPECT_NE(trainingAsHtml(test::makeSampleTraining(0.99)).find("http-equiv=\"refresh\""), std::string::npos);
  EXPECT_EQ(trainingAsHtml(test::makeSampleTraining(1)).find("http-equiv=\"refresh\""), std::string::npos);
}

TEST(TrainingHtml, WithoutTestPhotosHasNoCurveOfThem) {
  TrainingReport report = test::makeSampleTraining(1);
  report.pictures.clear();
  for (TrainingPoint& point : report.points) point.psnr = 0;
  report.title = "<script>";
  const std::string html = trainingAsHtml(report);
  EXPECT_EQ(firstUnbalanced(html), "");
  EXPECT_EQ(html.find("PSNR"), std::string::npos);
  EXPECT_EQ(html.find("<img"), std::string::npos);
  EXPECT_EQ(html.find("<script"), std::string::npos);
}

TEST(TrainingHtml, ShrinksPhotosToFitBesideEachOther) {
  const TrainingReport report = test::makeSampleTraining(1);
  const Result<Image> pair = decodePng(report.pictures[0].png, "pair");
  ASSERT_TRUE(pair) << pair.error().message;
  EXPECT_EQ(pair->width, 400u + 8 + 400);  // a third of 1200: at most 480
  EXPECT_EQ(pair->height, 266u);
  EXPECT_NEAR(pair->pixel(200, 100)[1], 0.5, 0.01);
  EXPECT_NEAR(pair->pixel(608, 100)[1], 0.4, 0.01);
}

TEST(ErrorPictures, FrameTheWorstPixelAndStayWithinTheImage) {
  Image reference{60, 50, 3, std::vector<float>(60 * 50 * 3, 0.5f)}, image = reference;
  image.pixel(59, 0)[1] = 0.6f;
  const Result<std::vector<ReportImage>> pictures = picturesOfError("view 3", reference, image, 59, 0);
  ASSERT_TRUE(pictures) << pictures.error().message;
  ASSERT_EQ(pictures->size(), 2u);
  const Image map = *decodePng((*pictures)[0].png, "map"), crop = *decodePng((*pictures)[1].png, "crop");
  EXPECT_EQ(map.width, 60u);
  EXPECT_EQ(map.height, 50u);
  EXPECT_GT(map.pixel(20, 49)[1], 0.9f);  // the frame: below 49 rows, and left of 49 columns
  EXPECT_GT(map.pixel(10, 20)[1], 0.9f);
  EXPECT_LT(map.pixel(5, 20)[1], 0.1f);
  EXPECT_EQ(crop.height, 49u * 4);
  EXPECT_NE((*pictures)[1].caption.find("(59, 0)"), std::string::npos);
  EXPECT_NE((*pictures)[1].caption.find("times 8"), std::string::npos) << (*pictures)[1].caption;
  // The last crop: the difference times 8 at its upper right corner, 0 elsewhere.
  EXPECT_NEAR(crop.pixel(crop.width - 1, 0)[1], 0.8, 0.01);
  EXPECT_EQ(crop.pixel(crop.width - 1, 100)[1], 0);
}

TEST(ErrorPictures, OfImagesThatDoNotFitAreRefused) {
  const Image image{4, 4, 3, std::vector<float>(48, 0.5f)}, other{4, 3, 3, std::vector<float>(36, 0.5f)};
  EXPECT_TRUE(picturesOfError("", image, image, 3, 3));
  EXPECT_FALSE(picturesOfError("", image, image, 4, 0));
  EXPECT_FALSE(picturesOfError("", image, other, 0, 0));
}

}  // namespace
}  // namespace froth
