#include "samples/qt_quick/foam_item.h"

#include <QtMath>

#include "samples/qt_quick/foam_node.h"

namespace froth {

FoamItem::FoamItem(QQuickItem* parent) : QQuickItem(parent) { setFlag(ItemHasContents); }

void FoamItem::open(const QtDevice& device, const std::string& asset) {
  device_ = &device;
  asset_ = asset;
}

void FoamItem::setTurn(double turn) {
  if (turn == turn_) return;
  turn_ = turn;
  update();
  emit turnChanged();
}

// On the render thread, while this item's thread waits. Qt deletes the node there, too.
QSGNode* FoamItem::updatePaintNode(QSGNode* old, UpdatePaintNodeData*) {
  const QRectF place = boundingRect();
  if (!device_ || place.width() < 1 || place.height() < 1) {
    delete old;
    return nullptr;
  }
  auto* node = static_cast<FoamNode*>(old);
  if (!node) {
    node = new FoamNode(*window(), *device_, asset_);
    connect(node, &FoamNode::drawn, this, &FoamItem::drawn, Qt::QueuedConnection);
    connect(node, &FoamNode::failed, this, &FoamItem::failed, Qt::QueuedConnection);
  }
  node->synchronize(place, qDegreesToRadians(turn_));
  return node;
}

}  // namespace froth
