// Pieces of report.html. Each section is a string of HTML; texts of the report reach it through escapeMarkup
// alone.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "measure/report/report.h"

namespace froth {

// --- Finding one's way in a report.
const ReportPoint* findPoint(const Report& report, const std::string& id);        // null: none
const ReportPoint* defaultOf(const Report& report, const std::string& renderer);  // null: none
std::vector<std::string> renderersOf(const Report& report);  // in the order of the points
bool isDefault(const ReportPoint& point);
bool isTimed(const ReportPoint& point);
bool hasPhotos(const Report& report);
std::string settingsText(const ReportPoint& point);  // "cutoff 0.01, positionBits 14"; "default"
int colourOf(const Report& report, const std::string& renderer);

// --- Figures as text.
std::string milliseconds(double value);
std::string intervalText(const Interval& interval);  // "1.23 ms (1.2 to 1.31)"
std::string bytesText(double bytes);                 // "12.3 MB", of 10^6
// The unit for figures up to `largest` bytes on one axis.
struct ByteUnit {
  const char* name;
  double bytes;
};
ByteUnit unitOfBytes(double largest);
std::string decibels(double value);
std::string percent(double share);
std::string countText(uint64_t count);               // "499 712"
std::string signedText(double value, int decimals);  // "+1.20", "−0.31", "0.00"
std::string tooltipOf(const ReportPoint& point);

// --- Cells of tables; escaped already.
struct Cell {
  std::string html;
  std::string style;  // class names: "number", "text"
};
Cell textCell(const std::string& text);
Cell numberCell(const std::string& text);
Cell bytesCell(uint64_t bytes);           // 0: not measured
Cell timeCell(const Interval& interval);  // median, and p5 to p95 small beside it
// How `interval` stands to `base`: "tie" where noise explains it, otherwise the change in percent.
Cell changeCell(const Interval& interval, const Interval& base);
Cell pointCell(const Report& report,
               const ReportPoint& point);  // its settings, with badges of default and pick

class Table {
 public:
  explicit Table(const std::vector<std::string>& head);
  void add(const std::vector<Cell>& cells, bool isMarked = false);
  std::string html() const;

 private:
  std::vector<std::string> head_;
  std::string rows_;
  std::vector<std::string> styles_;  // of the first row: a column's title stands as its cells do
};

// The error columns that every table of points shares.
std::vector<std::string> errorHead();
std::vector<Cell> errorCells(const ErrorFigures& errors);

std::string section(const std::string& anchor, const std::string& heading, const std::string& body);
std::string paragraph(const std::string& text);  // escaped here
std::string figure(const std::string& content, const std::string& caption);

// --- Sections, in the order of the page. Empty where the report has nothing for them.
std::string summarySection(const Report& report);
std::string frontSections(const Report& report);
std::string sweepsSection(const Report& report);
std::string slopesSection(const Report& report);
std::string passesSection(const Report& report);
std::string viewsSection(const Report& report);
std::string featuresSection(const Report& report);
std::string imagesSection(const Report& report);
std::string pointsSection(const Report& report);
std::string originSection(const Report& report);  // device, versions, notes, credit

}  // namespace froth
