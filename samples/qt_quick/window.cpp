#include "samples/qt_quick/window.h"

#include "samples/qt_quick/foam_item.h"

#include <QGuiApplication>
#include <QQmlError>
#include <QQuickGraphicsConfiguration>
#include <QQuickView>

#include <cstdio>
#include <memory>

#include "host/host_instance.h"
#include "host/picture_file.h"

namespace froth {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

QSize sizeOf(VkExtent2D extent) { return {static_cast<int>(extent.width), static_cast<int>(extent.height)}; }

Status createInstance(QVulkanInstance& instance, bool isValidated) {
  QByteArrayList extensions = QQuickGraphicsConfiguration::preferredInstanceExtensions();
  if (isValidated) {
    // QVulkanInstance has no way to choose what the layer checks; the layer reads this.
    qputenv("VK_LAYER_ENABLES", "VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT");
    instance.setLayers({kValidationLayer});
    instance.setFlags(QVulkanInstance::NoDebugOutputRedirect);  // a messenger listens
    extensions.append(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  }
  instance.setApiVersion(QVersionNumber(1, 3));
  instance.setExtensions(extensions);
  if (!instance.create()) {
    return makeError(ErrorKind::kUnsupported, "QVulkanInstance::create gives VkResult %d", instance.errorCode());
  }
  if (isValidated && !instance.layers().contains(kValidationLayer)) {
    return makeError(ErrorKind::kUnsupported,
                     "validation: the layer %s is not installed; install vulkan-validationlayers", kValidationLayer);
  }
  return {};
}

Image pictureOf(const QImage& grabbed) {
  const QImage bytes = grabbed.convertToFormat(QImage::Format_RGB888);
  Image picture{static_cast<uint32_t>(bytes.width()), static_cast<uint32_t>(bytes.height()), 3, {}};
  for (int y = 0; y < bytes.height(); ++y) {
    const uchar* row = bytes.constScanLine(y);
    for (int i = 0; i < 3 * bytes.width(); ++i) picture.values.push_back(static_cast<float>(row[i]) / 255.0f);
  }
  return picture;
}

Status compare(const Image& picture, const QtQuickOptions& options) {
  const Result<Image> expected = readImage(options.compare);
  if (!expected) return expected.error();
  const Result<double> psnr = comparePictures(*expected, picture);
  if (!psnr) return psnr.error();
  std::printf("window against %s: %.2f dB\n", options.compare.c_str(), *psnr);
  if (*psnr >= options.minPsnr) return {};
  return makeError(ErrorKind::kUnsupported, "the window is %.2f dB from %s, below --min-psnr %.2f", *psnr,
                   options.compare.c_str(), options.minPsnr);
}

// The window's life from its first frame to its last.
class Show {
 public:
  Show(QQuickView& view, const QtQuickOptions& options) : view_(view), options_(options) {}

  void count(bool isWhole);
  void fail(const Error& error) { end(error); }
  const Status& result() const { return result_; }

 private:
  void end(const Status& result);
  Status keepPicture() const;

  QQuickView& view_;
  const QtQuickOptions& options_;
  uint32_t frames_ = 0;  // that have shown the whole foam
  bool isOver_ = false;
  Status result_;
};

void Show::count(bool isWhole) {
  if (isOver_ || !isWhole) return;
  ++frames_;
  if (options_.resized.width > 0 && frames_ == options_.frames / 2) view_.resize(sizeOf(options_.resized));
  if (frames_ == options_.frames) return end(options_.output.empty() ? Status() : keepPicture());
  if (options_.frames > 0) view_.update();  // else Qt draws when something changes
}

void Show::end(const Status& result) {
  isOver_ = true;
  result_ = result;
  QGuiApplication::quit();
}

Status Show::keepPicture() const {
  const Image picture = pictureOf(view_.grabWindow());
  const std::filesystem::path path = options_.output / "window.png";
  if (Status written = writePicture(path, picture); !written) return written;
  std::printf("%u frames; the window as %s\n", frames_, path.c_str());
  return options_.compare.empty() ? Status() : compare(picture, options_);
}

Status showOn(QVulkanInstance& instance, const QtQuickOptions& options) {
  QQuickWindow::setGraphicsApi(QSGRendererInterface::Vulkan);
  std::unique_ptr<QtDevice> device;  // outlives the window
  QQuickView view;
  view.setVulkanInstance(&instance);
  view.create();
  Result<std::unique_ptr<QtDevice>> made = QtDevice::create(instance, view, options.device);
  if (!made) return made.error();
  device = std::move(*made);
  view.setGraphicsDevice(device->forQt());

  qmlRegisterType<FoamItem>("Froth", 1, 0, "Foam");
  view.setResizeMode(QQuickView::SizeRootObjectToView);
  view.resize(sizeOf(options.extent));
  view.setSource(QUrl("qrc:/scene.qml"));
  if (view.status() != QQuickView::Ready) {
    return makeError(ErrorKind::kUnsupported, "%s", qPrintable(view.errors().value(0).toString()));
  }
  auto* foam = view.rootObject()->findChild<FoamItem*>();
  foam->open(*device, options.asset);
  Show show(view, options);
  QObject::connect(foam, &FoamItem::drawn, &view, [&show](bool isWhole) { show.count(isWhole); });
  QObject::connect(foam, &FoamItem::failed, &view, [&show](const Error& error) { show.fail(error); });
  view.show();
  QGuiApplication::exec();
  return show.result();
}

}  // namespace

Status showWindow(const QtQuickOptions& options) {
  QVulkanInstance instance;
  if (Status made = createInstance(instance, options.validate); !made) return made;
  ValidationLog log;
  const VkDebugUtilsMessengerEXT messenger =
      options.validate ? createMessenger(instance.vkInstance(), log) : VK_NULL_HANDLE;
  Status shown = showOn(instance, options);
  if (messenger) destroyMessenger(instance.vkInstance(), messenger);
  if (!shown || log.messages.empty()) return shown;
  return makeError(ErrorKind::kUnsupported, "validation: %s", log.messages.front().c_str());
}

}  // namespace froth
