// Numbers that the GPU writes around the passes of a view, for who looks after it has hung.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "froth/froth_breadcrumbs.h"
#include "runtime/device/device.h"

namespace froth {

// The newest passes. One thread at a time.
class Breadcrumbs {
 public:
  struct Pass {
    const char* call;
    const char* name;
    uint32_t eye;
    uint64_t serial;
  };

  // recordings: of a frame.
  static Result<std::unique_ptr<Breadcrumbs>> create(Device& device, uint32_t framesInFlight, uint32_t recordings);
  ~Breadcrumbs();  // the GPU must be done with the view

  // Around the commands of a pass, which may have others within. begin() gives what end() takes.
  uint32_t begin(VkCommandBuffer commandBuffer, const Pass& pass);
  void end(VkCommandBuffer commandBuffer, uint32_t crumb);

  void dropFrame(uint64_t serial);
  // Before the device goes: what the GPU has written stays, its buffer does not.
  void keep();
  // Those that lie beyond `capacity` are counted only.
  void list(FrothView view, uint32_t capacity, FrothBreadcrumb* breadcrumbs, uint32_t& count) const;

 private:
  struct Crumb {
    Pass pass{};
    uint32_t number = 0;  // that the GPU writes; 0: none
  };
  struct Marks {
    uint32_t begun, finished;  // numbers
  };

  explicit Breadcrumbs(Device& device) : device_(device) {}
  void mark(VkCommandBuffer commandBuffer, VkDeviceSize offset, uint32_t number);
  const Marks& marksOf(size_t crumb) const;

  Device& device_;
  GpuBuffer buffer_;  // Marks of each crumb; none after keep()
  std::vector<Crumb> crumbs_;
  std::vector<Marks> kept_;
  uint32_t next_ = 0;  // of crumbs_, which are used in a circle
  uint32_t newestNumber_ = 0;
};

// Records `commands` as this pass; crumbs null: without marks.
template <class Commands>
void recordPass(Breadcrumbs* crumbs, VkCommandBuffer commandBuffer, const Breadcrumbs::Pass& pass,
                const Commands& commands) {
  const uint32_t crumb = crumbs ? crumbs->begin(commandBuffer, pass) : 0;
  commands();
  if (crumbs) crumbs->end(commandBuffer, crumb);
}

}  // namespace froth
