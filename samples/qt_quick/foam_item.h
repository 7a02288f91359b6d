// Foam { turn: 30 } in QML: a .froth asset as an item among items.
#pragma once

#include "samples/qt_quick/qt_device.h"

#include <QQuickItem>

#include <string>

namespace froth {

class FoamItem : public QQuickItem {
  Q_OBJECT
  Q_PROPERTY(double turn READ turn WRITE setTurn NOTIFY turnChanged)  // of the camera around the foam [degrees]

 public:
  explicit FoamItem(QQuickItem* parent = nullptr);

  // Before its window is shown. `device` is the one that the window draws with, and outlives it.
  void open(const QtDevice& device, const std::string& asset);

  double turn() const { return turn_; }
  void setTurn(double turn);

 signals:
  void turnChanged();
  void drawn(bool isWhole);  // a frame; whole: nothing is still being loaded
  void failed(const froth::Error& error);

 protected:
  QSGNode* updatePaintNode(QSGNode* node, UpdatePaintNodeData* data) override;

 private:
  const QtDevice* device_ = nullptr;
  std::string asset_;
  double turn_ = 0;
};

}  // namespace froth
