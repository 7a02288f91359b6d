// What one call of `froth bake` bakes.
#pragma once

#include <filesystem>
#include <vector>

#include "base/result.h"

namespace froth {

struct BakeJob {
  std::filesystem::path input, output;
  std::filesystem::path cameras;  // empty: none
};

// A checkpoint goes to the file `output`. A folder's checkpoints go into the folder `output`, which is made: NAME.pt to
// NAME.froth with NAME.cameras.json, NAME/model.pt to NAME.froth with NAME/cameras.json, where these are; in the order
// of their names. `cameras` is for a single checkpoint.
Result<std::vector<BakeJob>> findBakeJobs(const BakeJob& given);

}  // namespace froth
