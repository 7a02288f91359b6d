#include "base/temporary_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace froth {
namespace {

constexpr char kMark[] = ".tmp-";  // then process id, '-', number

std::filesystem::path folderOf(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : ".";
}

// "scene.froth.tmp-4711-0" beside scene.froth
bool isTemporaryOf(const std::filesystem::path& target, std::string_view name) {
  const std::string start = target.filename().string() + kMark;
  return name.size() > start.size() && name.substr(0, start.size()) == start &&
         name.find_first_not_of("0123456789-", start.size()) == std::string_view::npos;
}

bool lock(int descriptor) { return ::flock(descriptor, LOCK_EX | LOCK_NB) == 0; }

// False once another process has removed it, or its owner has renamed it and perhaps made another file of
// that name.
bool isStillNamed(int descriptor, const std::string& name) {
  struct stat open {
  }, named{};
  return ::fstat(descriptor, &open) == 0 && ::lstat(name.c_str(), &named) == 0 && S_ISREG(named.st_mode) &&
         open.st_dev == named.st_dev && open.st_ino == named.st_ino;
}

// What can be locked belongs to no living process. Best effort: nothing here is worth failing for.
void removeLeftovers(const std::filesystem::path& target) {
  std::error_code ignored;
  std::vector<std::string> leftovers;
  for (std::filesystem::directory_iterator entry(folderOf(target), ignored), end; entry != end;
       entry.increment(ignored)) {
    if (isTemporaryOf(target, entry->path().filename().string())) leftovers.push_back(entry->path().string());
  }
  for (const std::string& leftover : leftovers) {
    const int descriptor = ::open(leftover.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (descriptor < 0) continue;
    if (lock(descriptor) && isStillNamed(descriptor, leftover)) ::unlink(leftover.c_str());
    ::close(descriptor);
  }
}

// Where a chain of symbolic links ends, whether or not there is a file.
std::filesystem::path followLinks(std::filesystem::path path) {
  constexpr int kMostLinks = 40;  // as many as Linux follows
  std::error_code error;
  for (int link = 0; link < kMostLinks; ++link) {
    const std::filesystem::path next = std::filesystem::read_symlink(path, error);
    if (error) break;
    path = path.parent_path() / next;  // `next` alone where it is absolute
  }
  return path;
}

// So that the new name survives a power cut. Best effort: not every file system can do it.
void syncFolderOf(const std::filesystem::path& path) {
  const int descriptor = ::open(folderOf(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

Error ioError(const std::filesystem::path& path, const char* what) {
  return makeError(ErrorKind::kIo, "%s: %s: %s; check folder, rights and free space", path.c_str(), what,
                   std::strerror(errno));
}

Result<TemporaryFile> TemporaryFile::create(const std::filesystem::path& target) {
  TemporaryFile file;
  file.target_ = followLinks(target);
  removeLeftovers(file.target_);
  if (Status status = file.openLocked(); !status) return status.error();
  file.takeRightsOfTarget();
  return file;
}

Status TemporaryFile::openLocked() {
  constexpr int kAttempts = 1000;  // names that other threads may hold
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const std::string name = target_.string() + kMark + std::to_string(::getpid()) + "-" + std::to_string(attempt);
    const int descriptor = ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0 && errno == EEXIST) continue;
    if (descriptor < 0) return ioError(target_, "cannot be created");
    // Where locks do not exist, nobody removes leftovers either.
    const bool isTaken = !lock(descriptor) && errno == EWOULDBLOCK;
    if (!isTaken && isStillNamed(descriptor, name)) {
      descriptor_ = descriptor;
      name_ = name;
      return {};
    }
    ::close(descriptor);  // taken for a leftover before it was locked
  }
  return makeError(ErrorKind::kIo, "%s: %d temporary files stand beside it; remove them", target_.c_str(), kAttempts);
}

// Only root may give files away. Where not even the group can stay, its rights go: they were another group's. They are
// set after the owner, for a new one takes some away; meanwhile the file is empty.
void TemporaryFile::takeRightsOfTarget() const {
  struct stat old {};
  if (::stat(target_.c_str(), &old) != 0) return;
  constexpr uid_t kSameOwner = static_cast<uid_t>(-1);
  const bool hasGroup =
      ::fchown(descriptor_, old.st_uid, old.st_gid) == 0 || ::fchown(descriptor_, kSameOwner, old.st_gid) == 0;
  ::fchmod(descriptor_, old.st_mode & (hasGroup ? 0777 : 0707));
}

TemporaryFile::TemporaryFile(TemporaryFile&& other) noexcept
    : target_(std::move(other.target_)),
      name_(std::exchange(other.name_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_) {}

TemporaryFile& TemporaryFile::operator=(TemporaryFile&& other) noexcept {
  std::swap(target_, other.target_);
  std::swap(name_, other.name_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(size_, other.size_);
  return *this;
}

TemporaryFile::~TemporaryFile() {
  removeName();
  if (descriptor_ >= 0) ::close(descriptor_);
}

void TemporaryFile::removeName() {
  if (!name_.empty()) ::unlink(name_.c_str());
  name_.clear();
}

Status TemporaryFile::append(std::span<const uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t done = ::write(descriptor_, bytes.data(), bytes.size());
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) return ioError(target_, "cannot be written");
    bytes = bytes.subspan(static_cast<size_t>(done));
    size_ += static_cast<uint64_t>(done);
  }
  return {};
}

// Within the kernel as far as it can, else through a buffer.
Status TemporaryFile::appendPart(const TemporaryFile& source, uint64_t begin, uint64_t size) {
  off_t offset = static_cast<off_t>(begin);
  const auto left = [&] { return begin + size - static_cast<uint64_t>(offset); };
  while (left() > 0) {
    const ssize_t done = ::copy_file_range(source.descriptor_, &offset, descriptor_, nullptr, left(), 0);
    if (done <= 0) break;
    size_ += static_cast<uint64_t>(done);
  }
  std::vector<uint8_t> buffer(std::min(left(), uint64_t{1} << 20));
  while (left() > 0) {
    const ssize_t got = ::pread(source.descriptor_, buffer.data(), std::min<uint64_t>(buffer.size(), left()), offset);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return ioError(target_, "its temporary cannot be read");
    if (Status status = append({buffer.data(), static_cast<size_t>(got)}); !status) return status;
    offset += got;
  }
  return {};
}

// The lock is kept until the temporary name is gone.
Status TemporaryFile::replaceTarget() {
  if (::fsync(descriptor_) != 0) return ioError(target_, "cannot be synced");
  if (std::rename(name_.c_str(), target_.c_str()) != 0) return ioError(target_, "cannot be replaced");
  name_.clear();
  syncFolderOf(target_);
  return {};
}

}  // namespace froth
