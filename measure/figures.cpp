#include "measure/figures.h"

#include <cstdint>
#include <span>

#include <fmt/format.h>

#include "base/atomic_file.h"

namespace froth {

Status FiguresOutput::write(const nlohmann::ordered_json& figures) const {
  if (target.empty()) return {};
  // File names need not be UTF-8; JSON must be.
  const std::string text = figures.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  if (target == "-") {
    fmt::print("{}", text);
    return {};
  }
  return writeFileAtomically(target, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

nlohmann::ordered_json percentilesAsJson(const Percentiles& figures) {
  return {{"median", figures.median},
          {"p5", figures.p5},
          {"p95", figures.p95},
          {"p999", figures.p999},
          {"worst", figures.worst}};
}

}  // namespace froth
