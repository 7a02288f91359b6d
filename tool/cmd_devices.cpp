// froth devices: what Vulkan offers here.
#include <memory>

#include <fmt/format.h>

#include "host/host.h"
#include "measure/figures.h"
#include "tool/commands.h"
#include "tool/options.h"

namespace froth {
namespace {

std::string versionText(uint32_t version) {
  return fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version),
                     VK_API_VERSION_PATCH(version));
}

Status runDevices(const FiguresOutput& output) {
  const Result<std::vector<HostDeviceInfo>> devices = listHostDevices();
  if (!devices) return devices.error();
  nlohmann::ordered_json figures = nlohmann::ordered_json::array();
  for (size_t index = 0; index < devices->size(); ++index) {
    const HostDeviceInfo& device = (*devices)[index];
    const std::string version = versionText(device.apiVersion);
    figures.push_back({{"index", index},
                       {"name", device.name},
                       {"driver", device.driver},
                       {"vulkan", version},
                       {"suitable", device.isSuitable},
                       {"missing", device.missing}});
    if (!output.wantsTable()) continue;
    fmt::print("{}  {}, {}, Vulkan {}{}\n", index, device.name, device.driver, version,
               device.isSuitable ? "" : "  not suitable: lacks " + device.missing);
  }
  if (devices->empty() && output.wantsTable()) fmt::print("no Vulkan device; install a driver\n");
  return output.write(figures);
}

}  // namespace

void addDevicesCommand(CLI::App& program, Tool& tool) {
  CLI::App* command = program.add_subcommand("devices", "List the Vulkan devices");
  auto output = std::make_shared<FiguresOutput>();
  addFiguresOption(*command, *output);
  command->callback([&tool, output] { tool.action = [output] { return runDevices(*output); }; });
}

}  // namespace froth
