#include "runtime/render/breadcrumbs.h"

#include <cstddef>
#include <cstring>

#include "runtime/render/pass_timer.h"
#include "runtime/render/view_renderer.h"

namespace froth {
namespace {

// Composites and depth exports beside the recordings, each of each eye.
constexpr uint32_t kOtherPasses = 2 * kMostEyes;

}  // namespace

Result<std::unique_ptr<Breadcrumbs>> Breadcrumbs::create(Device& device, uint32_t framesInFlight, uint32_t recordings) {
  std::unique_ptr<Breadcrumbs> made(new Breadcrumbs(device));
  made->crumbs_.resize(framesInFlight * (recordings * PassTimer::kMaxPasses + kOtherPasses));
  made->kept_.resize(made->crumbs_.size());
  const VkDeviceSize size = made->crumbs_.size() * sizeof(Marks);
  const Result<GpuBuffer> buffer =
      device.createBuffer(MemoryUse::kViewsHost, BufferKind::kReadback, size, "breadcrumbs of a view");
  if (!buffer) return buffer.error();
  made->buffer_ = *buffer;
  std::memset(buffer->mapped, 0, size);
  return made;
}

Breadcrumbs::~Breadcrumbs() {
  if (buffer_.buffer) device_.destroyBuffer(buffer_);
}

uint32_t Breadcrumbs::begin(VkCommandBuffer commandBuffer, const Pass& pass) {
  const uint32_t crumb = next_;
  next_ = (next_ + 1) % static_cast<uint32_t>(crumbs_.size());
  newestNumber_ = newestNumber_ % UINT32_MAX + 1;
  crumbs_[crumb] = {pass, newestNumber_};
  mark(commandBuffer, crumb * sizeof(Marks) + offsetof(Marks, begun), newestNumber_);
  return crumb;
}

void Breadcrumbs::end(VkCommandBuffer commandBuffer, uint32_t crumb) {
  mark(commandBuffer, crumb * sizeof(Marks) + offsetof(Marks, finished), crumbs_[crumb].number);
}

// Written when all before is finished, and before anything that follows begins. The host reads it at any time.
void Breadcrumbs::mark(VkCommandBuffer commandBuffer, VkDeviceSize offset, uint32_t number) {
  const DeviceTable& vk = device_.table;
  vk.recordMemoryBarrier(commandBuffer, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                         VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
  vk.vkCmdFillBuffer(commandBuffer, buffer_.buffer, offset, sizeof(number), number);
  vk.recordMemoryBarrier(commandBuffer, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                         VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT,
                         VK_ACCESS_2_HOST_READ_BIT);
}

void Breadcrumbs::dropFrame(uint64_t serial) {
  for (Crumb& crumb : crumbs_) {
    if (crumb.pass.serial == serial) crumb = {};
  }
  // What is empty is used first, so that frames which are dropped one after the other displace none in flight.
  const auto count = static_cast<uint32_t>(crumbs_.size());
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t previous = (next_ + count - 1) % count;
    if (crumbs_[previous].number != 0) return;
    next_ = previous;
  }
}

void Breadcrumbs::keep() {
  if (!buffer_.buffer) return;
  std::memcpy(kept_.data(), buffer_.mapped, kept_.size() * sizeof(Marks));
  device_.destroyBuffer(buffer_);
}

const Breadcrumbs::Marks& Breadcrumbs::marksOf(size_t crumb) const {
  return buffer_.buffer ? static_cast<const Marks*>(buffer_.mapped)[crumb] : kept_[crumb];
}

void Breadcrumbs::list(FrothView view, uint32_t capacity, FrothBreadcrumb* breadcrumbs, uint32_t& count) const {
  for (size_t i = 0; i < crumbs_.size(); ++i) {
    const size_t place = (next_ + i) % crumbs_.size();
    const auto& [pass, number] = crumbs_[place];
    if (number == 0) continue;
    if (count < capacity) {
      const Marks& marks = marksOf(place);
      breadcrumbs[count] = {
          view, pass.serial, pass.call, pass.name, pass.eye, marks.begun == number, marks.finished == number};
    }
    ++count;
  }
}

}  // namespace froth
