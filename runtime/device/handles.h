// Objects named by index and generation, so that a stale handle is recognized.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace froth {

// Handles of one kind.
template <class Handle>
bool isSame(Handle a, Handle b) {
  return a.index == b.index && a.generation == b.generation;
}

// `Handle` has the fields index and generation; {0, 0} is never handed out. One thread at a time for add and
// remove.
template <class T, class Handle>
class HandlePool {
 public:
  Handle add(std::shared_ptr<T> object) {
    uint32_t index = 0;
    while (index < slots_.size() && slots_[index].object) {
      ++index;
    }
    if (index == slots_.size()) {
      slots_.emplace_back();
    }
    slots_[index].object = std::move(object);
    return {index, slots_[index].generation};
  }

  T* find(Handle handle) const {  // null: stale or never handed out
    const bool isLive = handle.index < slots_.size() && slots_[handle.index].generation == handle.generation;
    return isLive ? slots_[handle.index].object.get() : nullptr;
  }

  // The handle must be live, and names the new object from here on. Returns the old one.
  std::shared_ptr<T> replace(Handle handle, std::shared_ptr<T> object) {
    std::swap(slots_[handle.index].object, object);
    return object;
  }

  // The handle must be live.
  std::shared_ptr<T> remove(Handle handle) {
    Slot& slot = slots_[handle.index];
    slot.generation = slot.generation == UINT32_MAX ? 1 : slot.generation + 1;
    return std::move(slot.object);
  }

  template <class Visit>
  void forEach(Visit visit) const {
    for (const Slot& slot : slots_) {
      if (slot.object) {
        visit(*slot.object);
      }
    }
  }

  // visit(handle, object)
  template <class Visit>
  void forEachNamed(Visit visit) const {
    for (uint32_t index = 0; index < slots_.size(); ++index) {
      if (slots_[index].object) {
        visit(Handle{index, slots_[index].generation}, *slots_[index].object);
      }
    }
  }

 private:
  struct Slot {
    std::shared_ptr<T> object;
    uint32_t generation = 1;
  };
  std::vector<Slot> slots_;
};

}  // namespace froth
