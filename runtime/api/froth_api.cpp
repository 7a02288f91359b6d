// The C entry points: null pointers, struct sizes, exceptions; everything else is the context's.
#include "froth/froth_reader.h"

#include <cstddef>
#include <memory>

#include "runtime/api/call_guard.h"
#include "runtime/device/requirements.h"

using namespace froth;

namespace {

// The callback of a struct that may be older than it, and has not been checked.
Messages messagesOf(const FrothContextInfo* info) {
  const bool hasCallback = info && info->structSize >= offsetof(FrothContextInfo, messageUser) + sizeof(void*);
  return hasCallback ? Messages{info->onMessage, info->messageUser} : Messages{};
}

// The calls that make an object: *handle is null unless they succeed.
template <class Info, class Handle>
FrothResult make(FrothContext* context, const char* name, const Info* info, const char* handleName, Handle* handle,
                 FrothResult (Context::*makeObject)(const Info&, Handle&)) {
  return guard(context, name, [&](const char* call) {
    if (!handle) {
      return failNull(*context, call, handleName);
    }
    *handle = {};
    Info known;
    const FrothResult result = readInput(context->messages, call, info, known);
    return result == FROTH_OK ? (context->*makeObject)(known, *handle) : result;
  });
}

FrothResult render(FrothContext* context, RenderMethod method, const char* call, FrothView view,
                   VkCommandBuffer commandBuffer, const FrothRenderInfo* info) {
  return guard(context, call, [&](const char*) {
    FrothRenderInfo known;
    const FrothResult result = readInput(context->messages, call, info, known);
    return result == FROTH_OK ? context->render(method, view, commandBuffer, known) : result;
  });
}

}  // namespace

const char* frothResultName(FrothResult result) {
  switch (result) {
#define FROTH_NAME(name) \
  case name:             \
    return #name;
    FROTH_NAME(FROTH_OK)
    FROTH_NAME(FROTH_PENDING)
    FROTH_NAME(FROTH_INCOMPLETE)
    FROTH_NAME(FROTH_ERROR_ARGUMENT)
    FROTH_NAME(FROTH_ERROR_HANDLE)
    FROTH_NAME(FROTH_ERROR_VERSION)
    FROTH_NAME(FROTH_ERROR_FEATURE)
    FROTH_NAME(FROTH_ERROR_FILE)
    FROTH_NAME(FROTH_ERROR_MEMORY)
    FROTH_NAME(FROTH_ERROR_UNSUPPORTED)
    FROTH_NAME(FROTH_ERROR_DEVICE)
    FROTH_NAME(FROTH_ERROR_STATE)
#undef FROTH_NAME
    case FROTH_RESULT_MAX:
      break;
  }
  return "unknown FrothResult";
}

FrothResult frothGetRequirements(PFN_vkGetInstanceProcAddr getInstanceProcAddr, VkInstance instance,
                                 VkPhysicalDevice physicalDevice, FrothRequirements* requirements) {
  const bool canAsk = !physicalDevice || (getInstanceProcAddr && instance);
  if (!requirements || !canAsk) {
    return FROTH_ERROR_ARGUMENT;
  }
  const FrothRequirements found = queryRequirements(getInstanceProcAddr, instance, physicalDevice);
  return writeStruct(found, *requirements) ? FROTH_OK : FROTH_ERROR_ARGUMENT;
}

FrothResult frothRequireFeatures(VkPhysicalDeviceFeatures2* features, const char** missingStructure) {
  if (!features) {
    return FROTH_ERROR_ARGUMENT;
  }
  const char* missing = requireFeatures(*features);
  if (missingStructure) {
    *missingStructure = missing;
  }
  return missing ? FROTH_ERROR_FEATURE : FROTH_OK;
}

FrothResult frothCreateContext(const FrothContextInfo* info, FrothContext** context) {
  if (!context) {
    return FROTH_ERROR_ARGUMENT;
  }
  *context = nullptr;
  const Messages messages = messagesOf(info);
  return guard(messages, __func__, [&](const char* call) {
    FrothContextInfo known;
    FrothResult result = readInput(messages, call, info, known);
    if (result != FROTH_OK) {
      return result;
    }
    auto created = std::make_unique<FrothContext>();
    result = created->create(known, call);
    if (result == FROTH_OK) {
      *context = created.release();
    }
    return result;
  });
}

FrothResult frothDestroyContext(FrothContext* context, uint64_t completedSerial) {
  if (context && (!context->isDone(completedSerial) || !context->endReads())) {
    return FROTH_PENDING;
  }
  delete context;
  return FROTH_OK;
}

FrothResult frothSetBudget(FrothContext* context, uint64_t bytes) {
  return guard(context, __func__, [&](const char*) {
    context->setBudget(bytes);
    return FROTH_OK;
  });
}

FrothResult frothGetMemoryReport(FrothContext* context, FrothMemoryReport* report) {
  return guard(context, __func__, [&](const char* call) {
    FrothMemoryReport known{};
    context->describeMemory(known);
    return writeOutput(context->messages, call, known, report);
  });
}

FrothResult frothDeviceLost(FrothContext* context) {
  return guard(context, __func__, [&](const char*) {
    context->loseDevice();
    return FROTH_OK;
  });
}

FrothResult frothRestoreDevice(FrothContext* context, const FrothContextInfo* info) {
  return guard(context, __func__, [&](const char* call) {
    FrothContextInfo known;
    const FrothResult result = readInput(context->messages, call, info, known);
    return result == FROTH_OK ? context->restoreDevice(known, call) : result;
  });
}

FrothResult frothOpenAsset(FrothContext* context, const FrothAssetInfo* info, FrothAsset* asset) {
  return guard(context, __func__, [&](const char* call) {
    if (!asset) {
      return failNull(*context, call, "asset");
    }
    *asset = {};
    FrothAssetInfo known;
    FrothReader reader;
    const FrothResult result = readAssetInfo(context->messages, call, info, known, reader);
    return result == FROTH_OK ? context->openAsset(known, *asset) : result;
  });
}

FrothResult frothGetAssetStatus(FrothContext* context, FrothAsset asset, FrothAssetStatus* status) {
  return guard(context, __func__, [&](const char* call) {
    FrothAssetStatus known{};
    const FrothResult result = context->describeAsset(asset, known);
    return result == FROTH_OK ? writeOutput(context->messages, call, known, status) : result;
  });
}

FrothResult frothGetFlightPath(FrothContext* context, FrothAsset asset, uint32_t capacity, FrothStoredCamera* cameras,
                               uint32_t* count) {
  return guard(context, __func__, [&](const char* call) {
    return count ? context->copyFlightPath(asset, capacity, cameras, *count) : failNull(*context, call, "count");
  });
}

FrothResult frothCloseAsset(FrothContext* context, FrothAsset asset) {
  return guard(context, __func__, [&](const char*) { return context->closeAsset(asset); });
}

FrothResult frothCreateInstance(FrothContext* context, const FrothInstanceInfo* info, FrothInstance* instance) {
  return make(context, __func__, info, "instance", instance, &Context::createInstance);
}

FrothResult frothSetInstance(FrothContext* context, FrothInstance instance, const FrothInstanceInfo* info) {
  return guard(context, __func__, [&](const char* call) {
    FrothInstanceInfo known;
    const FrothResult result = readInput(context->messages, call, info, known);
    return result == FROTH_OK ? context->setInstance(instance, known) : result;
  });
}

FrothResult frothDestroyInstance(FrothContext* context, FrothInstance instance) {
  return guard(context, __func__, [&](const char*) { return context->destroyInstance(instance); });
}

FrothResult frothCreateView(FrothContext* context, const FrothViewInfo* info, FrothView* view) {
  return make(context, __func__, info, "view", view, &Context::createView);
}

FrothResult frothDestroyView(FrothContext* context, FrothView view) {
  return guard(context, __func__, [&](const char*) { return context->destroyView(view); });
}

FrothResult frothGetViewStatus(FrothContext* context, FrothView view, FrothViewStatus* status) {
  return guard(context, __func__, [&](const char* call) {
    FrothViewStatus known{};
    const FrothResult result = context->describeView(view, known);
    return result == FROTH_OK ? writeOutput(context->messages, call, known, status) : result;
  });
}

FrothResult frothUpdate(FrothContext* context, const FrothFrame* frame, FrothFrameStatus* status) {
  return guard(context, __func__, [&](const char* call) {
    if (!frame) {
      return failNull(*context, call, "frame");
    }
    FrothFrame known;
    FrothFrameStatus found{};
    FrothResult result = readInput(context->messages, call, frame, known);
    if (result == FROTH_OK && status) {  // before the frame begins, so that a wrong call changes nothing
      result = writeOutput(context->messages, call, found, status);
    }
    if (result == FROTH_OK) {
      result = context->update(known, found);
    }
    return result == FROTH_OK && status ? writeOutput(context->messages, call, found, status) : result;
  });
}

FrothResult frothRecordUpload(FrothContext* context, VkCommandBuffer commandBuffer) {
  return guard(context, __func__, [&](const char*) { return context->recordUpload(commandBuffer); });
}

FrothResult frothDropFrame(FrothContext* context, uint64_t serial) {
  return guard(context, __func__, [&](const char*) { return context->dropFrame(serial); });
}

FrothResult frothDropUpload(FrothContext* context, uint64_t uploadSerial) {
  return guard(context, __func__, [&](const char*) { return context->dropUpload(uploadSerial); });
}

FrothResult frothRecordRaster(FrothContext* context, FrothView view, VkCommandBuffer commandBuffer,
                              const FrothRenderInfo* info) {
  return render(context, RenderMethod::kRaster, "frothRecordRaster", view, commandBuffer, info);
}

FrothResult frothRecordWalk(FrothContext* context, FrothView view, VkCommandBuffer commandBuffer,
                            const FrothRenderInfo* info) {
  return render(context, RenderMethod::kWalk, "frothRecordWalk", view, commandBuffer, info);
}
