#include "samples/qt_quick/foam_scene.h"

#include <algorithm>

namespace froth {

Result<std::unique_ptr<FoamScene>> FoamScene::create(FrothContextInfo info, const std::string& asset) {
  std::unique_ptr<FoamScene> scene(new FoamScene());
  info.messageUser = scene.get();
  info.onMessage = [](void* user, FrothSeverity severity, FrothResult, const char* object, const char* text) {
    if (severity == FROTH_SEVERITY_ERROR) {
      static_cast<FoamScene*>(user)->lastMessage_ = std::string(object) + ": " + text;
    }
  };
  Status made = scene->check(frothCreateContext(&info, &scene->context_), "frothCreateContext");
  if (!made) return made.error();
  if (made = scene->open(asset); !made) return made.error();
  return scene;
}

FoamScene::~FoamScene() { frothDestroyContext(context_, UINT64_MAX); }

Status FoamScene::check(FrothResult result, const char* call) const {
  if (result >= FROTH_OK) return {};  // what is positive is information
  const bool isFileFault = result == FROTH_ERROR_FILE || result == FROTH_ERROR_VERSION;
  const ErrorKind kind = isFileFault ? ErrorKind::kBadInput : ErrorKind::kUnsupported;
  if (!lastMessage_.empty()) return makeError(kind, "%s", lastMessage_.c_str());
  return makeError(kind, "%s gives %s", call, frothResultName(result));
}

Status FoamScene::open(const std::string& asset) {
  FrothAssetInfo assetInfo{};
  assetInfo.structSize = sizeof(assetInfo);
  assetInfo.path = asset.c_str();
  Status made = check(frothOpenAsset(context_, &assetInfo, &assetHandle_), "frothOpenAsset");
  if (!made) return made;
  FrothInstanceInfo instanceInfo{};
  instanceInfo.structSize = sizeof(instanceInfo);
  instanceInfo.asset = assetHandle_;
  return check(frothCreateInstance(context_, &instanceInfo, &instance_), "frothCreateInstance");
}

Status FoamScene::makeRoomFor(VkExtent2D extent) {
  if (extent.width <= viewExtent_.width && extent.height <= viewExtent_.height) return {};
  const FrothView old = view_;
  FrothViewInfo info{};
  info.structSize = sizeof(info);
  info.maxExtent = {std::max(extent.width, viewExtent_.width), std::max(extent.height, viewExtent_.height)};
  info.startLike = old;
  if (Status made = check(frothCreateView(context_, &info, &view_), "frothCreateView"); !made) return made;
  const bool hadView = viewExtent_.width > 0;
  viewExtent_ = info.maxExtent;
  return hadView ? check(frothDestroyView(context_, old), "frothDestroyView") : Status();
}

Status FoamScene::beginFrame(VkCommandBuffer commands, uint64_t serial, uint64_t completedSerial) {
  FrothFrame frame{};
  frame.structSize = sizeof(frame);
  frame.serial = serial;
  frame.completedSerial = completedSerial;
  if (Status begun = check(frothUpdate(context_, &frame, nullptr), "frothUpdate"); !begun) return begun;
  if (Status copied = check(frothRecordUpload(context_, commands), "frothRecordUpload"); !copied) return copied;
  asset_.structSize = sizeof(asset_);
  if (Status asked = check(frothGetAssetStatus(context_, assetHandle_, &asset_), "frothGetAssetStatus"); !asked) {
    return asked;
  }
  return asset_.state == FROTH_ASSET_FAILED ? check(asset_.error, "frothOpenAsset") : Status();
}

// The start view, or a place outside of the foam, turned around an upright axis through the foam's middle.
Pose FoamScene::poseAt(double turn) const {
  if (asset_.state != FROTH_ASSET_READY) return {};  // nothing is drawn yet
  Pose pose = asset_.hasStartView ? poseOf(asset_.startView) : orbitPath(asset_.boundsMin, asset_.boundsMax).at(0);
  glm::dvec3 middle{};
  for (int axis = 0; axis < 3; ++axis) middle[axis] = 0.5 * (double{asset_.boundsMin[axis]} + asset_.boundsMax[axis]);
  const glm::dquat turned = glm::angleAxis(turn, pose.worldFromCamera * glm::dvec3(0, -1, 0));
  pose.eye = middle + turned * (pose.eye - middle);
  pose.worldFromCamera = turned * pose.worldFromCamera;
  return pose;
}

Result<bool> FoamScene::draw(VkCommandBuffer commands, const FrothImage& colour, double turn) {
  FrothRenderInfo info{};
  info.structSize = sizeof(info);
  info.camera = cameraOf(poseAt(turn), colour.extent);
  info.nearRatio = info.nearDepth = FROTH_NEAR_DEFAULT;
  info.displayCoded = 1;  // Qt Quick blends colours as displays take them, and so does a foam
  info.colour = colour;
  const FrothResult recorded = frothRecordRaster(context_, view_, commands, &info);
  if (Status drawn = check(recorded, "frothRecordRaster"); !drawn) return drawn.error();
  FrothViewStatus status{};  // of the newest complete frame
  status.structSize = sizeof(status);
  if (Status asked = check(frothGetViewStatus(context_, view_, &status), "frothGetViewStatus"); !asked) {
    return asked.error();
  }
  constexpr uint32_t kWillGrow = FROTH_VIEW_CELL_OVERFLOW | FROTH_VIEW_PAIR_OVERFLOW;
  return recorded == FROTH_OK && (status.bits & kWillGrow) == 0;
}

}  // namespace froth
