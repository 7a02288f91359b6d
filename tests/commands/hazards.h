// Memory as the rules of Vulkan's synchronization see it: who accessed it, and which barriers stand in between.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

namespace froth::test {

struct Use {
  VkPipelineStageFlags2 stage;
  VkAccessFlags2 access;
  bool isWrite;
  bool isAtomic;     // atomics of several dispatches do not disturb each other
  uint64_t command;  // uses of one command do not disturb each other
  std::string by;
};

// Bytes [begin, end) of all memory; an image is a byte of its own.
struct Range {
  uint64_t begin, end;
  bool operator==(const Range&) const = default;
};

// A memory dependency.
struct Dependency {
  VkPipelineStageFlags2 fromStages;
  VkAccessFlags2 fromAccesses;
  VkPipelineStageFlags2 toStages;
  VkAccessFlags2 toAccesses;
};

class Hazards {
 public:
  // Two uses that touch different parts of what they share, though the ranges are the same.
  using AreApart = std::function<bool(const Use&, const Use&, const Range&)>;
  explicit Hazards(AreApart areApart) : areApart_(std::move(areApart)) {}

  void use(const Range& range, const Use& use);
  void wait(const Dependency& dependency);
  void wait(const Dependency& dependency, const Range& range);
  // A layout transition: the image is written between both scopes.
  void change(const Dependency& dependency, const Range& range, const std::string& by);

  // Frames: uses belong to the newest. What the host has waited for lies behind it; before it can read any of `mapped`
  // that they wrote, that must be visible to it.
  void beginFrame(uint64_t serial) { serial_ = serial; }
  void complete(uint64_t serial, const std::vector<Range>& mapped);

  std::vector<std::string> found;  // no dependency where one is needed

 private:
  struct Past {
    Past(const Range& of, Use made, uint64_t in) : range(of), use(std::move(made)), serial(in) {}
    Range range;
    Use use;
    uint64_t serial;
    VkPipelineStageFlags2 after = 0;  // stages that wait for it
    bool isAvailable = false;
    std::vector<std::pair<VkPipelineStageFlags2, VkAccessFlags2>> visible{};
  };
  static void order(Past& past, const Dependency& dependency);
  bool isOrdered(const Past& past, const Use& use) const;

  AreApart areApart_;
  std::vector<Past> past_;
  uint64_t serial_ = 0;
};

}  // namespace froth::test
