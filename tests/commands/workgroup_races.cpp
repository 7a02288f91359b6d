#include "tests/commands/workgroup_races.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <stdexcept>

#include "tests/commands/lanes.h"
#include "tests/commands/shader_module.h"

namespace froth::test {
namespace {

using namespace spirv;

constexpr int kMostRounds = 2000;  // of a loop whose end is known
constexpr uint32_t kScopeDevice = 1, kScopeWorkgroup = 2;
constexpr uint32_t kOrders = 0x8 | 0x10, kWorkgroupMemory = 0x100;  // memory semantics: acquire and release, or more

enum class Mode { kLoad, kStore, kAtomic };
const char* nameOf(Mode mode) { return mode == Mode::kLoad ? "load" : mode == Mode::kStore ? "store" : "atomic"; }

struct Pointer {
  uint32_t variable = 0;
  std::vector<Value> path;  // indices into it
};

// Of shared memory, by the threads of the mask. In the order of the shader's text.
struct Access {
  uint32_t variable;
  const uint32_t* instruction;
  Mode mode;
  Mask threads;
  std::vector<Value> path;
  auto operator<=>(const Access&) const = default;
};

// Since a barrier. All threads have the same one behind them: paths with different ones exclude each other.
using Intervals = std::map<const uint32_t*, std::set<Access>>;  // by that barrier; nullptr: the shader's begin

// Before an instruction.
struct State {
  Mask threads;                     // that may be here
  std::map<uint32_t, Value> known;  // of the threads' own variables, phis, and what functions return, by their ids
  Intervals pending;
  bool operator==(const State&) const = default;
};

bool isAny(const Mask& mask) { return std::ranges::find(mask, true) != mask.end(); }

Mask both(const Mask& a, const Mask& b) {
  Mask result(a.size());
  for (size_t i = 0; i < a.size(); ++i) result[i] = a[i] && b[i];
  return result;
}

// Whether threads i of a and j of b use the same place. Where they surely do, all indices are known.
enum class Overlap { kNone, kPossible, kSure };

Overlap overlapOf(const Access& a, size_t i, const Access& b, size_t j) {
  Overlap overlap = Overlap::kSure;
  for (size_t k = 0; k < std::min(a.path.size(), b.path.size()); ++k) {
    const auto first = laneOf(a.path[k], i), second = laneOf(b.path[k], j);
    if (!first || !second) {
      overlap = Overlap::kPossible;
    } else if (*first != *second) {
      return Overlap::kNone;
    }
  }
  return overlap;
}

bool disturb(const Access& a, const Access& b) {
  if (a.variable != b.variable || (a.mode == b.mode && a.mode != Mode::kStore)) return false;
  const Overlap enough = a.instruction == b.instruction ? Overlap::kSure : Overlap::kPossible;
  for (size_t i = 0; i < a.threads.size(); ++i) {
    for (size_t j = 0; a.threads[i] && j < b.threads.size(); ++j) {
      if (i != j && b.threads[j] && overlapOf(a, i, b, j) >= enough) return true;
    }
  }
  return false;
}

class Walk {
 public:
  explicit Walk(std::span<const uint32_t> spirv) : module_(spirv), lanes_(module_.threads) {
    if (module_.threads == 0) return;  // no compute shader
    for (const auto& [id, number] : module_.constants) values_[id] = lanes_.constant(number);
    for (const auto& [id, variable] : module_.variables) {
      if (variable.storage == kWorkgroup) pointers_[id] = {id, {}};
    }
    State start{Mask(module_.threads, true), {}, {{nullptr, {}}}};
    end(call(module_.functions.at(module_.entry), std::move(start)));
  }
  std::set<std::string> races;

 private:
  Value valueOf(uint32_t id, const State& state) const {
    if (const auto known = state.known.find(id); known != state.known.end()) return known->second;
    const auto value = values_.find(id);
    return value == values_.end() ? nullptr : value->second;
  }

  State join(State a, const State& b) {
    for (const auto& [id, value] : b.known) a.known.try_emplace(id, nullptr);
    for (auto& [id, value] : a.known) {
      const auto other = b.known.find(id);
      value = lanes_.join(value, a.threads, other == b.known.end() ? nullptr : other->second, b.threads);
    }
    std::erase_if(a.known, [](const auto& known) { return !known.second; });
    for (size_t i = 0; i < a.threads.size(); ++i) a.threads[i] = a.threads[i] || b.threads[i];
    for (const auto& [since, accesses] : b.pending) a.pending[since].insert(accesses.begin(), accesses.end());
    return a;
  }

  void arrive(std::map<uint32_t, State>& at, uint32_t key, State state) {
    if (!isAny(state.threads)) return;
    const auto there = at.find(key);
    if (there == at.end()) {
      at.emplace(key, std::move(state));
    } else {
      there->second = join(std::move(there->second), state);
    }
  }

  State take(std::map<uint32_t, State>& from, uint32_t key) {
    auto node = from.extract(key);
    return node ? std::move(node.mapped()) : State{Mask(lanes_.threads()), {}, {}};
  }

  // A barrier, or the shader's end.
  void end(const State& state) {
    for (const auto& [since, accesses] : state.pending) {
      for (auto a = accesses.begin(); a != accesses.end(); ++a) {
        for (auto b = a; b != accesses.end(); ++b) {
          if (!disturb(*a, *b)) continue;
          std::ostringstream race;
          race << '%' << a->variable << ": " << nameOf(a->mode) << " at word " << module_.wordOf(a->instruction) << ", "
               << nameOf(b->mode) << " at word " << module_.wordOf(b->instruction);
          races.insert(race.str());
        }
      }
    }
  }

  State call(const ShaderFunction& function, State state) {
    state.known.erase(function.id);
    arrive(arriving_, function.firstBlock, std::move(state));
    runBlocks(function.firstBlock, function.endBlock);
    return take(returning_, function.id);
  }

  void runBlocks(uint32_t first, uint32_t last, bool isFirstALoop = false) {
    for (uint32_t i = first; i < last;) {
      const ShaderBlock& block = module_.blocks[i];
      if (block.loopEnd == 0 || (i == first && isFirstALoop)) {
        if (State state = take(arriving_, i); isAny(state.threads)) runBlock(i, std::move(state));
        ++i;
      } else {
        runLoop(i, block.loopEnd);
        i = block.loopEnd;
      }
    }
  }

  // Round by round as long as each thread is known to stay or to leave, else until nothing new comes back.
  void runLoop(uint32_t head, uint32_t behind) {
    State state = take(arriving_, head);
    bool isOpen = false;
    for (int round = 0; isAny(state.threads); ++round) {
      State left = take(arriving_, behind);
      arriving_.emplace(head, state);
      runBlocks(head, behind, true);
      State again = take(arriving_, head);
      State leaving = take(arriving_, behind);
      isOpen = isOpen || round >= kMostRounds || isAny(both(again.threads, leaving.threads));
      arrive(arriving_, behind, std::move(left));
      arrive(arriving_, behind, std::move(leaving));
      if (isOpen && isAny(again.threads)) again = join(std::move(again), state);
      if (isOpen && again == state) return;
      state = std::move(again);
    }
  }

  void runBlock(uint32_t index, State state) {
    const ShaderBlock& block = module_.blocks[index];
    for (size_t i = block.first; i < block.end; ++i) run(module_.instructions[i], state);
    const auto& w = module_.instructions[block.end].words;
    switch (module_.instructions[block.end].op) {
      case kBranch:
        follow(index, w[1], state, state.threads);
        break;
      case kBranchConditional: {
        const Value condition = valueOf(w[1], state);
        for (const uint32_t taken : {1u, 0u}) {
          Mask threads = state.threads;
          for (size_t i = 0; i < threads.size(); ++i) {
            threads[i] = threads[i] && laneOf(condition, i).value_or(taken) == taken;
          }
          follow(index, taken ? w[2] : w[3], state, std::move(threads));
        }
        break;
      }
      case kSwitch:
        follow(index, w[2], state, state.threads);
        for (size_t i = 4; i < w.size(); i += 2) follow(index, w[i], state, state.threads);
        break;
      case kReturnValue:
        state.known[block.function] = valueOf(w[1], state);
        [[fallthrough]];
      case kReturn:
        arrive(returning_, block.function, std::move(state));
        break;
      case kUnreachable:
        break;
      default:
        throw std::runtime_error("an end of a block that is not known here");
    }
  }

  void follow(uint32_t from, uint32_t label, State state, Mask threads) {
    const uint32_t to = module_.blockOf.at(label);
    if (to <= from && from >= module_.blocks[to].loopEnd) throw std::runtime_error("a way back that is no loop's");
    for (size_t i = module_.blocks[to].first; i < module_.blocks[to].end && module_.instructions[i].op == kPhi; ++i) {
      const auto& w = module_.instructions[i].words;
      for (size_t way = 3; way < w.size(); way += 2) {
        if (module_.blockOf.at(w[way + 1]) == from) state.known[w[2]] = valueOf(w[way], state);
      }
    }
    state.threads = std::move(threads);
    arrive(arriving_, to, std::move(state));
  }

  void run(const Instruction& instruction, State& state) {
    const auto& w = instruction.words;
    switch (instruction.op) {
      case kVariable:
        pointers_[w[2]] = {w[2], {}};
        state.known.erase(w[2]);
        if (w.size() > 4) state.known[w[2]] = valueOf(w[4], state);
        break;
      case kAccessChain:
      case kInBoundsAccessChain:
        chain(w, state);
        break;
      case kLoad:
        values_[w[2]] = load(w[3], w, state);
        break;
      case kStore:
        store(w, state);
        break;
      case kControlBarrier:
        barrier(w, state);
        break;
      case kFunctionCall:
        callWith(w, state);
        break;
      case kSelect:
        values_[w[2]] = lanes_.select(valueOf(w[3], state), valueOf(w[4], state), valueOf(w[5], state));
        break;
      case kPtrAccessChain:
      case kCopyMemory:
        throw std::runtime_error("an instruction that is not known here");
      default:
        if (isAtomic(instruction.op)) note(w[instruction.op == kAtomicStore ? 1 : 3], Mode::kAtomic, w, state);
        if (isComputed(instruction.op)) {
          const Value second = w.size() > 4 ? valueOf(w[4], state) : valueOf(w[3], state);
          values_[w[2]] = lanes_.compute(static_cast<Op>(instruction.op), valueOf(w[3], state), second);
        }
    }
  }

  static bool isComputed(uint32_t op) { return op >= kIAdd && op <= kBitwiseAnd; }

  void chain(std::span<const uint32_t> w, const State& state) {
    const auto base = pointers_.find(w[3]);
    Pointer pointer = base == pointers_.end() ? Pointer{w[3], {}} : base->second;
    for (const uint32_t index : w.subspan(4)) pointer.path.push_back(valueOf(index, state));
    pointers_[w[2]] = std::move(pointer);
  }

  void note(uint32_t pointer, Mode mode, std::span<const uint32_t> w, State& state) {
    const auto place = pointers_.find(pointer);
    if (place == pointers_.end() || !module_.isShared(place->second.variable)) return;
    const Access access{place->second.variable, w.data(), mode, state.threads, place->second.path};
    for (auto& [since, accesses] : state.pending) accesses.insert(access);
  }

  Value load(uint32_t pointer, std::span<const uint32_t> w, State& state) {
    note(pointer, Mode::kLoad, w, state);
    const auto place = pointers_.find(pointer);
    const uint32_t variable = place == pointers_.end() ? pointer : place->second.variable;
    const auto input = module_.variables.find(variable);
    if (input != module_.variables.end() && input->second.builtIn == kLocalInvocationIndex) return ownIndices();
    const bool isWhole = place != pointers_.end() && place->second.path.empty();
    return isWhole ? valueOf(variable, state) : nullptr;
  }

  Value ownIndices() {
    Lanes indices(lanes_.threads());
    for (size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<uint32_t>(i);
    return lanes_.keep(std::move(indices));
  }

  void store(std::span<const uint32_t> w, State& state) {
    note(w[1], Mode::kStore, w, state);
    const auto place = pointers_.find(w[1]);
    if (place == pointers_.end() || !place->second.path.empty() || module_.isShared(place->second.variable)) return;
    const Value value = valueOf(w[2], state);
    if (value) {
      state.known[place->second.variable] = value;
    } else {
      state.known.erase(place->second.variable);
    }
  }

  void barrier(std::span<const uint32_t> w, State& state) {
    if (std::ranges::find(state.threads, false) != state.threads.end()) {
      races.insert("the barrier at word " + std::to_string(module_.wordOf(w.data())) +
                   ": some threads do not reach it");
    }
    const uint32_t scope = module_.constants.at(w[2]), semantics = module_.constants.at(w[3]);
    if (module_.constants.at(w[1]) != kScopeWorkgroup || (scope != kScopeWorkgroup && scope != kScopeDevice)) return;
    if ((semantics & kOrders) == 0 || (semantics & kWorkgroupMemory) == 0) return;
    end(state);
    state.pending = {{w.data(), {}}};
  }

  void callWith(std::span<const uint32_t> w, State& state) {
    const ShaderFunction& function = module_.functions.at(w[3]);
    for (size_t i = 0; i < function.parameters.size(); ++i) {
      const auto pointer = pointers_.find(w[4 + i]);
      if (pointer != pointers_.end()) {
        pointers_[function.parameters[i]] = pointer->second;
      } else {
        values_[function.parameters[i]] = valueOf(w[4 + i], state);
      }
    }
    state = call(function, std::move(state));
    values_[w[2]] = valueOf(function.id, state);
  }

  ShaderModule module_;
  LaneStore lanes_;
  // By ids. What an instruction gives is used behind it alone, before it is run again.
  std::map<uint32_t, Value> values_;
  std::map<uint32_t, Pointer> pointers_;
  std::map<uint32_t, State> arriving_;   // at blocks
  std::map<uint32_t, State> returning_;  // from functions
};

}  // namespace

std::set<std::string> findRaces(std::span<const uint32_t> spirv) { return Walk(spirv).races; }

}  // namespace froth::test
