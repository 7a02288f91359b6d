#include "foam/checkpoint/pickle.h"

#include <map>
#include <utility>

#include "foam/checkpoint/pickle_machine.h"

namespace froth {
namespace {

// Ten tensors take a kilobyte. Every opcode makes at most one value, so this bounds memory too.
constexpr size_t kMaxPickleBytes = 256 << 10;

constexpr uint8_t kMinProtocol = 2, kMaxProtocol = 5;

}  // namespace

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
    case Opcode::kStop:
      stopped_ = true;
      return;
    case Opcode::kMark:
      marks_.push_back(stack_.size());
      return;
    case Opcode::kFrame:
      takeNumber<uint64_t>();
      return;  // a hint for buffering
    case Opcode::kProto:
      if (const auto protocol = takeNumber<uint8_t>(); protocol < kMinProtocol || protocol > kMaxProtocol) {
        fail("pickle protocol {}, expected {} to {}", protocol, kMinProtocol, kMaxProtocol);
      }
      return;
    default:
      fail("opcode {:#04x} {}, which a dict of tensors never needs", code, refusedOpcodeName(code));
  }
}

bool PickleMachine::stepScalar(Opcode opcode) {
  switch (opcode) {
    case Opcode::kNone:
      push(None{});
      return true;
    case Opcode::kNewTrue:
      push(true);
      return true;
    case Opcode::kNewFalse:
      push(false);
      return true;
    case Opcode::kBinInt:
      push(int64_t{takeNumber<int32_t>()});
      return true;
    case Opcode::kBinInt1:
      push(int64_t{takeNumber<uint8_t>()});
      return true;
    case Opcode::kBinInt2:
      push(int64_t{takeNumber<uint16_t>()});
      return true;
    case Opcode::kLong1:
      push(takeLong());
      return true;
    case Opcode::kBinFloat:
      take(sizeof(double)), push(None{});
      return true;
    case Opcode::kShortBinUnicode:
      push(takeText(takeNumber<uint8_t>()));
      return true;
    case Opcode::kBinUnicode:
      push(takeText(takeNumber<uint32_t>()));
      return true;
    case Opcode::kBinUnicode8:
      push(takeText(takeNumber<uint64_t>()));
      return true;
    default:
      return false;
  }
}

bool PickleMachine::stepContainer(Opcode opcode) {
  switch (opcode) {
    case Opcode::kEmptyTuple:
      push(Tuple{});
      return true;
    case Opcode::kTuple:
      push(Tuple{popToMark()});
      return true;
    case Opcode::kTuple1:
      push(Tuple{popTuple(1)});
      return true;
    case Opcode::kTuple2:
      push(Tuple{popTuple(2)});
      return true;
    case Opcode::kTuple3:
      push(Tuple{popTuple(3)});
      return true;
    case Opcode::kEmptyList:
      push(List{});
      return true;
    case Opcode::kAppend:
      pop(), appendTo(stack_.empty() ? 0 : stack_.back());
      return true;
    case Opcode::kAppends:
      popToMark(), appendTo(stack_.empty() ? 0 : stack_.back());
      return true;
    case Opcode::kEmptyDict:
      push(Dict{});
      return true;
    case Opcode::kSetItem:
      setItems(popTuple(2));
      return true;
    case Opcode::kSetItems:
      setItems(popToMark());
      return true;
    default:
      return false;
  }
}

bool PickleMachine::stepMemo(Opcode opcode) {
  switch (opcode) {
    case Opcode::kBinPut:
      put(takeNumber<uint8_t>());
      return true;
    case Opcode::kLongBinPut:
      put(takeNumber<uint32_t>());
      return true;
    case Opcode::kMemoize:
      put(static_cast<uint32_t>(memo_.size()));
      return true;
    case Opcode::kBinGet:
      get(takeNumber<uint8_t>());
      return true;
    case Opcode::kLongBinGet:
      get(takeNumber<uint32_t>());
      return true;
    default:
      return false;
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
    case Opcode::kReduce:
      call();
      return true;
    case Opcode::kBinPersId:
      loadStorage();
      return true;
    default:
      return false;
  }
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

Result<std::vector<PickledEntry>> readPickledTensors(const NamedBytes& pickle) { return PickleMachine(pickle).run(); }

}  // namespace froth
