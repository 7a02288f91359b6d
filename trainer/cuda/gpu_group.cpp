#include "trainer/cuda/gpu_group.h"

#ifdef FROTH_HAS_NCCL

#include <dlfcn.h>
#include <nccl.h>

#include <string>

namespace froth {
namespace {

struct Nccl {
  decltype(&ncclCommInitAll) commInitAll = nullptr;
  decltype(&ncclCommDestroy) commDestroy = nullptr;
  decltype(&ncclAllGather) allGather = nullptr;
  decltype(&ncclGroupStart) groupStart = nullptr;
  decltype(&ncclGroupEnd) groupEnd = nullptr;
  decltype(&ncclGetErrorString) getErrorString = nullptr;
  std::string fault;  // empty: all of them are there
};

template <class Function>
void findFunction(void* library, const char* name, Function& function, std::string& fault) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  if (function == nullptr) fault = std::string("libnccl.so.2 has no ") + name;
}

Nccl loadNccl() {
  Nccl nccl;
  void* library = dlopen("libnccl.so.2", RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    nccl.fault = dlerror();
    library = dlopen(FROTH_NCCL_LIBRARY, RTLD_NOW | RTLD_LOCAL);  // where it was when froth was built
  }
  if (library == nullptr) return nccl;
  nccl.fault.clear();
  findFunction(library, "ncclCommInitAll", nccl.commInitAll, nccl.fault);
  findFunction(library, "ncclCommDestroy", nccl.commDestroy, nccl.fault);
  findFunction(library, "ncclAllGather", nccl.allGather, nccl.fault);
  findFunction(library, "ncclGroupStart", nccl.groupStart, nccl.fault);
  findFunction(library, "ncclGroupEnd", nccl.groupEnd, nccl.fault);
  findFunction(library, "ncclGetErrorString", nccl.getErrorString, nccl.fault);
  return nccl;
}

const Nccl& theNccl() {
  static const Nccl nccl = loadNccl();
  return nccl;
}

Status checkNccl(ncclResult_t code, const char* what) {
  if (code == ncclSuccess) return {};
  return makeError(ErrorKind::kDevice, "%s: %s; NCCL_DEBUG=WARN tells more", what, theNccl().getErrorString(code));
}

}  // namespace

struct GpuGroup::Members {
  std::vector<ncclComm_t> all;
};

GpuGroup::GpuGroup() : members_(std::make_unique<Members>()) {}

GpuGroup::~GpuGroup() {
  for (const ncclComm_t member : members_->all) theNccl().commDestroy(member);
}

Status GpuGroup::check() {
  const std::string& fault = theNccl().fault;
  if (fault.empty()) return {};
  return makeError(ErrorKind::kDevice,
                   "several GPUs: NCCL does not load (%s); install libnccl2, or give its folder in LD_LIBRARY_PATH",
                   fault.c_str());
}

Result<std::unique_ptr<GpuGroup>> GpuGroup::make(uint32_t gpuCount) {
  if (Status loaded = check(); !loaded) return loaded.error();
  std::vector<ncclComm_t> all(gpuCount);
  const Status made =
      checkNccl(theNccl().commInitAll(all.data(), static_cast<int>(gpuCount), nullptr), "ncclCommInitAll");
  if (!made) return made.error();
  std::unique_ptr<GpuGroup> group(new GpuGroup());
  group->members_->all = std::move(all);
  return group;
}

Status GpuGroup::gather(const std::vector<Place>& places, size_t bytes) {
  const Nccl& nccl = theNccl();
  if (Status begun = checkNccl(nccl.groupStart(), "ncclGroupStart"); !begun) return begun;
  Status put;
  for (size_t i = 0; i < places.size() && put; ++i) {
    const Place& place = places[i];
    put = checkNccl(
        nccl.allGather(place.blocks + i * bytes, place.blocks, bytes, ncclUint8, members_->all[i], place.stream),
        "ncclAllGather");
  }
  // Also after a fault: the group must end.
  const Status ended = checkNccl(nccl.groupEnd(), "ncclGroupEnd");
  return put ? ended : put;
}

}  // namespace froth

#else

namespace froth {

struct GpuGroup::Members {};
GpuGroup::~GpuGroup() = default;

Status GpuGroup::check() {
  return makeError(ErrorKind::kDevice,
                   "several GPUs: this froth is built without NCCL; install libnccl-dev and build it again");
}

Result<std::unique_ptr<GpuGroup>> GpuGroup::make(uint32_t) { return check().error(); }

Status GpuGroup::gather(const std::vector<Place>&, size_t) { return check(); }

}  // namespace froth

#endif
