// SPIR-V as a row of instructions, and the numbers of those that tests look at. By its specification.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace froth::test::spirv {

enum Op : uint32_t {
  kExecutionMode = 16,
  kTypeInt = 21,
  kTypeFloat = 22,
  kTypeVector = 23,
  kTypeArray = 28,
  kTypeRuntimeArray = 29,
  kTypeStruct = 30,
  kTypePointer = 32,
  kConstantTrue = 41,
  kConstantFalse = 42,
  kConstant = 43,
  kFunction = 54,
  kFunctionParameter = 55,
  kFunctionEnd = 56,
  kFunctionCall = 57,
  kVariable = 59,
  kLoad = 61,
  kStore = 62,
  kCopyMemory = 63,
  kAccessChain = 65,
  kInBoundsAccessChain = 66,
  kPtrAccessChain = 67,
  kDecorate = 71,
  kMemberDecorate = 72,
  kCompositeConstruct = 80,
  kCompositeExtract = 81,
  kCompositeInsert = 82,
  kCopyObject = 83,
  kImageFetch = 95,
  kImageRead = 98,
  kImageWrite = 99,
  kIAdd = 128,
  kISub = 130,
  kIMul = 132,
  kUDiv = 134,
  kUMod = 137,
  kLogicalOr = 166,
  kLogicalAnd = 167,
  kLogicalNot = 168,
  kSelect = 169,
  kIEqual = 170,
  kINotEqual = 171,
  kUGreaterThan = 172,
  kUGreaterThanEqual = 174,
  kULessThan = 176,
  kSLessThan = 177,
  kULessThanEqual = 178,
  kShiftRightLogical = 194,
  kShiftLeftLogical = 196,
  kBitwiseOr = 197,
  kBitwiseXor = 198,
  kBitwiseAnd = 199,
  kControlBarrier = 224,
  kAtomicLoad = 227,
  kAtomicStore = 228,
  kAtomicExchange = 229,
  kAtomicXor = 242,
  kPhi = 245,
  kLoopMerge = 246,
  kSelectionMerge = 247,
  kLabel = 248,
  kBranch = 249,
  kBranchConditional = 250,
  kSwitch = 251,
  kReturn = 253,
  kReturnValue = 254,
  kUnreachable = 255,
  kCopyLogical = 400
};
enum Storage : uint32_t {
  kUniformConstant = 0,
  kInput = 1,
  kUniform = 2,
  kWorkgroup = 4,
  kFunctionStorage = 7,
  kPushConstant = 9,
  kStorageBuffer = 12,
  kPhysicalStorageBuffer = 5349
};
enum Decoration : uint32_t { kArrayStride = 6, kBuiltIn = 11, kBinding = 33, kOffset = 35 };
enum BuiltInInput : uint32_t { kLocalInvocationId = 27, kLocalInvocationIndex = 29 };
constexpr uint32_t kLocalSize = 17;  // execution mode
constexpr uint32_t kHeaderWords = 5;

struct Instruction {
  uint32_t op;
  std::span<const uint32_t> words;  // with the first
};

inline std::vector<Instruction> split(std::span<const uint32_t> spirv) {
  std::vector<Instruction> instructions;
  for (size_t at = kHeaderWords; at < spirv.size(); at += spirv[at] >> 16) {
    instructions.push_back({spirv[at] & 0xffff, spirv.subspan(at, spirv[at] >> 16)});
  }
  return instructions;
}

inline bool isAtomic(uint32_t op) {
  return op == kAtomicLoad || op == kAtomicStore || (op >= kAtomicExchange && op <= kAtomicXor);
}

}  // namespace froth::test::spirv
