// The page around the sections.
#include <fmt/format.h>

#include "measure/report/html_parts.h"
#include "measure/report/svg_plot.h"

namespace froth {
namespace {

constexpr const char* kStyle = R"css(
:root{--ink:#1f2328;--soft:#667080;--line:#dfe3e8;--paper:#ffffff;--field:#f5f7f9;--mark:#eef5ff;--good:#0f7b55;--fair:#8a5a00;
--bad:#c0262d;--pick:#7a35b8;--bar:#9cc3f5;color-scheme:light dark}
@media(prefers-color-scheme:dark){:root{--ink:#e6e8eb;--soft:#9aa4b1;--line:#2c323a;--paper:#14171b;--field:#1b2027;
--mark:#182a42;--good:#4fd1a0;--fair:#e5c454;--bad:#ff7b7b;--pick:#cf9bff;--bar:#2f5688}}
body{margin:0;background:var(--paper);color:var(--ink);font:14px/1.45 system-ui,sans-serif}
main{max-width:1120px;margin:0 auto;padding:20px 20px 60px}
h1{font-size:24px;margin:0 0 2px}h2{font-size:19px;margin:38px 0 8px;border-bottom:1px solid var(--line);padding-bottom:4px}
h3{font-size:15px;margin:24px 0 2px}p{margin:4px 0 10px;max-width:90ch}
nav{margin:10px 0 4px}nav a{margin-right:14px}a{color:inherit}
.soft,.lead,small,figcaption,.credit{color:var(--soft)}small{font-size:11px;white-space:nowrap}
.tiles{display:grid;grid-template-columns:repeat(auto-fit,minmax(135px,1fr));gap:8px;margin:10px 0}
.tile{background:var(--field);border-radius:6px;padding:8px 10px;display:flex;flex-direction:column}
.tile span{color:var(--soft);font-size:12px}.tile b{font-size:19px;font-variant-numeric:tabular-nums;white-space:nowrap}
.scroll{overflow-x:auto;margin:6px 0 12px}
table{border-collapse:collapse;font-size:12.5px;font-variant-numeric:tabular-nums}
th{text-align:right;font-weight:600;color:var(--soft);border-bottom:1px solid var(--line);padding:3px 9px;vertical-align:bottom}
td{padding:2.5px 9px;border-bottom:1px solid var(--line)}td.number{text-align:right;white-space:nowrap}td:first-child{white-space:nowrap}
th.text,th.bars{text-align:left}td.text{text-align:left}td.small{font-size:11px;color:var(--soft)}tr.marked td{background:var(--mark)}
td.bars{min-width:220px}.share{display:inline-block;height:9px;background:var(--bar);margin-right:6px;max-width:75%}
.badge{display:inline-block;border:1px solid currentColor;border-radius:9px;padding:0 7px;font-size:11px;color:var(--soft);white-space:nowrap}
.good,.better{color:var(--good)}.fair{color:var(--fair)}.bad,.worse{color:var(--bad)}.pick{color:var(--pick)}
.plots{display:flex;flex-wrap:wrap;gap:10px 14px;margin:6px 0}
figure{margin:10px 0;overflow-x:auto}figure svg.plot{min-width:720px}figcaption{font-size:12px;margin:2px 0 4px}
.images{display:grid;grid-template-columns:repeat(auto-fit,minmax(320px,1fr));gap:14px}
.images img{max-width:100%;image-rendering:pixelated;display:block}
details summary{cursor:pointer}
)css";

std::string lead(const Report& report) {
  return fmt::format(
      "{} cells, {} x {} pixels, {} views, {} configurations, {} frames each on {}. Errors are against the "
      "double-precision image of the unquantized foam.",
      countText(report.cells), report.width, report.height, report.views.size(), report.points.size(),
      report.frames, report.device);
}

// The link texts of the sections that are there.
std::string navigation(const std::string& body) {
  constexpr std::pair<const char*, const char*> kAnchors[] = {
      {"summary", "Summary"},   {"time", "Error over time"},   {"bytes", "Error over bytes"},
      {"sweeps", "Knobs"},      {"slopes", "Slopes"},          {"passes", "Passes"},
      {"views", "Views"},       {"features", "Features"},      {"pictures", "Pictures"},
      {"points", "All points"}, {"origin", "Device and notes"}};
  std::string links;
  for (const auto& [anchor, text] : kAnchors) {
    if (body.find(fmt::format("<section id=\"{}\">", anchor)) == std::string::npos) continue;
    links += fmt::format("<a href=\"#{}\">{}</a>\n", anchor, text);
  }
  return "<nav>\n" + links + "</nav>\n";
}

}  // namespace

std::string reportAsHtml(const Report& report) {
  const std::string body = summarySection(report) + frontSections(report) + sweepsSection(report) +
                           slopesSection(report) + passesSection(report) + viewsSection(report) +
                           featuresSection(report) + imagesSection(report) + pointsSection(report) +
                           originSection(report);
  const std::string title = escapeMarkup("Error and run time: " + report.scene);
  return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
         // A browser asks the server for an icon otherwise.
         "<link rel=\"icon\" href=\"data:,\">\n<title>" +
         title + "</title>\n<style>" + kStyle + plotStyle() + "</style>\n</head>\n<body>\n<main>\n<h1>" +
         title + "</h1>\n<p class=\"lead\">" + escapeMarkup(lead(report)) + "</p>\n" + navigation(body) +
         body + "</main>\n</body>\n</html>\n";
}

}  // namespace froth
