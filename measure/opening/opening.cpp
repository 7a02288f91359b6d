#include "measure/opening/opening.h"

#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <fstream>
#include <memory>
#include <utility>

#include "base/progress_printer.h"
#include "froth/froth_files.h"
#include "froth/froth_pool.h"
#include "froth/froth_precompile.h"
#include "froth/froth_stream.h"
#include "host/http_reader.h"
#include "host/make_struct.h"
#include "measure/gpu/gpu_camera.h"
#include "measure/opening/counting_reader.h"
#include "measure/opening/file_cache.h"

namespace froth {
namespace {

constexpr uint32_t kThreads = 2;
constexpr uint32_t kOpenRestFrames = 16;  // what a view wants changes while its buffers grow
constexpr double kMostMs = 120'000;       // a server may be slow

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double processMilliseconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

// 0 where the kernel does not tell.
uint64_t bytesFromDisk() {
  std::ifstream file("/proc/self/io");
  uint64_t value = 0;
  for (std::string name; file >> name >> value;) {
    if (name == "read_bytes:") return value;
  }
  return 0;
}

struct PoolDeleter {
  void operator()(FrothJobPool* pool) const { frothDestroyJobPool(pool); }
};
using Pool = std::unique_ptr<FrothJobPool, PoolDeleter>;

Pool createPool() {
  FrothJobPool* pool = nullptr;
  frothCreateJobPool(kThreads, &pool);
  return Pool(pool);
}

// One run: a context of its own.
class Run {
 public:
  Run(Host& host, VkPipelineCache cache, const OpeningOptions& options)
      : host_(host), cache_(cache), options_(options), jobs_(createPool()), io_(createPool()) {}
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;
  ~Run();

  Status create(Opening& opening);
  Status open(Opening& opening);
  FrothAssetStatus assetStatus() const;

 private:
  struct Frame {
    double updateMs = 0;
    bool isDrawn = false;    // as far as its recording knows
    bool isSettled = false;  // as it was recorded
  };

  Status check(FrothResult result, const char* call) const;
  Status precompile(Opening& opening);
  Status openReader(FrothReader& reader);
  Status openFile(FrothReader& reader);
  Status drawUntilSettled(Opening& opening);
  Status draw(Frame& frame);
  Status record(VkCommandBuffer commands, uint64_t serial, Frame& frame);
  OpeningMark markNow() const;

  Host& host_;
  VkPipelineCache cache_;
  const OpeningOptions& options_;
  Pool jobs_, io_;
  FrothContext* context_ = nullptr;
  FrothFile* file_ = nullptr;
  std::unique_ptr<HttpReader> http_;
  std::unique_ptr<CountingReader> counting_;
  FrothAsset asset_{};
  FrothView view_{};
  HostImage image_;
  Clock::time_point start_;
  double processMsAtStart_ = 0;
  uint32_t frames_ = 0;
  bool wasWhole_ = true;  // the frame before lacked nothing, as is known by now
  std::string lastMessage_;
};

Run::~Run() {
  if (frothDestroyContext(context_, UINT64_MAX) == FROTH_PENDING) {
    frothCloseFile(std::exchange(file_, nullptr));
    http_.reset();
    frothDestroyContext(context_, UINT64_MAX);
  }
  frothCloseFile(file_);
  if (image_.image) host_.destroyImage(image_);
}

Status Run::check(FrothResult result, const char* call) const {
  if (result >= FROTH_OK) return {};
  const ErrorKind kind = result == FROTH_ERROR_FILE ? ErrorKind::kBadInput : ErrorKind::kUnsupported;
  const std::string fault = http_ ? http_->lastFault() : "";
  if (!fault.empty()) return makeError(kind, "%s: %s", lastMessage_.c_str(), fault.c_str());
  if (!lastMessage_.empty()) return makeError(kind, "%s", lastMessage_.c_str());
  return makeError(kind, "%s gives %s", call, frothResultName(result));
}

Status Run::create(Opening& opening) {
  FrothContextInfo info = host_.contextInfo();
  info.pipelineCache = cache_;
  info.lensClasses = lensClassesOf(options_.view);
  info.runJob = jobs_ ? frothRunInPool : nullptr;
  info.jobUser = jobs_.get();
  info.messageUser = this;
  info.onMessage = [](void* user, FrothSeverity severity, FrothResult, const char* object, const char* text) {
    if (severity != FROTH_SEVERITY_ERROR) return;
    static_cast<Run*>(user)->lastMessage_ = std::string(object) + ": " + text;
  };
  const auto start = Clock::now();
  if (Status made = check(frothCreateContext(&info, &context_), "frothCreateContext"); !made) return made;
  opening.contextMs = millisecondsSince(start);
  auto view = makeStruct<FrothViewInfo>();
  view.maxExtent = {options_.view.width, options_.view.height};
  view.lensClasses = info.lensClasses;
  if (Status made = check(frothCreateView(context_, &view, &view_), "frothCreateView"); !made) return made;
  Result<HostImage> image = host_.createImage(VK_FORMAT_R16G16B16A16_SFLOAT, view.maxExtent);
  if (!image) return image.error();
  image_ = *image;
  if (Status compiled = precompile(opening); !compiled) return compiled;
  // A first frame without an asset: the view has its memory, the driver has seen a submission.
  Frame empty;
  return draw(empty);
}

// frothReadVariant reads no URL.
Status Run::precompile(Opening& opening) {
  if (isUrl(options_.asset)) return {};
  const auto start = Clock::now();
  auto asset = makeStruct<FrothAssetInfo>();
  asset.path = options_.asset.c_str();
  FrothVariant variant{};
  if (Status read = check(frothReadVariant(context_, &asset, &variant), "frothReadVariant"); !read) return read;
  auto info = makeStruct<FrothPrecompileInfo>();
  info.variantCount = 1;
  info.variants = &variant;
  const Status compiled = check(frothPrecompile(context_, &info), "frothPrecompile");
  opening.precompileMs = millisecondsSince(start);
  return compiled;
}

Status Run::openFile(FrothReader& reader) {
  auto info = makeStruct<FrothFileInfo>();
  info.path = options_.asset.c_str();
  info.runJob = io_ ? frothRunInPool : nullptr;
  info.jobUser = io_.get();
  if (frothOpenFile(context_, &info, &file_) != FROTH_OK) {
    return makeError(ErrorKind::kBadInput, "%s: cannot be opened: %s; check the path", info.path,
                     errno == 0 ? "it is no regular file" : std::strerror(errno));
  }
  reader = *frothGetFileReader(file_);
  return {};
}

Status Run::openReader(FrothReader& reader) {
  if (!isUrl(options_.asset)) return openFile(reader);
  Result<std::unique_ptr<HttpReader>> http = HttpReader::open(options_.asset, context_);
  if (!http) return http.error();
  http_ = std::move(*http);
  reader = http_->reader();
  return {};
}

Status Run::open(Opening& opening) {
  if (!isUrl(options_.asset)) {
    if (!options_.keepsCache) {
      if (Status dropped = dropFromCache(options_.asset); !dropped) return dropped;
    }
    const Result<double> share = cachedShareOf(options_.asset);
    if (!share) return share.error();
    opening.cachedShare = *share;
  }
  frames_ = 0;
  const uint64_t diskBytes = bytesFromDisk();
  processMsAtStart_ = processMilliseconds();
  start_ = Clock::now();
  FrothReader reader{};
  if (Status opened = openReader(reader); !opened) return opened;
  counting_ = std::make_unique<CountingReader>(reader);
  reader = counting_->reader();
  auto asset = makeStruct<FrothAssetInfo>();
  asset.reader = &reader;
  if (Status opened = check(frothOpenAsset(context_, &asset, &asset_), "frothOpenAsset"); !opened) return opened;
  auto placed = makeStruct<FrothInstanceInfo>();
  placed.asset = asset_;
  FrothInstance instance{};
  if (Status made = check(frothCreateInstance(context_, &placed, &instance), "frothCreateInstance"); !made) return made;
  const Status drawn = drawUntilSettled(opening);
  opening.diskBytes = bytesFromDisk() - diskBytes;
  return drawn;
}

FrothAssetStatus Run::assetStatus() const {
  auto status = makeStruct<FrothAssetStatus>();
  if (counting_) frothGetAssetStatus(context_, asset_, &status);
  return status;
}

OpeningMark Run::markNow() const {
  return {millisecondsSince(start_), frames_, counting_->reads(), counting_->bytes(),
          processMilliseconds() - processMsAtStart_};
}

// Whether a frame was whole is known when the next is begun: so a mark is kept until then.
Status Run::drawUntilSettled(Opening& opening) {
  OpeningMark before, settledSince;
  bool wasDrawn = false, wasSettled = false, isFirstKnown = false;
  for (uint32_t atRest = 0; atRest < kOpenRestFrames;) {
    if (isStopRequested()) return stoppedError();
    Frame frame;
    if (Status drawn = draw(frame); !drawn) return drawn;
    const OpeningMark now = markNow();
    const FrothAssetStatus asset = assetStatus();
    if (opening.head.frames == 0 && asset.chunkCount > 0) opening.head = now;
    if (opening.ready.frames == 0 && asset.state == FROTH_ASSET_READY) opening.ready = now;
    const bool wasGood = wasDrawn && wasWhole_;
    if (!isFirstKnown) opening.longestUpdateMs = std::max(opening.longestUpdateMs, frame.updateMs);
    if (!isFirstKnown && wasGood) opening.first = before;
    isFirstKnown = isFirstKnown || wasGood;
    if (!wasGood || !wasSettled) atRest = 0;
    if (wasGood && wasSettled && atRest++ == 0) opening.settled = before;
    wasDrawn = frame.isDrawn;
    wasSettled = frame.isSettled;
    before = now;
    if (now.milliseconds > kMostMs) {
      return makeError(ErrorKind::kUnsupported, "%s: is not drawn as its view wants it in %.0f s",
                       options_.asset.c_str(), kMostMs / 1000);
    }
  }
  return {};
}

Status Run::draw(Frame& frame) {
  const Status drawn =
      host_.submit([&](VkCommandBuffer commands, uint64_t serial) { return record(commands, serial, frame); });
  ++frames_;
  return drawn;
}

Status Run::record(VkCommandBuffer commands, uint64_t serial, Frame& frame) {
  auto begun = makeStruct<FrothFrame>();
  begun.serial = serial;
  begun.completedSerial = serial - 1;
  const auto start = Clock::now();
  const FrothResult updated = frothUpdate(context_, &begun, nullptr);
  frame.updateMs = millisecondsSince(start);
  if (Status good = check(updated, "frothUpdate"); !good) return good;
  auto view = makeStruct<FrothViewStatus>();
  if (Status asked = check(frothGetViewStatus(context_, view_, &view), "frothGetViewStatus"); !asked) return asked;
  wasWhole_ = view.bits == 0;
  if (Status copied = check(frothRecordUpload(context_, commands), "frothRecordUpload"); !copied) return copied;
  const FrothAssetStatus asset = assetStatus();
  if (asset.state == FROTH_ASSET_FAILED) return check(asset.error, "frothOpenAsset");
  FrothRenderInfo info = renderInfoOf(options_.view, options_.render);
  info.colour = host_.describe(image_);
  const MethodInfo& method = infoOf(options_.render.method);
  const FrothResult drawn = method.record(context_, view_, commands, &info);
  frame.isDrawn = drawn == FROTH_OK && asset.state == FROTH_ASSET_READY;
  auto stream = makeStruct<FrothStreamStatus>();
  if (Status good = check(frothGetStreamStatus(context_, &stream), "frothGetStreamStatus"); !good) return good;
  frame.isSettled = stream.isSettled != 0;
  return check(drawn, method.call);
}

}  // namespace

Result<Openings> openAndDraw(const OpeningOptions& options, const Progress& progress) {
  Result<std::unique_ptr<Host>> host = Host::create({options.device});
  if (!host) return host.error();
  VkPipelineCacheCreateInfo cacheInfo{};
  cacheInfo.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO;
  VkPipelineCache cache = VK_NULL_HANDLE;
  if (vkCreatePipelineCache((*host)->device, &cacheInfo, nullptr, &cache) != VK_SUCCESS) {
    return makeError(ErrorKind::kDevice, "vkCreatePipelineCache fails");
  }
  Openings openings;
  openings.deviceName = (*host)->info.name;
  openings.driverName = (*host)->info.driver;
  Status status;
  for (uint32_t i = 0; i < options.runs && status; ++i) {
    if (!report(progress, "open", i, options.runs)) status = stoppedError();
    Opening opening;
    Run run(**host, cache, options);
    if (status) status = run.create(opening);
    if (status) status = run.open(opening);
    openings.asset = run.assetStatus();
    openings.runs.push_back(opening);
  }
  vkDestroyPipelineCache((*host)->device, cache, nullptr);
  if (!status) return status.error();
  return openings;
}

}  // namespace froth
