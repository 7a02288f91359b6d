#include "foam/checkpoint/checkpoint_views.h"

#include <algorithm>
#include <set>

#include "foam/checkpoint/pickle.h"
#include "foam/checkpoint/zip_reader.h"

namespace froth {
namespace {

constexpr std::string_view kPickleName = "data.pkl";

// Where things lie in the archive.
struct Layout {
  ZipArchive archive;
  ZipMember pickle;
  std::string_view prefix;  // of every member's name: the pickle's folder with its slash, or nothing
};

std::string_view asText(std::span<const uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool isPickle(std::string_view name) {
  return name == kPickleName || name.ends_with(std::string("/").append(kPickleName));
}

Result<Layout> findLayout(const NamedBytes& file) {
  Result<ZipArchive> archive = readZipArchive(file);
  if (!archive) {
    return archive.error();
  }
  Layout layout;
  layout.archive = std::move(*archive);
  for (const ZipMember& member : layout.archive.members) {
    if (!isPickle(member.name)) {
      continue;
    }
    if (isPickle(layout.pickle.name)) {
      return badInput(file.name, "two pickles, {} and {}; expected one", quoted(layout.pickle.name),
                      quoted(member.name));
    }
    layout.pickle = member;
    layout.prefix = member.name.substr(0, member.name.size() - kPickleName.size());
  }
  if (!isPickle(layout.pickle.name)) {
    return badInput(file.name, "a ZIP archive without data.pkl is no checkpoint; save the foam's dict with torch.save");
  }
  const ZipMember* byteOrder = layout.archive.find(std::string(layout.prefix) + "byteorder");
  if (byteOrder && asText(byteOrder->bytes) != "little") {
    return badInput(file.name, "byte order {}, expected 'little'; save the checkpoint on a little-endian machine",
                    quoted(asText(byteOrder->bytes)));
  }
  return layout;
}

Result<TensorView> viewEntry(const NamedBytes& file, const Layout& layout, const PickledEntry& entry,
                             std::set<const ZipMember*>& checked, const Progress& progress) {
  const ZipMember* member = layout.archive.find(fmt::format("{}data/{}", layout.prefix, entry.tensor.storage));
  if (!member) {
    return badInput(file.name, "tensor '{}': its storage {} is not in the archive; copy or save the checkpoint again",
                    entry.key, quoted(entry.tensor.storage));
  }
  Result<TensorView> view = viewTensor(file.name, entry.key, entry.tensor, member->bytes);
  if (view && checked.insert(member).second) {
    if (Status status = checkZipMember(file, *member, progress); !status) {
      return status.error();
    }
  }
  return view;
}

}  // namespace

Result<CheckpointViews> viewCheckpoint(const NamedBytes& file, const Progress& progress) {
  const Result<Layout> layout = findLayout(file);
  if (!layout) {
    return layout.error();
  }
  if (Status status = checkZipMember(file, layout->pickle); !status) {
    return status.error();
  }
  const auto entries = readPickledTensors({layout->pickle.bytes, file.name + ": data.pkl"});
  if (!entries) {
    return entries.error();
  }

  CheckpointViews views;
  std::set<const ZipMember*> checked;  // storages can be shared
  std::string missing;
  for (size_t i = 0; i < kParameterCount; ++i) {
    const auto entry = std::find_if(entries->begin(), entries->end(),
                                    [&](const PickledEntry& e) { return e.key == kParameterKeys[i]; });
    if (entry == entries->end()) {
      missing += fmt::format("{}'{}'", missing.empty() ? "" : ", ", kParameterKeys[i]);
      continue;
    }
    Result<TensorView> view = viewEntry(file, *layout, *entry, checked, progress);
    if (!view) {
      return view.error();
    }
    views[i] = std::move(*view);
  }
  if (!missing.empty()) {
    return badInput(file.name, "the dict lacks the tensors {}; name the checkpoint of a Power Foam", missing);
  }
  return views;
}

}  // namespace froth
