// One per VkDevice: owns assets, instances, views and the memory that they hold on the GPU.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <memory_resource>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "froth/froth_composite.h"
#include "froth/froth_precompile.h"
#include "froth/froth_query.h"
#include "froth/froth_replace.h"
#include "froth/froth_stream.h"
#include "froth/froth_walk.h"
#include "runtime/asset/asset.h"
#include "runtime/context/level_streaming.h"
#include "runtime/context/stream_eyes.h"
#include "runtime/device/device.h"
#include "runtime/device/handles.h"
#include "runtime/device/messages.h"
#include "runtime/device/upload_ring.h"
#include "runtime/jobs/job.h"
#include "runtime/query/placement.h"
#include "runtime/reads/read_table.h"
#include "runtime/render/breadcrumbs.h"
#include "runtime/render/pipelines.h"
#include "runtime/render/view_renderer.h"
#include "runtime/walk/walk_sets.h"

namespace froth {

// The calls of froth.h with their structs already read to today's size. Threads as in froth.h.
class Context {
 public:
  Context() = default;
  ~Context() { stopJobs(); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  FrothResult create(const FrothContextInfo& info, const char* call);
  bool isDone(uint64_t completedSerial) const;  // no frame beyond it is in flight

  void setBudget(uint64_t bytes);
  void describeMemory(FrothMemoryReport& report) const;

  void loseDevice();
  FrothResult restoreDevice(const FrothContextInfo& info, const char* call);

  // Any thread, as long as the device's objects stay (runtime/context/context_pipelines.cpp).
  FrothResult readVariant(const FrothAssetInfo& info, FrothVariant& variant) const;
  FrothResult precompile(const FrothPrecompileInfo& info);

  FrothResult openAsset(const FrothAssetInfo& info, FrothAsset& handle);
  FrothResult describeAsset(FrothAsset handle, FrothAssetStatus& status) const;
  FrothResult copyFlightPath(FrothAsset handle, uint32_t capacity, FrothStoredCamera* cameras, uint32_t& count) const;
  FrothResult closeAsset(FrothAsset handle);
  FrothResult replaceAsset(FrothAsset handle, const FrothAssetInfo& info);
  FrothResult describeReplacement(FrothAsset handle, FrothReplacementStatus& status);

  // Any thread.
  FrothResult completeRead(uint64_t request, FrothResult result);
  // Cancels reads. True: none is unanswered, so that no answer will come to a context that is gone.
  bool endReads() { return reads_.cancelAll(); }

  FrothResult createInstance(const FrothInstanceInfo& info, FrothInstance& handle);
  FrothResult setInstance(FrothInstance handle, const FrothInstanceInfo& info);
  FrothResult destroyInstance(FrothInstance handle);

  FrothResult createView(const FrothViewInfo& info, FrothView& handle);
  FrothResult describeView(FrothView handle, FrothViewStatus& status) const;
  FrothResult listBreadcrumbs(uint32_t capacity, FrothBreadcrumb* breadcrumbs, uint32_t& count) const;
  FrothResult destroyView(FrothView handle);

  FrothResult update(const FrothFrame& frame, FrothFrameStatus& status);
  FrothResult recordUpload(VkCommandBuffer commandBuffer);
  FrothResult dropFrame(uint64_t serial);
  FrothResult dropUpload(uint64_t uploadSerial);
  FrothResult render(RenderMethod method, FrothView handle, VkCommandBuffer commandBuffer, FrothRenderInfo info);

  FrothResult composite(FrothView handle, VkCommandBuffer commandBuffer, const FrothCompositeInfo& info);
  FrothResult exportDepth(FrothView handle, VkCommandBuffer commandBuffer, const FrothDepthExportInfo& info);

  // Queries; const, so that any number of threads may ask (runtime/context/context_queries.cpp).
  FrothResult castRays(FrothCastInfo info, std::span<const FrothRay> rays, FrothRayHit* hits) const;
  FrothResult locate(FrothInstance handle, const double (&point)[3], FrothLocation& location) const;
  FrothResult overlapSphere(FrothSphere sphere, FrothContact& contact) const;

  // Rays on the GPU (runtime/context/context_walks.cpp).
  FrothResult describeWalkLayout(VkDescriptorSetLayout& layout) const;
  FrothResult recordWalkSet(VkCommandBuffer commandBuffer, FrothWalkInfo info, VkDescriptorSet& set);
  FrothResult recordRays(VkCommandBuffer commandBuffer, VkDeviceAddress rays, VkDeviceAddress hits, uint32_t count,
                         FrothRayKind kind);
  FrothResult describeWalks(FrothWalkStatus& status) const;

  FrothResult setStreaming(const FrothStreamInfo& info);
  FrothResult describeStreaming(FrothStreamStatus& status) const;
  FrothResult copyChunks(FrothAsset handle, uint32_t capacity, FrothChunk* chunks, uint32_t& count) const;

  // From now on these chunks of an asset with levels are read and drawn, a cut, ascending, whatever views see. Not in
  // the public headers.
  void setCut(FrothAsset handle, std::vector<uint32_t> chunks);

  const Asset* findAsset(FrothAsset handle) const { return assets_.find(handle); }  // null: stale

  Messages messages;

 private:
  struct Instance {
    FrothAsset asset;
    RenderInstance placement;  // its `asset` and `previous` are filled in when it is drawn
    // Where it stood when the frame movedAfter was drawn; none: there was no such frame, or it jumped.
    std::optional<RenderInstance> before{};
    uint64_t movedAfter = 0;
    uint32_t mask = ~0u;
  };
  // What later calls of its frame have to know of a record call.
  struct DrawnView {
    VkRect2D region{};
    bool isProjection = true, isDepthReversed = false;
  };
  struct Eye {
    uint64_t renderedSerials[2] = {0, 0};               // newest frame per RenderMethod
    DrawnView drawn{};                                  // by the newest of those
    std::optional<SeenFrom> seenFrom{};                 // the same; none: none yet
    uint64_t compositedSerial = 0, exportedSerial = 0;  // newest frames of frothRecordComposite, frothRecordDepthExport
  };
  // Its text changes with what is held, from frame to frame; so it is known by these.
  struct ToldError {
    ErrorKind kind;
    VkDeviceSize budget;
    friend bool operator==(const ToldError&, const ToldError&) = default;
  };
  struct View {
    VkExtent2D maxExtent{};
    uint32_t lensClasses = 0;  // FrothLensClass bits
    uint32_t reservedCells = 0;
    uint32_t fadeFrames = 0;
    bool measurePasses = false, keepsHits = false, keepsReactive = false;
    std::unique_ptr<Breadcrumbs> breadcrumbs;  // null: null context, or none are wanted
    std::unique_ptr<ViewRenderer> renderer;    // null: null context, or the device is lost
    // in the newest frothUpdate: those it has buffers for, if they fit the budget
    std::vector<RenderInstance> prepared;
    std::vector<RenderInstance> visible;        // of the record call under way; has room for all, as has
    std::vector<RenderInstance> visibleBefore;  // the same with the cuts before, in a fade
    std::optional<ToldError> preparationError;  // sent already
    uint32_t eyeCount = 1;
    Eye eyes[kMostEyes];
    std::vector<std::pair<uint64_t, uint32_t>> bits;  // recorded frames that left something out: serial, FrothViewBit
  };

  // What takes the place of an asset when it is loaded: the same with fewer or more layers.
  struct Exchange {
    FrothAsset asset;
    std::shared_ptr<Asset> successor;
    VkDeviceSize budget;  // when it began
  };

  // What frothReplaceAsset brings.
  struct Replacement {
    FrothAsset asset;
    std::shared_ptr<Asset> successor;  // null: it is done, or has failed
    FrothResult error;
  };

  FrothResult checkInfo(const FrothContextInfo& info, const char* call) const;
  FrothResult checkEngineFormats(const FrothContextInfo& info, const char* call) const;
  Status createDeviceObjects(const FrothContextInfo& info);
  void stopJobs();
  FrothResult checkDevice(const char* call) const;  // of calls that a lost device cannot serve
  Status createRenderer(View& view);
  void shrinkViews();
  VkDeviceSize shrinkableBytes() const;
  bool isMemoryReturning() const;
  std::shared_ptr<Asset> makeAsset(const FrothAssetInfo& info);  // info has been checked
  // Hot reload (runtime/context/context_replace.cpp).
  Replacement* findReplacement(FrothAsset handle);  // null: there was none
  void endReplacement(FrothAsset handle);
  void dropAsset(std::shared_ptr<Asset> asset);
  void loadReplacements(LoadLimit& limit, const Asset::Preparation& prepare);
  void finishReplacements();
  // Layers of assets (runtime/context/context_layers.cpp).
  void loadSuccessor(LoadLimit& limit, const Asset::Preparation& prepare);
  void finishExchange();
  void abandonExchange();
  void chooseExchange();
  bool isExchangeWanted() const;
  bool isBudgetShort() const;
  bool hasRoomFor(const Asset& asset, uint32_t layers, VkDeviceSize heldBytes) const;
  VkDeviceSize missingBytes(const Asset* exchanged = nullptr, uint32_t detailCount = 0) const;
  std::optional<FrothAsset> findLayersToGive() const;
  std::optional<FrothAsset> findLayersToTake() const;
  void tellExcess();
  // Cells prepared for rays (runtime/context/context_prepared.cpp).
  void choosePrepared();
  VkDeviceSize roomForPrepared();
  bool isPreparedInTheWay() const;
  bool dropPrepared(VkDeviceSize bytes);
  void dropPrepared(Asset& asset);
  void refusePrepared(Asset& asset, const Error& error);
  // Levels of detail (runtime/context/context_levels.cpp).
  void updateLevels();
  void gatherEyes(FrothAsset handle, const Asset& asset);
  // [bytes]
  struct ViewShare {
    uint64_t fixedBytes = 0, heldBytes = 0;
  };
  ViewShare priceCells(FrothAsset handle, Asset& asset);
  uint64_t otherBytes();
  void limitLevels();
  bool isRoomMadeFor(const Asset& asset) const;
  void publishBorders(VkCommandBuffer commandBuffer);
  // Fades from cut to cut (runtime/context/context_fade.cpp).
  uint32_t mostFadeFrames() const;
  bool isFading() const;
  void stepFade();
  float fadeWeight(View& view, const FrothRenderInfo& info) const;
  uint32_t recordView(RenderMethod method, View& view, VkCommandBuffer commandBuffer, const FrothRenderInfo& info);
  void turnBorders(VkCommandBuffer commandBuffer, bool isBefore);
  uint32_t walkedChunks() const;
  FrothAssetState stateOf(const Asset& asset) const;
  // Instances that queries see; why others were left out, as FrothQueryBit.
  std::pmr::vector<PlacedFoam> gatherFoams(uint32_t& bits, std::pmr::memory_resource* memory) const;
  FrothResult readPlacement(const FrothInstanceInfo& info, const char* call, Instance& instance) const;
  FrothResult checkUploadSerials(const FrothFrame& frame) const;
  FrothResult beginFrame(const FrothFrame& frame);
  void runFrame(FrothFrameStatus& status);
  void withMemoryJobs(const std::function<void()>& work);
  void takeMemory();
  void orderMemory();
  void loadAssets();
  void prepareView(FrothView handle, View& view);
  // The view, if this eye of it was drawn in this frame and the call was not made yet; else null, and a message.
  View* findDrawn(FrothView handle, uint32_t eye, const char* call, uint64_t Eye::*newestCall, FrothResult& result);
  FrothResult checkEye(const View& view, uint32_t eye, const char* call) const;
  FrothResult checkHits(const View& view, const FrothRenderInfo& info, const char* call) const;
  void prepareWalks();
  FrothResult checkWalks(const char* call) const;
  // Into walked_; false: some were left out.
  bool gatherWalked();
  // Pipelines that are made while what there is draws.
  struct PipelineJob {
    Job<Done> job;
    std::string error;  // sent already
  };
  std::optional<Status> prepareShape(const AssetShape& shape);
  void takePipelines(PipelineJob& making, const char* object);
  void prepareMerging();
  void prepareRayForms();
  Status makeMerging();
  // The instances to be drawn, in view.visible; why others are left out, as FrothViewBit.
  void gatherVisible(View& view, const FrothRenderInfo& info, uint32_t& bits) const;
  // Frees `object` once all frames that may use it are complete. retired_ has room for it.
  void retire(std::shared_ptr<void> object);

  // What is declared later goes first, and needs what is declared earlier.
  ReadTable reads_;
  JobRunner jobs_;
  Device device_;
  bool isNull_ = false;             // no device, for good
  bool isLost_ = false;             // between frothDeviceLost and frothRestoreDevice
  bool isExcessTold_ = false;       // of this budget
  bool isViewRefused_ = false;      // memory, in the newest frothUpdate
  bool isPreparedLeaving_ = false;  // prepared cells were dropped, and their memory is not back yet
  // These use the device, which stays until they have ended. The last runs a MemoryBatch beside what
  // FrothContextInfo::mostJobs allows, the others make pipelines.
  std::map<AssetShape, Job<Done>> making_;
  PipelineJob merging_, rayForms_;
  Job<Done> memoryJob_;
  uint32_t framesInFlight_ = 2;
  uint32_t lensClasses_ = 0;  // FrothLensClass bits
  VkFormat compositeFormat_ = VK_FORMAT_UNDEFINED, depthExportFormat_ = VK_FORMAT_UNDEFINED;
  bool hasExtendedFormats_ = false;  // shaderStorageImageExtendedFormats
  bool hasReactiveImages_ = false;
  bool hasWalkShaders_ = false;
  bool hasBreadcrumbs_ = false;
  std::string walkError_;                       // of the newest frothUpdate that could not make space; sent already
  std::unique_ptr<UploadRing> ring_;            // null: null context, or the device is lost
  std::unique_ptr<RenderPipelines> pipelines_;  // the same
  std::unique_ptr<WalkSets> walks_;             // the same; also without FrothContextInfo::walkShaders
  std::vector<WalkedInstance> walked_;          // of the record call under way; has room for all
  HandlePool<Asset, FrothAsset> assets_;
  std::vector<Replacement> replacements_;                           // one for an asset
  std::optional<Exchange> exchange_;                                // one at a time
  std::vector<std::pair<FrothAsset, std::vector<uint32_t>>> cuts_;  // of setCut
  LevelStreaming levels_;                                           // of all other assets with levels
  std::vector<SeenFrom> streamPoints_;
  std::vector<StreamEye> streamEyes_;  // of the asset at hand
  double streamDetail_ = 1;
  uint64_t streamCells_ = std::numeric_limits<uint64_t>::max();
  uint32_t fadeStep_ = 1;       // of this frame in its fade; 1: the first, if one begins
  bool areEyesFrozen_ = false;  // levels_ keeps those that it has
  bool isFloorTold_ = false;    // that the budget is too low for floors
  HandlePool<Instance, FrothInstance> instances_;
  HandlePool<View, FrothView> views_;
  std::vector<std::pair<uint64_t, std::shared_ptr<void>>> retired_;  // serial of the last use

  uint64_t serial_ = 0, completedSerial_ = 0;
  std::vector<uint64_t> serialsInFlight_;
  // Of the submissions that hold uploads: those of frames, or, with FrothContextInfo::hasUploadQueue, others.
  bool hasUploadQueue_ = false;
  uint64_t uploadSerial_ = 0, completedUploadSerial_ = 0;
  uint64_t uploadBytesLeft_ = 0;           // of this frame
  uint32_t loadMicroseconds_ = 0;          // FrothFrame's
  std::atomic<uint64_t> drawnSerial_ = 0;  // newest frame in which a view was drawn,
  uint64_t drawnBeforeSerial_ = 0;         // and the newest before this one
};

}  // namespace froth

struct FrothContext : froth::Context {};
