#include "base/atomic_file.h"

#include "base/temporary_file.h"

namespace froth {

Status checkTarget(const std::filesystem::path& path, WriteProtected isProtected) {
  std::error_code ignored;
  const std::filesystem::file_status old = std::filesystem::status(path, ignored);
  if (!std::filesystem::exists(old)) return {};
  if (!std::filesystem::is_regular_file(old)) {
    return makeError(ErrorKind::kIo, "%s: exists and is no regular file; give another name", path.c_str());
  }
  constexpr auto kWrite =
      std::filesystem::perms::owner_write | std::filesystem::perms::group_write | std::filesystem::perms::others_write;
  const bool canBeWritten = (old.permissions() & kWrite) != std::filesystem::perms::none;
  if (canBeWritten || isProtected == WriteProtected::kReplace) return {};
  return makeError(ErrorKind::kIo, "%s: is write-protected; make it writable, force it, or give another name",
                   path.c_str());
}

Status streamFileAtomically(const std::filesystem::path& path, const std::function<Status(const ByteSink&)>& produce) {
  if (Status status = checkTarget(path); !status) return status;
  Result<TemporaryFile> temporary = TemporaryFile::create(path);
  if (!temporary) return temporary.error();
  const Status produced = produce([&](std::span<const uint8_t> bytes) { return temporary->append(bytes); });
  if (!produced) return produced;
  return temporary->replaceTarget();
}

Status writeFileAtomically(const std::filesystem::path& path, std::span<const uint8_t> bytes) {
  return streamFileAtomically(path, [&](const ByteSink& sink) { return sink(bytes); });
}

}  // namespace froth
