// Which memory a shader reads and writes, read from its SPIR-V: every load, store and atomic is followed back to the
// push constant or descriptor from which its address comes.
#pragma once

#include <compare>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

namespace froth::test {

enum class Root : uint32_t { kPushConstants, kDescriptor };

// A place as the shader names it: from the root on, an address is loaded at each of `addresses` [bytes from where the
// one before points], and the last one points `place` bytes before what is accessed. Elements of arrays without a
// length count as the array:
// `place` is then where it begins, and `element` the offset of what is accessed in its first element.
struct Location {
  Root root;
  uint32_t binding;  // of kDescriptor, set 0
  std::vector<uint32_t> addresses;
  uint32_t place = 0;
  uint32_t element = 0;
  bool isInArray = false;
  auto operator<=>(const Location&) const = default;
};

enum class AccessMode { kRead, kWrite, kAtomic };

struct ShaderAccess {
  Location location;
  AccessMode mode;
  auto operator<=>(const ShaderAccess&) const = default;
};

// All that the shader may access, whatever its branches, specialization and indices are. Images count with place 0.
std::set<ShaderAccess> findAccesses(std::span<const uint32_t> spirv);

}  // namespace froth::test
