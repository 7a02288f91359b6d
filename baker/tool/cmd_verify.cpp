// froth verify: whether an asset is whole and consistent.
#include <memory>

#include <fmt/format.h>

#include "baker/tool/commands.h"
#include "format/asset_reader.h"

namespace froth {

void addVerifyCommand(CLI::App& program, Tool& tool) {
  CLI::App* command =
      program.add_subcommand("verify", "Check structure, hashes, index ranges and graph of an asset");
  auto path = std::make_shared<std::filesystem::path>();
  command->add_option("ASSET", *path, "A .froth file")->required();
  command->callback([&tool, path] {
    tool.action = [path]() -> Status {
      if (Status good = verifyAsset(*path); !good) return good;
      fmt::print("{}: good\n", path->string());
      return {};
    };
  });
}

}  // namespace froth
