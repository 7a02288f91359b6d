#include "foam/checkpoint/pickle_machine.h"

#include <algorithm>
#include <iterator>

namespace froth {

constexpr PickleMachine::KnownGlobal PickleMachine::kKnownGlobals[] = {
    {"collections", "OrderedDict", {Callable::kOrderedDict}},
    {"torch._utils", "_rebuild_tensor_v2", {Callable::kRebuildTensor}},
    {"torch", "FloatStorage", {Callable::kStorage, ScalarType::kFloat}},
    {"torch", "HalfStorage", {Callable::kStorage, ScalarType::kHalf}},
    {"torch", "DoubleStorage", {Callable::kStorage, ScalarType::kDouble}},
    {"torch", "BFloat16Storage", {Callable::kStorage, ScalarType::kBFloat16}},
    {"torch", "LongStorage", {Callable::kStorage, ScalarType::kLong}},
    {"torch", "IntStorage", {Callable::kStorage, ScalarType::kInt}},
    {"torch", "ShortStorage", {Callable::kStorage, ScalarType::kShort}},
    {"torch", "CharStorage", {Callable::kStorage, ScalarType::kChar}},
    {"torch", "ByteStorage", {Callable::kStorage, ScalarType::kByte}},
    {"torch", "BoolStorage", {Callable::kStorage, ScalarType::kBool}},
};

std::span<const uint8_t> PickleMachine::take(uint64_t size) {
  if (size > pickle_.bytes.size() - cursor_) {
    fail("{} bytes expected, {} are left: the pickle is cut short", size, pickle_.bytes.size() - cursor_);
    return {};
  }
  cursor_ += size;
  return pickle_.bytes.subspan(cursor_ - size, size);
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

PickleMachine::Ref PickleMachine::pop() {
  if (stack_.size() <= (marks_.empty() ? 0 : marks_.back())) {
    fail("the pickle takes more from its stack than it put there");
    return 0;
  }
  const Ref top = stack_.back();
  stack_.pop_back();
  return top;
}

std::vector<PickleMachine::Ref> PickleMachine::popToMark() {
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

std::vector<PickleMachine::Ref> PickleMachine::popTuple(size_t count) {
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
    fail("_rebuild_tensor_v2 with {} arguments, expected {} or {}", arguments.items.size(), kMinArguments,
         kMaxArguments);
    return;
  }
  const auto* storage = as<Storage>(arguments.items[0]);
  const auto* offset = as<int64_t>(arguments.items[1]);
  auto shape = asCounts(arguments.items[2]);
  auto strides = asCounts(arguments.items[3]);
  if (!storage || !offset || *offset < 0 || !shape || !strides || shape->size() != strides->size()) {
    const auto* key = stack_.empty() ? nullptr : as<std::string_view>(stack_.back());  // of the dict's entry
    fail(
        "tensor {}: offset {}, sizes {}, strides {}; it needs a storage, an offset >= 0 and equally many sizes and "
        "strides >= 0, at most {}",
        key ? quoted(*key) : "without a name", describe(arguments.items[1]), describe(arguments.items[2]),
        describe(arguments.items[3]), kMaxTensorRank);
    return;
  }
  push(PickledTensor{storage->type, storage->key, storage->count, static_cast<uint64_t>(*offset), *std::move(shape),
                     *std::move(strides)});
}

// An integer or a tuple of integers, for messages.
std::string PickleMachine::describe(Ref ref) {
  if (const auto* number = as<int64_t>(ref)) return fmt::format("{}", *number);
  const auto* tuple = as<Tuple>(ref);
  if (!tuple || tuple->items.size() > kMaxTensorRank) return "(not a short tuple)";
  std::string text;
  for (const Ref item : tuple->items) {
    const auto* number = as<int64_t>(item);
    text += fmt::format("{}{}", text.empty() ? "" : ", ", number ? fmt::format("{}", *number) : "?");
  }
  return "[" + text + "]";
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

}  // namespace froth
