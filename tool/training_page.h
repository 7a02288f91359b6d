// froth train --page: how the run goes, for a browser.
#pragma once

#include <filesystem>
#include <string>

#include "measure/report/training_html.h"
#include "trainer/loop/train_scene.h"

namespace froth {

class TrainingPage {
 public:
  TrainingPage(std::filesystem::path path, std::string title) : path_(std::move(path)) {
    report_.title = std::move(title);
  }

  // Replaces the page by one that has this moment too, and the test photos that are shown worst and best.
  Status write(const TrainingMoment& moment, const TrainingSet& set);

 private:
  std::filesystem::path path_;
  TrainingReport report_;
};

}  // namespace froth
