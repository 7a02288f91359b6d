#include "tests/commands/shader_module.h"

namespace froth::test {

using namespace spirv;

ShaderModule::ShaderModule(std::span<const uint32_t> spirv) : begin(spirv.data()), instructions(split(spirv)) {
  std::map<uint32_t, uint32_t> builtIns;
  uint32_t function = 0;
  for (size_t i = 0; i < instructions.size(); ++i) {
    const auto& w = instructions[i].words;
    switch (instructions[i].op) {
      case kExecutionMode:
        entry = w[1];
        if (w[2] == kLocalSize) threads = w[3] * w[4] * w[5];
        break;
      case kDecorate:
        if (w[2] == kBuiltIn) builtIns[w[1]] = w[3];
        break;
      case kConstantTrue:
      case kConstantFalse:
        constants[w[2]] = instructions[i].op == kConstantTrue;
        break;
      case kConstant:
        if (w.size() == 4) constants[w[2]] = w[3];
        break;
      case kVariable:
        if (function == 0) variables[w[2]] = {w[3], builtIns[w[2]]};
        break;
      case kFunction:
        function = w[2];
        functions[function] = {function, {}, static_cast<uint32_t>(blocks.size()), 0};
        break;
      case kFunctionParameter:
        functions[function].parameters.push_back(w[2]);
        break;
      case kLabel:
        blockOf[w[1]] = static_cast<uint32_t>(blocks.size());
        blocks.push_back({function, i + 1, 0});
        break;
      case kBranch:
      case kBranchConditional:
      case kSwitch:
      case kReturn:
      case kReturnValue:
      case kUnreachable:
        blocks.back().end = i;
        break;
      case kFunctionEnd:
        functions[function].endBlock = static_cast<uint32_t>(blocks.size());
        break;
      default:
        break;
    }
  }
  for (ShaderBlock& block : blocks) {
    for (size_t i = block.first; i < block.end; ++i) {
      if (instructions[i].op == kLoopMerge) block.loopEnd = blockOf.at(instructions[i].words[1]);
    }
  }
}

bool ShaderModule::isShared(uint32_t id) const {
  const auto variable = variables.find(id);
  return variable != variables.end() && variable->second.storage == kWorkgroup;
}

}  // namespace froth::test
