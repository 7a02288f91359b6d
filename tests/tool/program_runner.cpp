#include "tests/tool/program_runner.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include <sys/wait.h>
#include <unistd.h>

#include "tests/surroundings.h"

namespace froth::test {
namespace {

std::string quoted(const std::string& argument) {
  std::string text = "'";
  for (const char letter : argument) {
    if (letter == '\'') text.append("'\\'");
    text.push_back(letter);
  }
  text.push_back('\'');
  return text;
}

}  // namespace

std::string readBytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void writeBytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

ProgramRun runProgram(const std::string& program, const std::vector<std::string>& arguments,
                      const std::filesystem::path& folder) {
  // Beside the folder, so that tests can look at what the program itself left in it.
  const std::string out = folder.string() + ".stdout", err = folder.string() + ".stderr";
  std::string command = "cd ";
  command.append(quoted(folder.string())).append(" && ").append(quoted(programPath(program).string()));
  for (const std::string& argument : arguments) command.append(" ").append(quoted(argument));
  command.append(" >").append(quoted(out)).append(" 2>").append(quoted(err));
  const int status = std::system(command.c_str());
  ProgramRun run{WIFEXITED(status) ? WEXITSTATUS(status) : -1, readBytes(out), readBytes(err)};
  std::filesystem::remove(out);
  std::filesystem::remove(err);
  return run;
}

View viewOfRandomFoam(uint32_t width, uint32_t height) {
  View view;
  view.name = "front";
  view.width = width;
  view.height = height;
  view.fx = view.fy = 1.5 * height;
  view.cx = 0.5 * width;
  view.cy = 0.5 * height;
  view.worldFromCamera = {1, 0, 0, 0.1, 0, 1, 0, -0.2, 0, 0, 1, -2.5};
  return view;
}

ToolTest::ToolTest() {
  std::string pattern = (std::filesystem::temp_directory_path() / "froth_tool_XXXXXX").string();
  folder_ = mkdtemp(pattern.data());
}

ToolTest::~ToolTest() { std::filesystem::remove_all(folder_); }

ProgramRun ToolTest::froth(const std::vector<std::string>& arguments) const {
  return runProgram(FROTH_TOOL, arguments, folder_);
}

std::string ToolTest::frothWell(const std::vector<std::string>& arguments) const {
  const ProgramRun run = froth(arguments);
  EXPECT_EQ(run.exitCode, 0) << "froth " << arguments.front() << ": " << run.err;
  return run.out;
}

nlohmann::json ToolTest::frothJson(std::vector<std::string> arguments) const {
  arguments.push_back("--json");
  const std::string out = frothWell(arguments);
  EXPECT_TRUE(nlohmann::json::accept(out)) << out;
  return nlohmann::json::parse(out, nullptr, false);
}

void ToolTest::makeRandomFoam(const std::string& cells, size_t views) const {
  CameraSet cameras;
  for (size_t i = 0; i < views; ++i) {
    cameras.views.push_back(viewOfRandomFoam(96, 64));
    cameras.views.back().worldFromCamera[3] += 0.1 * static_cast<double>(i);
  }
  ASSERT_TRUE(writeCameras(folder_ / "cameras.json", cameras));
  frothWell({"synth", "random", "--cells", cells, "-o", "random.pt"});
  frothWell({"bake", "random.pt", "--preset", "exact", "-o", "random.froth"});
}

std::vector<std::string> ToolTest::filesInFolder() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
    names.push_back(std::filesystem::relative(entry.path(), folder_).string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool ToolTest::hasDevice() const {
  const ProgramRun run = froth({"devices", "--json"});
  const nlohmann::json devices = nlohmann::json::parse(run.out, nullptr, false);
  return devices.is_array() &&
         std::any_of(devices.begin(), devices.end(), [](const auto& device) { return device["suitable"] == true; });
}

}  // namespace froth::test
