// Which threads of a workgroup disturb each other in shared memory, read from a shader's SPIR-V.
//
// Between two barriers the threads run in any order. So no two of them may use the same place there, unless both read
// it or both use it by atomics. The shader is walked for all threads of a workgroup at once: numbers that come from a
// thread's own index, constants and counters of loops are known of each thread, all others of none. A branch on a known
// number is taken by the threads that take it; one on an unknown number goes both ways. Loops run as often as known
// numbers say; where those do not tell, until another round adds nothing.
//
// An index that is not known may be any, but one store does not disturb itself in other threads by it: that their
// places differ is for the shader to see to, and no barrier could.
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <string>

namespace froth::test {

// Each names a shared variable and what disturbs what, or a barrier that some threads do not reach. A barrier that does
// not order shared memory counts as none.
std::set<std::string> findRaces(std::span<const uint32_t> spirv);

}  // namespace froth::test
