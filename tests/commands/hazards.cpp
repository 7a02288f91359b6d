#include "tests/commands/hazards.h"

namespace froth::test {
namespace {

bool overlap(const Range& a, const Range& b) { return a.begin < b.end && b.begin < a.end; }
bool contains(const Range& outer, const Range& inner) { return outer.begin <= inner.begin && inner.end <= outer.end; }

// What a name of several stages or accesses stands for, as far as it is used here.
VkPipelineStageFlags2 expandStages(VkPipelineStageFlags2 stages) {
  constexpr VkPipelineStageFlags2 kTransfer = VK_PIPELINE_STAGE_2_COPY_BIT | VK_PIPELINE_STAGE_2_CLEAR_BIT;
  if (stages & VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT) stages |= kTransfer;
  if (stages & VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT) stages = ~VkPipelineStageFlags2{0};
  return stages;
}

VkAccessFlags2 expandAccesses(VkAccessFlags2 accesses) {
  constexpr VkAccessFlags2 kReads =
      VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_UNIFORM_READ_BIT;
  if (accesses & VK_ACCESS_2_SHADER_READ_BIT) accesses |= kReads;
  if (accesses & VK_ACCESS_2_SHADER_WRITE_BIT) accesses |= VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
  if (accesses & (VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT)) accesses = ~VkAccessFlags2{0};
  return accesses;
}

constexpr VkAccessFlags2 kWrites = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT |
                                   VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;

bool flushes(const Dependency& dependency, const Use& use) {
  return (expandStages(dependency.fromStages) & use.stage) != 0 &&
         (expandAccesses(dependency.fromAccesses) & use.access & kWrites) != 0;
}

}  // namespace

bool Hazards::isOrdered(const Past& past, const Use& use) const {
  if ((past.use.isAtomic && use.isAtomic) || (use.command != 0 && past.use.command == use.command)) return true;
  if (!past.use.isWrite) return !use.isWrite || (past.after & use.stage) != 0;
  for (const auto& [stages, accesses] : past.visible) {
    if ((stages & use.stage) && (accesses & use.access) == use.access) return true;
  }
  return false;
}

void Hazards::use(const Range& range, const Use& use) {
  for (const Past& past : past_) {
    if (!overlap(past.range, range) || isOrdered(past, use) || areApart_(past.use, use, range)) continue;
    found.push_back(use.by + (use.isWrite ? " writes" : " reads") + " after " + past.use.by +
                    (past.use.isWrite ? " wrote" : " read"));
  }
  const auto isReplaced = [&](const Past& past) {
    if (use.isWrite) return !use.isAtomic && contains(range, past.range);
    return !past.use.isWrite && past.range == range && past.use.stage == use.stage && past.use.access == use.access;
  };
  std::erase_if(past_, isReplaced);
  past_.emplace_back(range, use, serial_);
}

void Hazards::order(Past& past, const Dependency& dependency) {
  const VkPipelineStageFlags2 from = expandStages(dependency.fromStages), to = expandStages(dependency.toStages);
  if ((from & (past.use.stage | past.after)) == 0) return;
  past.after |= to;
  past.isAvailable = past.isAvailable || flushes(dependency, past.use);
  if (past.isAvailable) past.visible.emplace_back(to, expandAccesses(dependency.toAccesses));
}

void Hazards::wait(const Dependency& dependency) {
  for (Past& past : past_) order(past, dependency);
}

void Hazards::wait(const Dependency& dependency, const Range& range) {
  for (Past& past : past_) {
    if (overlap(past.range, range)) order(past, dependency);
  }
}

void Hazards::change(const Dependency& dependency, const Range& range, const std::string& by) {
  for (Past& past : past_) {
    if (!overlap(past.range, range)) continue;
    const bool isBehind = (expandStages(dependency.fromStages) & (past.use.stage | past.after)) != 0;
    if (!isBehind || (past.use.isWrite && !past.isAvailable && !flushes(dependency, past.use))) {
      found.push_back(by + " changes the layout after " + past.use.by + (past.use.isWrite ? " wrote" : " read"));
    }
  }
  std::erase_if(past_, [&](const Past& past) { return contains(range, past.range); });
  const VkPipelineStageFlags2 to = expandStages(dependency.toStages);
  Past change(range, Use{0, 0, true, false, 0, by}, serial_);
  change.after = to;
  change.isAvailable = true;
  change.visible.emplace_back(to, expandAccesses(dependency.toAccesses));
  past_.push_back(std::move(change));
}

void Hazards::complete(uint64_t serial, const std::vector<Range>& mapped) {
  const Use host{VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT, false, false, 0, "the host"};
  for (const Past& past : past_) {
    for (const Range& range : mapped) {
      if (past.serial <= serial && past.use.isWrite && overlap(past.range, range) && !isOrdered(past, host)) {
        found.push_back("the host reads after " + past.use.by + " wrote");
      }
    }
  }
  std::erase_if(past_, [&](const Past& past) { return past.serial <= serial; });
}

}  // namespace froth::test
