// froth_qt_quick: a .froth asset between the items of a Qt Quick window, in Qt's own Vulkan frame.
#include <CLI/CLI.hpp>
#include <QGuiApplication>

#include "samples/qt_quick/options.h"
#include "samples/qt_quick/window.h"

namespace {

// Without one QGuiApplication would abort.
bool hasDisplay() {
  return qEnvironmentVariableIsSet("DISPLAY") || qEnvironmentVariableIsSet("WAYLAND_DISPLAY") ||
         qEnvironmentVariableIsSet("QT_QPA_PLATFORM");
}

}  // namespace

int main(int argc, char** argv) {
  froth::QtQuickOptions options;
  CLI::App program{"Shows a .froth asset between the items of a Qt Quick window."};
  program.add_option("ASSET", options.asset, "A .froth file")->required();
  froth::addRunOptions(program, options);
  CLI::Option* headless = program.get_option("--headless");
  headless->description("No person: after --frames write the window as a picture; Xvfb suffices as display");
  froth::addSizeOption(program, "--resize", options.resized, "Headless: size of the window for the last half of frames")
      ->needs(headless);
  return froth::runProgram("froth_qt_quick", program, argc, argv, [&]() -> froth::Status {
    if (!hasDisplay()) {
      return froth::makeError(froth::ErrorKind::kUnsupported,
                              "no display: neither DISPLAY nor WAYLAND_DISPLAY is set; without a screen use xvfb-run");
    }
    const QGuiApplication application(argc, argv);
    return froth::showWindow(options);
  });
}
