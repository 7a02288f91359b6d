// What `froth bench` measures, as a table and as JSON.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "froth/froth.h"
#include "reference/capture/view_selection.h"

namespace froth {

// A pass that a frame lacks counts nothing there. A cycle is a frame of every view: cycles measure the same
// work again and again, so they scatter by noise alone.
struct Measurement {
  std::vector<std::string> passOrder;
  std::map<std::string, std::vector<double>> passTimes;    // [ms] by frame
  std::map<std::string, std::vector<double>> cyclePasses;  // [ms] mean frame, by cycle
  std::vector<double> totals, cycleTotals;                 // [ms] the same of all passes
  std::vector<std::vector<double>> viewTotals;             // [ms] by view and frame
  std::vector<FrothViewStatus> viewStatus;                 // newest, by view
};

// Frames come in cycles over the views.
void addFrame(Measurement& measurement, size_t view, const FrothViewStatus& status);

void printMeasurement(const Measurement& measurement);
nlohmann::ordered_json measurementAsJson(const Measurement& measurement, const std::vector<SelectedView>& views);

// FrothWork of a cycle: averages over rays and over workgroups of 8 x 8 pixels.
void printWork(const Measurement& measurement, const std::vector<SelectedView>& views);
nlohmann::ordered_json workAsJson(const Measurement& measurement, const std::vector<SelectedView>& views);

void printMemory(const FrothAssetStatus& asset, const FrothViewStatus& view);
nlohmann::ordered_json memoryAsJson(const FrothAssetStatus& asset, const FrothViewStatus& view);

}  // namespace froth
