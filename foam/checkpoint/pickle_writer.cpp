#include "foam/checkpoint/pickle_writer.h"

#include <functional>
#include <map>
#include <utility>

#include "foam/checkpoint/pickle_opcodes.h"

namespace froth {
namespace {

// Python's pickler remembers every string, tuple, dict and global under the next number, and refers to
// globals and interned strings that come again.
class PickleWriter {
 public:
  std::string write(std::span<const TensorDeclaration> tensors);

 private:
  void op(Opcode opcode) { text_ += static_cast<char>(opcode); }
  void number(uint64_t value, int bytes);
  void remember();
  bool recall(std::string_view name);  // false: met for the first time, write it and then remember it
  void string(std::string_view value);
  void internedString(std::string_view value);
  void global(std::string_view module, std::string_view name);
  void integer(uint64_t value);
  void tuple(std::span<const uint64_t> values);
  void tensor(const TensorDeclaration& declaration, size_t storage);

  std::string text_;
  uint8_t memoSize_ = 0;
  std::map<std::string, uint8_t, std::less<>> memo_;
};

std::string PickleWriter::write(std::span<const TensorDeclaration> tensors) {
  constexpr uint64_t kProtocol = 2;
  op(Opcode::kProto), number(kProtocol, 1);
  op(Opcode::kEmptyDict), remember();
  op(Opcode::kMark);
  for (size_t i = 0; i < tensors.size(); ++i) {
    string(tensors[i].key);
    tensor(tensors[i], i);
  }
  op(Opcode::kSetItems);
  op(Opcode::kStop);
  return std::move(text_);
}

void PickleWriter::tensor(const TensorDeclaration& declaration, size_t storage) {
  uint64_t count = 1;
  std::vector<uint64_t> strides(declaration.shape.size());
  for (size_t i = strides.size(); i-- > 0; count *= declaration.shape[i]) {
    strides[i] = count;
  }
  global("torch._utils", "_rebuild_tensor_v2");
  op(Opcode::kMark);
  op(Opcode::kMark);
  internedString("storage");
  global("torch", declaration.type == ScalarType::kInt ? "IntStorage" : "FloatStorage");
  string(std::to_string(storage));
  internedString("cpu");
  integer(count);
  op(Opcode::kTuple), remember();
  op(Opcode::kBinPersId);
  integer(0);  // offset in the storage
  tuple(declaration.shape);
  tuple(strides);
  op(Opcode::kNewFalse);  // needs no gradient
  global("collections", "OrderedDict");
  op(Opcode::kEmptyTuple), op(Opcode::kReduce), remember();  // no hooks
  op(Opcode::kTuple), remember();
  op(Opcode::kReduce), remember();
}

void PickleWriter::number(uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) {
    text_ += static_cast<char>(value >> 8 * i);
  }
}

void PickleWriter::remember() { op(Opcode::kBinPut), number(memoSize_++, 1); }

bool PickleWriter::recall(std::string_view name) {
  const auto known = memo_.find(name);
  if (known == memo_.end()) {
    memo_.emplace(name, memoSize_);
    return false;
  }
  op(Opcode::kBinGet), number(known->second, 1);
  return true;
}

void PickleWriter::string(std::string_view value) {
  op(Opcode::kBinUnicode), number(value.size(), 4);
  text_ += value;
  remember();
}

void PickleWriter::internedString(std::string_view value) {
  if (!recall(value)) {
    string(value);
  }
}

void PickleWriter::global(std::string_view module, std::string_view name) {
  const std::string lines = std::string(module).append("\n").append(name).append("\n");
  if (!recall(lines)) {
    op(Opcode::kGlobal);
    text_ += lines;
    remember();
  }
}

// The shortest of four forms; the last is two's complement, so a set top bit needs one byte more.
void PickleWriter::integer(uint64_t value) {
  if (value <= UINT8_MAX) {
    op(Opcode::kBinInt1), number(value, 1);
  } else if (value <= UINT16_MAX) {
    op(Opcode::kBinInt2), number(value, 2);
  } else if (value <= INT32_MAX) {
    op(Opcode::kBinInt), number(value, 4);
  } else {
    int bytes = 1;
    while (value >> (8 * bytes - 1) != 0) {
      ++bytes;
    }
    op(Opcode::kLong1), number(static_cast<uint64_t>(bytes), 1), number(value, bytes);
  }
}

void PickleWriter::tuple(std::span<const uint64_t> values) {
  constexpr Opcode kTuples[] = {Opcode::kTuple1, Opcode::kTuple2, Opcode::kTuple3};
  for (const uint64_t value : values) {
    integer(value);
  }
  op(kTuples[values.size() - 1]), remember();
}

}  // namespace

std::string pickleTensors(std::span<const TensorDeclaration> tensors) { return PickleWriter().write(tensors); }

}  // namespace froth
