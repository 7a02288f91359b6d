// A compute shader's functions and blocks, from its SPIR-V.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "tests/commands/spirv.h"

namespace froth::test {

struct ShaderBlock {
  uint32_t function;
  size_t first, end;     // instructions; `end` is the one that leaves the block
  uint32_t loopEnd = 0;  // of a loop's head: the block behind the loop, which holds all blocks between
};

struct ShaderFunction {
  uint32_t id;
  std::vector<uint32_t> parameters;
  uint32_t firstBlock, endBlock;
};

struct ShaderVariable {
  uint32_t storage;
  uint32_t builtIn;
};

struct ShaderModule {
  explicit ShaderModule(std::span<const uint32_t> spirv);
  bool isShared(uint32_t id) const;
  size_t wordOf(const uint32_t* instruction) const { return static_cast<size_t>(instruction - begin); }

  const uint32_t* begin;
  std::vector<spirv::Instruction> instructions;
  std::vector<ShaderBlock> blocks;               // in the order of the text
  std::map<uint32_t, uint32_t> blockOf;          // by labels
  std::map<uint32_t, ShaderFunction> functions;  // by ids
  std::map<uint32_t, ShaderVariable> variables;  // outside of functions
  std::map<uint32_t, uint32_t> constants;        // of 32 bits, and truths
  uint32_t entry = 0;                            // id of its function
  uint32_t threads = 0;                          // of a workgroup
};

}  // namespace froth::test
