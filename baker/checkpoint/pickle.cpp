#include "baker/checkpoint/pickle.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "baker/checkpoint/little_endian.h"
#include "baker/checkpoint/pickle_opcodes.h"
#include "baker/checkpoint/pickle_values.h"

namespace froth {
namespace {

// Ten tensors take a kilobyte. Every opcode makes at most one value, so this bounds memory too.
constexpr size_t kMaxPickleBytes = 256 << 10;

constexpr uint8_t kMinProtocol = 2, kMaxProtocol = 5;

// Programs fail in any of a hundred places: each notes its error and returns, and run() stops at the first.
class PickleMachine {
 public:
  explicit PickleMachine(const NamedBytes& pickle) : pickle_(pickle) {}

  Result<std::vector<PickledEntry>> run();

 private:
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
  std::optional<std::vector<uint64_t>> asCounts(Ref ref);
  Result<std::vector<PickledEntry>> collectTensors();

  const NamedBytes& pickle_;
  size_t cursor_ = 0, opcodeOffset_ = 0;
  bool stopped_ = false;
  std::optional<Error> error_;
  std::vector<Value> values_{None{}};  // [0] stands in wherever a value is missing after a failure
  std::vector<Ref> stack_;
  std::vector<size_t> marks_;  // heights of the stack
  std::map<uint32_t, Ref> memo_;  // ordered: hostile slots cannot make it slow
};

Result<std::vector<PickledEntry>> PickleMachine::run() {
  if (pickle_.bytes.size() > kMaxPickleBytes) {
    return badInput(pickle_.name, "{} bytes, but a dict of tensors needs at most {}; save only the foam's tensors",
                    pickle_.bytes.size(), kMaxPickleBytes);
  }
  if (pickle_.bytes.empty() || Opcode{pickle_.bytes[0]} != Opcode::kProto) {
    fail("no pickle of protocol {} to {} begins here", kMinProtocol, kMaxProtocol);
  }
  while (!error_ && !stopped_) {
    step();
  }
  if (error_) {
    return *std::move(error_);
  }
  return collectTensors();
}

void PickleMachine::step() {
  opcodeOffset_ = cursor_;
  const auto code = takeNumber<uint8_t>();
  const Opcode opcode{code};
  if (error_ || stepScalar(opcode) || stepContainer(opcode) || stepMemo(opcode) || stepCall(opcode)) {
    return;
  }
  switch (opcode) {
    case Opcode::kStop: stopped_ = true; return;
    case Opcode::kMark: marks_.push_back(stack_.size()); return;
    case Opcode::kFrame: takeNumber<uint64_t>(); return;  // a hint for buffering
    case Opcode::kProto:
      if (const auto protocol = takeNumber<uint8_t>(); protocol < kMinProtocol || protocol > kMaxProtocol) {
        fail("pickle protocol {}, expected {} to {}", protocol, kMinProtocol, kMaxProtocol);
      }
      return;
    default: fail("opcode {:#04x} {}, which a dict of tensors never needs", code, refusedOpcodeName(code));
  }
}

bool PickleMachine::stepScalar(Opcode opcode) {
  switch (opcode) {
    case Opcode::kNone: push(None{}); return true;
    case Opcode::kNewTrue: push(true); return true;
    case Opcode::kNewFalse: push(false); return true;
    case Opcode::kBinInt: push(int64_t{takeNumber<int32_t>()}); return true;
    case Opcode::kBinInt1: push(int64_t{takeNumber<uint8_t>()}); return true;
    case Opcode::kBinInt2: push(int64_t{takeNumber<uint16_t>()}); return true;
    case Opcode::kLong1: push(takeLong()); return true;
    case Opcode::kBinFloat: take(sizeof(double)), push(None{}); return true;
    case Opcode::kShortBinUnicode: push(takeText(takeNumber<uint8_t>())); return true;
    case Opcode::kBinUnicode: push(takeText(takeNumber<uint32_t>())); return true;
    case Opcode::kBinUnicode8: push(takeText(takeNumber<uint64_t>())); return true;
    default: return false;
  }
}

bool PickleMachine::stepContainer(Opcode opcode) {
  switch (opcode) {
    case Opcode::kEmptyTuple: push(Tuple{}); return true;
    case Opcode::kTuple: push(Tuple{popToMark()}); return true;
    case Opcode::kTuple1: push(Tuple{popTuple(1)}); return true;
    case Opcode::kTuple2: push(Tuple{popTuple(2)}); return true;
    case Opcode::kTuple3: push(Tuple{popTuple(3)}); return true;
    case Opcode::kEmptyList: push(List{}); return true;
    case Opcode::kAppend: pop(), appendTo(stack_.empty() ? 0 : stack_.back()); return true;
    case Opcode::kAppends: popToMark(), appendTo(stack_.empty() ? 0 : stack_.back()); return true;
    case Opcode::kEmptyDict: push(Dict{}); return true;
    case Opcode::kSetItem: setItems(popTuple(2)); return true;
    case Opcode::kSetItems: setItems(popToMark()); return true;
    default: return false;
  }
}

bool PickleMachine::stepMemo(Opcode opcode) {
  switch (opcode) {
    case Opcode::kBinPut: put(takeNumber<uint8_t>()); return true;
    case Opcode::kLongBinPut: put(takeNumber<uint32_t>()); return true;
    case Opcode::kMemoize: put(static_cast<uint32_t>(memo_.size())); return true;
    case Opcode::kBinGet: get(takeNumber<uint8_t>()); return true;
    case Opcode::kLongBinGet: get(takeNumber<uint32_t>()); return true;
    default: return false;
  }
}

bool PickleMachine::stepCall(Opcode opcode) {
  switch (opcode) {
    case Opcode::kGlobal: {
      const std::string_view module = takeLine();
      pushGlobal(module, takeLine());
      return true;
    }
    case Opcode::kStackGlobal: {
      const std::vector<Ref> names = popTuple(2);
      const auto* module = as<std::string_view>(names[0]);
      const auto* name = as<std::string_view>(names[1]);
      if (module && name) {
        pushGlobal(*module, *name);
      } else {
        fail("STACK_GLOBAL without two names");
      }
      return true;
    }
    case Opcode::kReduce: call(); return true;
    case Opcode::kBinPersId: loadStorage(); return true;
    default: return false;
  }
}

std::span<const uint8_t> PickleMachine::take(uint64_t size) {
  if (size > pickle_.bytes.size() - cursor_) {
    fail("{} bytes expected, {} are left: the pickle is cut short", size, pickle_.bytes.size() - cursor_);
    return {};
  }
  cursor_ += size;
  return pickle_.bytes.subspan(cursor_ - size, size);
}

template <class Number>
Number PickleMachine::takeNumber() {
  const auto bytes = take(sizeof(Number));
  return bytes.empty() ? Number{} : loadLittleEndian<Number>(bytes.data());
}

std::string_view PickleMachine::takeText(uint64_t size) {
  const auto bytes = take(size);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string_view PickleMachine::takeLine() {
  const auto rest = pickle_.bytes.subspan(cursor_);
  const auto end = std::find(rest.begin(), rest.end(), uint8_t{'\n'});
  if (end == rest.end()) {
    fail("a name without an end");
    return {};
  }
  const std::string_view line = takeText(static_cast<uint64_t>(end - rest.begin()));
  ++cursor_;
  return line;
}

// Two's complement of any length, little-endian; counts of elements fit into eight bytes.
int64_t PickleMachine::takeLong() {
  const auto bytes = take(takeNumber<uint8_t>());
  if (bytes.size() > sizeof(int64_t)) {
    fail("an integer of {} bytes, expected at most {}", bytes.size(), sizeof(int64_t));
    return 0;
  }
  uint64_t number = !bytes.empty() && bytes.back() & 0x80 ? ~uint64_t{0} : 0;
  for (size_t i = bytes.size(); i-- > 0;) {
    number = number << 8 | bytes[i];
  }
  return static_cast<int64_t>(number);
}

void PickleMachine::push(Value value) {
  stack_.push_back(static_cast<Ref>(values_.size()));
  values_.push_back(std::move(value));
}

Ref PickleMachine::pop() {
  if (stack_.size() <= (marks_.empty() ? 0 : marks_.back())) {
    fail("the pickle takes more from its stack than it put there");
    return 0;
  }
  const Ref top = stack_.back();
  stack_.pop_back();
  return top;
}

std::vector<Ref> PickleMachine::popToMark() {
  if (marks_.empty()) {
    fail("the pickle looks for a mark that it never set");
    return {};
  }
  const auto begin = stack_.begin() + static_cast<ptrdiff_t>(marks_.back());
  std::vector<Ref> items(begin, stack_.end());
  stack_.erase(begin, stack_.end());
  marks_.pop_back();
  return items;
}

std::vector<Ref> PickleMachine::popTuple(size_t count) {
  std::vector<Ref> items(count);
  for (size_t i = count; i-- > 0;) {
    items[i] = pop();
  }
  return items;
}

void PickleMachine::put(uint32_t slot) {
  if (stack_.empty()) {
    fail("nothing on the stack to remember");
    return;
  }
  memo_[slot] = stack_.back();
}

void PickleMachine::get(uint32_t slot) {
  const auto found = memo_.find(slot);
  if (found == memo_.end()) {
    fail("memo {} was never set", slot);
    return;
  }
  stack_.push_back(found->second);
}

void PickleMachine::appendTo(Ref list) {
  if (!as<List>(list)) {
    fail("items appended to something that is not a list");
  }
}

void PickleMachine::setItems(const std::vector<Ref>& items) {
  Dict* dict = stack_.empty() ? nullptr : as<Dict>(stack_.back());
  if (!dict || items.size() % 2 != 0) {
    fail("{} values stored as keys and values of {}", items.size(), dict ? "a dict" : "something that is not a dict");
    return;
  }
  for (size_t i = 0; i < items.size(); i += 2) {
    dict->items.emplace_back(items[i], items[i + 1]);
  }
}

void PickleMachine::pushGlobal(std::string_view module, std::string_view name) {
  const auto known = std::find_if(std::begin(kKnownGlobals), std::end(kKnownGlobals),
                                  [&](const KnownGlobal& g) { return g.module == module && g.name == name; });
  if (known == std::end(kKnownGlobals)) {
    fail("the pickle wants to call {} of module {}, which a dict of tensors never needs", quoted(name), quoted(module));
    return;
  }
  push(known->global);
}

void PickleMachine::call() {
  const Ref arguments = pop(), callable = pop();
  const auto* global = as<Global>(callable);
  const auto* tuple = as<Tuple>(arguments);
  if (!global || !tuple) {
    fail("REDUCE without a function and a tuple");
  } else if (global->callable == Callable::kOrderedDict && tuple->items.empty()) {
    push(Dict{});
  } else if (global->callable == Callable::kRebuildTensor) {
    rebuildTensor(*tuple);
  } else {
    fail("the pickle calls a {} with {} arguments", global->callable == Callable::kStorage ? "storage class" : "dict",
         tuple->items.size());
  }
}

// (storage, offset, shape, strides, requires_grad, backward_hooks[, metadata])
void PickleMachine::rebuildTensor(const Tuple& arguments) {
  constexpr size_t kMinArguments = 6, kMaxArguments = 7;
  if (arguments.items.size() < kMinArguments || arguments.items.size() > kMaxArguments) {
    fail("_rebuild_tensor_v2 with {} arguments, expected {} or {}", arguments.items.size(), kMinArguments, kMaxArguments);
    return;
  }
  const auto* storage = as<Storage>(arguments.items[0]);
  const auto* offset = as<int64_t>(arguments.items[1]);
  auto shape = asCounts(arguments.items[2]);
  auto strides = asCounts(arguments.items[3]);
  if (!storage || !offset || *offset < 0 || !shape || !strides || shape->size() != strides->size()) {
    fail("a tensor needs a storage, an offset >= 0 and equally many sizes and strides >= 0, at most {}", kMaxTensorRank);
    return;
  }
  push(PickledTensor{storage->type, storage->key, storage->count, static_cast<uint64_t>(*offset), *std::move(shape),
                     *std::move(strides)});
}

std::optional<std::vector<uint64_t>> PickleMachine::asCounts(Ref ref) {
  const auto* tuple = as<Tuple>(ref);
  if (!tuple || tuple->items.size() > kMaxTensorRank) {
    return std::nullopt;
  }
  std::vector<uint64_t> counts;
  for (const Ref item : tuple->items) {
    const auto* number = as<int64_t>(item);
    if (!number || *number < 0) {
      return std::nullopt;
    }
    counts.push_back(static_cast<uint64_t>(*number));
  }
  return counts;
}

// The one persistent id that torch writes: ('storage', class, key, location, element count).
void PickleMachine::loadStorage() {
  const auto* id = as<Tuple>(pop());
  if (!id || id->items.size() != 5) {
    fail("a persistent id that is not torch's tuple of five");
    return;
  }
  const auto* tag = as<std::string_view>(id->items[0]);
  const auto* global = as<Global>(id->items[1]);
  const auto* key = as<std::string_view>(id->items[2]);
  const auto* count = as<int64_t>(id->items[4]);
  if (!tag || *tag != "storage" || !global || global->callable != Callable::kStorage || !key || !count || *count < 0) {
    fail("a persistent id that is not ('storage', class, key, location, count >= 0)");
    return;
  }
  push(Storage{global->type, *key, static_cast<uint64_t>(*count)});
}

Result<std::vector<PickledEntry>> PickleMachine::collectTensors() {
  const Dict* dict = stack_.empty() ? nullptr : as<Dict>(stack_.back());
  if (!dict) {
    return badInput(pickle_.name, "holds no dict at its top; save a dict of tensors");
  }
  std::vector<PickledEntry> entries;
  std::map<std::string_view, size_t> places;
  for (const auto& [keyRef, valueRef] : dict->items) {
    const auto* key = as<std::string_view>(keyRef);
    const auto* tensor = as<PickledTensor>(valueRef);
    if (!key || !tensor) {
      continue;
    }
    const auto [place, isNew] = places.emplace(*key, entries.size());
    if (isNew) {
      entries.push_back({*key, *tensor});
    } else {
      entries[place->second].tensor = *tensor;  // as in Python, the last one stays
    }
  }
  return entries;
}

}  // namespace

Result<std::vector<PickledEntry>> readPickledTensors(const NamedBytes& pickle) { return PickleMachine(pickle).run(); }

}  // namespace froth
