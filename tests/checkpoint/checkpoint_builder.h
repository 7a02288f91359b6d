// Checkpoints made by hand, right and wrong ones: for tests of everything that reads them. Shares no code
// with the exporter. Users link ZLIB::ZLIB.
#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <zlib.h>

namespace froth {

// Joins pieces. (A literal + std::string would do, but gcc 12 warns of it without reason.)
template <class... Pieces>
std::string join(const Pieces&... pieces) {
  std::string joined;
  ((joined += pieces), ...);
  return joined;
}

template <class Number>
std::string packNumber(Number number) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

template <class Number>
std::string packNumbers(const std::vector<Number>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)};
}

// ---- Pickles, protocol 2: each function returns the opcodes that push one value.

inline std::string pickleText(const std::string& text) {
  return join("X", packNumber(static_cast<uint32_t>(text.size())), text);
}

inline std::string pickleInteger(int64_t value) { return join("\x8a\x08", packNumber(value)); }  // LONG1

inline std::string pickleGlobal(const std::string& module, const std::string& name) {
  return join("c", module, "\n", name, "\n");
}

inline std::string pickleTuple(const std::vector<std::string>& items) {
  std::string opcodes = "(";
  for (const std::string& item : items) {
    opcodes += item;
  }
  return opcodes + "t";
}

inline std::string pickleIntegers(const std::vector<int64_t>& values) {
  std::vector<std::string> items;
  for (const int64_t value : values) {
    items.push_back(pickleInteger(value));
  }
  return pickleTuple(items);
}

inline std::string pickleCall(const std::string& callable, const std::string& tuple) { return callable + tuple + "R"; }

inline std::string pickleDict(const std::vector<std::pair<std::string, std::string>>& values) {
  std::string opcodes = "}(";
  for (const auto& [key, value] : values) {
    opcodes += pickleText(key) + value;
  }
  return opcodes + "u";
}

inline std::string pickleProgram(const std::string& opcodes) { return join("\x80\x02", opcodes, "."); }

// A tensor as a pickle describes it.
struct TensorSpec {
  std::string storage;       // key of the storage
  int64_t storageCount = 0;  // [elements]
  std::vector<int64_t> shape, strides;
  int64_t offset = 0;
  std::string storageClass = "FloatStorage";
};

inline std::string pickleTensor(const TensorSpec& tensor) {
  const std::string id =
      pickleTuple({pickleText("storage"), pickleGlobal("torch", tensor.storageClass), pickleText(tensor.storage),
                   pickleText("cpu"), pickleInteger(tensor.storageCount)}) +
      "Q";
  const std::string hooks = pickleCall(pickleGlobal("collections", "OrderedDict"), ")");
  return pickleCall(pickleGlobal("torch._utils", "_rebuild_tensor_v2"),
                    pickleTuple({id, pickleInteger(tensor.offset), pickleIntegers(tensor.shape),
                                 pickleIntegers(tensor.strides), "\x89", hooks}));
}

// ---- Archives.

struct ZipEntrySpec {
  std::string name, bytes;
  uint16_t flags = 0x0808, method = 0;
  std::optional<uint32_t> crc32 = {};        // default: the right one
  std::optional<uint64_t> statedSize = {};   // in the directory; default: the right one
  std::optional<uint64_t> statedBegin = {};  // of the local header, in the directory; default: the right one
};

// `isZip64`: every size and offset of the directory lies in zip64 records.
inline std::string buildZip(const std::vector<ZipEntrySpec>& entries, bool isZip64 = false) {
  constexpr uint32_t kSaturated = 0xffffffff;
  std::string archive, directory;
  for (const ZipEntrySpec& entry : entries) {
    const auto crc = entry.crc32.value_or(
        static_cast<uint32_t>(crc32_z(0, reinterpret_cast<const uint8_t*>(entry.bytes.data()), entry.bytes.size())));
    const uint64_t begin = entry.statedBegin.value_or(archive.size());
    const uint64_t size = entry.statedSize.value_or(entry.bytes.size());
    const auto shortSize = isZip64 ? kSaturated : static_cast<uint32_t>(size);
    const auto nameSize = static_cast<uint16_t>(entry.name.size());
    const std::string zip64 =
        isZip64 ? packNumbers<uint16_t>({1, 24}) + packNumbers<uint64_t>({size, size, begin}) : "";
    directory += "PK\x01\x02" + packNumbers<uint16_t>({0, 45, entry.flags, entry.method, 0, 0}) +
                 packNumbers<uint32_t>({crc, shortSize, shortSize}) +
                 packNumbers<uint16_t>({nameSize, static_cast<uint16_t>(zip64.size()), 0, 0, 0, 0, 0}) +
                 packNumber(isZip64 ? kSaturated : static_cast<uint32_t>(begin)) + entry.name + zip64;
    archive += "PK\x03\x04" + packNumbers<uint16_t>({45, entry.flags, entry.method, 0, 0}) +
               packNumbers<uint32_t>({0, 0, 0}) + packNumbers<uint16_t>({nameSize, 0}) + entry.name + entry.bytes;
  }
  const uint64_t begin = archive.size(), size = directory.size(), count = entries.size();
  archive += directory;
  if (isZip64) {
    const uint64_t record = archive.size();
    archive += "PK\x06\x06" + packNumber(uint64_t{44}) + packNumbers<uint16_t>({45, 45}) +
               packNumbers<uint32_t>({0, 0}) + packNumbers<uint64_t>({count, count, size, begin});
    archive += "PK\x06\x07" + packNumber(uint32_t{0}) + packNumber(record) + packNumber(uint32_t{1});
  }
  const auto shortCount = isZip64 ? uint16_t{0xffff} : static_cast<uint16_t>(count);
  return archive + "PK\x05\x06" + packNumbers<uint16_t>({0, 0, shortCount, shortCount}) +
         packNumbers<uint32_t>({isZip64 ? kSaturated : static_cast<uint32_t>(size),
                                isZip64 ? kSaturated : static_cast<uint32_t>(begin)}) +
         packNumber(uint16_t{0});
}

// ---- Checkpoints.

struct CheckpointSpec {
  std::string prefix = "model/";
  std::vector<std::pair<std::string, TensorSpec>> tensors;  // the dict, in its order
  std::map<std::string, std::string> storages;              // bytes by key
  std::optional<std::string> pickle = {};                   // instead of the dict of `tensors`

  TensorSpec& tensor(const std::string& key) {
    for (auto& [name, tensor] : tensors) {
      if (name == key) return tensor;
    }
    return tensors.emplace_back(key, TensorSpec{}).second;
  }
  // Sets a contiguous float32 tensor in a storage named like its key.
  void setFloats(const std::string& key, const std::vector<int64_t>& shape, const std::vector<float>& values);
};

inline std::vector<int64_t> contiguousStrides(const std::vector<int64_t>& shape) {
  std::vector<int64_t> strides(shape.size());
  int64_t next = 1;
  for (size_t i = shape.size(); i-- > 0; next *= shape[i]) {
    strides[i] = next;
  }
  return strides;
}

inline void CheckpointSpec::setFloats(const std::string& key, const std::vector<int64_t>& shape,
                                      const std::vector<float>& values) {
  tensor(key) = {key, static_cast<int64_t>(values.size()), shape, contiguousStrides(shape)};
  storages[key] = packNumbers(values);
}

inline std::vector<ZipEntrySpec> zipEntries(const CheckpointSpec& checkpoint) {
  std::vector<std::pair<std::string, std::string>> dict;
  for (const auto& [key, tensor] : checkpoint.tensors) {
    dict.emplace_back(key, pickleTensor(tensor));
  }
  std::vector<ZipEntrySpec> entries = {
      {checkpoint.prefix + "data.pkl", checkpoint.pickle.value_or(pickleProgram(pickleDict(dict)))},
      {checkpoint.prefix + "byteorder", "little"}};
  for (const auto& [key, bytes] : checkpoint.storages) {
    entries.push_back({checkpoint.prefix + "data/" + key, bytes});
  }
  entries.push_back({checkpoint.prefix + "version", "3\n"});
  return entries;
}

inline std::string buildCheckpoint(const CheckpointSpec& checkpoint) { return buildZip(zipEntries(checkpoint)); }

// A right one: every element of a tensor is another number, all of them exact in float16 and bfloat16 too for
// small counts.
inline CheckpointSpec sampleCheckpoint(int64_t cells = 2, int64_t details = 3, int64_t lobes = 2) {
  CheckpointSpec checkpoint;
  const auto set = [&](const std::string& key, const std::vector<int64_t>& shape, float first) {
    int64_t count = 1;
    for (const int64_t size : shape) count *= size;
    std::vector<float> values(static_cast<size_t>(count));
    for (size_t i = 0; i < values.size(); ++i) {
      values[i] = first + static_cast<float>(i) / 64;
    }
    checkpoint.setFloats(key, shape, values);
  };
  set("points", {cells, 3}, -1);
  set("density", {cells}, 0.5f);
  set("radii", {cells}, 0.25f);
  set("quaternions", {cells, 4}, 1);
  set("texel_sites", {cells, details, 2}, -0.5f);
  set("texel_sv_axis", {cells, details, 3 * lobes}, 1);
  set("texel_sv_rgb", {cells, details, 3 * lobes}, -1);
  set("texel_height", {cells, details}, -0.125f);
  return checkpoint;
}

}  // namespace froth
