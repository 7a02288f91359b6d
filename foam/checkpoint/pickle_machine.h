// The machine that runs a pickle: its values, its stack, and what each opcode may do. Internal to pickle.h.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "foam/checkpoint/bad_input.h"
#include "foam/checkpoint/little_endian.h"
#include "foam/checkpoint/pickle.h"
#include "foam/checkpoint/pickle_opcodes.h"

namespace froth {

// Programs fail in any of a hundred places: each notes its error and returns, and run() stops at the first.
class PickleMachine {
 public:
  explicit PickleMachine(const NamedBytes& pickle) : pickle_(pickle) {}

  Result<std::vector<PickledEntry>> run();

 private:
  using Ref = uint32_t;  // index of a value; values live until the program ends, so cycles and depth do no harm

  struct None {};  // also floats, which nothing reads
  struct Tuple {
    std::vector<Ref> items;
  };
  struct List {};  // nothing reads what is in one
  struct Dict {
    std::vector<std::pair<Ref, Ref>> items;
  };
  enum class Callable { kOrderedDict, kRebuildTensor, kStorage };
  struct Global {
    Callable callable;
    ScalarType type = ScalarType::kFloat;  // of a storage class
  };
  struct Storage {
    ScalarType type;
    std::string_view key;
    uint64_t count;
  };
  using Value = std::variant<None, bool, int64_t, std::string_view, Tuple, List, Dict, Global, Storage, PickledTensor>;
  struct KnownGlobal {
    std::string_view module, name;
    Global global;
  };
  static const KnownGlobal kKnownGlobals[12];

  template <class... Args>
  void fail(fmt::format_string<Args...> format, Args&&... args) {
    if (!error_) {
      error_ = badInput(pickle_.name, "byte {}: {}; do not trust this file, get the checkpoint again", opcodeOffset_,
                        fmt::format(format, std::forward<Args>(args)...));
    }
  }

  void step();
  bool stepScalar(Opcode opcode);
  bool stepContainer(Opcode opcode);
  bool stepMemo(Opcode opcode);
  bool stepCall(Opcode opcode);

  // Operands. After a failure they return zeros and empties, which every caller can handle.
  std::span<const uint8_t> take(uint64_t size);
  template <class Number>
  Number takeNumber();
  std::string_view takeText(uint64_t size);
  std::string_view takeLine();
  int64_t takeLong();

  // Stack.
  void push(Value value);
  Ref pop();
  std::vector<Ref> popToMark();
  std::vector<Ref> popTuple(size_t count);
  template <class Kind>
  Kind* as(Ref ref) {
    return std::get_if<Kind>(&values_[ref]);
  }

  void put(uint32_t slot);
  void get(uint32_t slot);
  void setItems(const std::vector<Ref>& items);
  void appendTo(Ref list);
  void pushGlobal(std::string_view module, std::string_view name);
  void call();
  void rebuildTensor(const Tuple& arguments);
  void loadStorage();
  std::string describe(Ref ref);
  std::optional<std::vector<uint64_t>> asCounts(Ref ref);
  Result<std::vector<PickledEntry>> collectTensors();

  const NamedBytes& pickle_;
  size_t cursor_ = 0, opcodeOffset_ = 0;
  bool stopped_ = false;
  std::optional<Error> error_;
  std::vector<Value> values_{None{}};  // [0] stands in wherever a value is missing after a failure
  std::vector<Ref> stack_;
  std::vector<size_t> marks_;     // heights of the stack
  std::map<uint32_t, Ref> memo_;  // ordered: hostile slots cannot make it slow
};

template <class Number>
Number PickleMachine::takeNumber() {
  const auto bytes = take(sizeof(Number));
  return bytes.empty() ? Number{} : loadLittleEndian<Number>(bytes.data());
}

}  // namespace froth
