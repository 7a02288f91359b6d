// The foam among the nodes of Qt's scene graph. Lives on Qt's render thread, as all calls of Froth do.
#pragma once

#include "samples/qt_quick/qt_device.h"

#include <QQuickWindow>
#include <QSGSimpleTextureNode>

#include <deque>
#include <memory>
#include <string>

#include "samples/qt_quick/foam_images.h"
#include "samples/qt_quick/foam_scene.h"

namespace froth {

class FoamNode : public QObject, public QSGSimpleTextureNode {
  Q_OBJECT

 public:
  FoamNode(QQuickWindow& window, const QtDevice& device, std::string asset);
  ~FoamNode() override;

  // While Qt synchronizes: before each frame in which the item has changed.
  void synchronize(const QRectF& place, double turn);

 signals:
  void drawn(bool isWhole);  // a frame has been recorded
  void failed(const froth::Error& error);

 private:
  // An extent's images and Qt's handle of them. Frames in flight may use them until `lastSerial` is complete.
  struct Target {
    std::unique_ptr<FoamImages> images;
    std::unique_ptr<QSGTexture> texture;  // goes before the images that it shows
    uint64_t lastSerial = 0;
  };

  Status open();
  Status resize(VkExtent2D extent);
  void render();  // before Qt's render pass
  Result<bool> record(VkCommandBuffer commands);
  void fail(const Error& error);
  uint64_t framesInFlight() const;  // of Qt

  QQuickWindow& window_;
  const FrothContextInfo device_;
  const std::string asset_;
  std::unique_ptr<FoamScene> scene_;
  Target target_;
  std::deque<Target> retired_;
  uint64_t serial_ = 0;  // of the newest frame
  double turn_ = 0;
  uint64_t lastWanted_ = 0;  // frames up to this serial are asked for even if nothing changes
  bool hasFailed_ = false;
};

}  // namespace froth
