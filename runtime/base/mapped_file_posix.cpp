// SPDX-License-Identifier: MIT
#if !defined(_WIN32)

#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "runtime/base/file_pages.h"

namespace mien {
namespace {

Status fail_with(Error& error, Status status, const char* path, int reason) {
  const char* const action = status == Status::kFileOpen    ? "open"
                             : status == Status::kFileWrite ? "write"
                                                            : "read";
  return fail_file(error, status, action, path, strerror(reason));
}

int64_t read_some(void* user, void* to, size_t size) {
  const int descriptor = *static_cast<const int*>(user);
  ssize_t count;
  do {
    count = read(descriptor, to, size < SSIZE_MAX ? size : SSIZE_MAX);
  } while (count < 0 && errno == EINTR);
  return count;
}

bool write_all(int descriptor, const uint8_t* bytes, size_t size) {
  while (size != 0) {
    const ssize_t count = write(descriptor, bytes, size < SSIZE_MAX ? size : SSIZE_MAX);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes += count;
    size -= static_cast<size_t>(count);
  }
  return true;
}

bool write_all(int descriptor, const Pieces& pieces) {
  while (true) {
    const Span<const uint8_t> piece = pieces.next(pieces.user);
    if (piece.empty()) return true;
    if (!write_all(descriptor, piece.data, piece.count)) return false;
  }
}

/// Gives a new file the owner, group and permissions of the one that it will replace.
bool take_over(int descriptor, const struct stat& old) {
  struct stat now;
  if (fstat(descriptor, &now) != 0) return false;
  mode_t mode = old.st_mode & 0777;
  const bool other_owner = now.st_uid != old.st_uid, other_group = now.st_gid != old.st_gid;
  if ((other_owner || other_group) && fchown(descriptor, old.st_uid, old.st_gid) != 0) {
    // What the old group might do, the new one may only if everybody might.
    if (other_group) mode &= ~mode_t{070} | (mode & 07) << 3;
  }
  return fchmod(descriptor, mode) == 0;
}

/// Writes, closes, and tells why not; `old` is null if there is no file to be replaced.
bool fill_temporary(int descriptor, const Pieces& pieces, const struct stat* old, int& reason) {
  bool good = write_all(descriptor, pieces) && (!old || take_over(descriptor, *old));
  if (!good) reason = errno;
  if (close(descriptor) != 0 && good) {
    reason = errno;
    good = false;
  }
  return good;
}

}  // namespace

Status open_file(const char* path, FileAccess access, const FileLimits& limits,
                 const Allocator& allocator, MappedFile& out, Error& error) {
  out = {};
  int descriptor = open(path, O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return fail_with(error, Status::kFileOpen, path, errno);
  struct stat about;
  if (fstat(descriptor, &about) != 0 || S_ISDIR(about.st_mode)) {
    const int reason = S_ISDIR(about.st_mode) ? EISDIR : errno;
    close(descriptor);
    return fail_with(error, Status::kFileRead, path, reason);
  }
  const bool regular = S_ISREG(about.st_mode) && about.st_size > 0;
  if (regular && static_cast<uint64_t>(about.st_size) > SIZE_MAX - 1) {
    close(descriptor);
    return fail_file(error, Status::kMemory, "read", path, "too large for the address space");
  }
  if (access == FileAccess::kMap && regular) {
    const size_t size = static_cast<size_t>(about.st_size);
    void* map = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (map != MAP_FAILED) {
      close(descriptor);
      out.bytes = static_cast<const uint8_t*>(map);
      out.size = size;
      out.mapped = true;
      return Status::kOk;
    }
  }
  size_t expected = regular ? static_cast<size_t>(about.st_size) : 64 * 1024;
  if (expected > limits.bytes) expected = static_cast<size_t>(limits.bytes);
  bool good;
  const Status status =
      read_to_end({&descriptor, read_some}, path, expected, limits, allocator, out, good, error);
  const int reason = errno;
  close(descriptor);
  return good ? status : fail_with(error, Status::kFileRead, path, reason);
}

void forget_pages(const MappedFile& file) {
  if (!file.mapped) return;
  (void)madvise(const_cast<uint8_t*>(file.bytes), file.size, MADV_DONTNEED);
}

void close_file(MappedFile& file) {
  if (file.mapped) {
    munmap(const_cast<uint8_t*>(file.bytes), file.size);
  } else {
    file.allocator.put(const_cast<uint8_t*>(file.bytes), file.capacity, kCopyAlignment);
  }
  file = {};
}

Status write_file(const char* path, const Pieces& pieces, const Allocator& allocator,
                  Error& error) {
  struct stat old;
  bool exists = lstat(path, &old) == 0;
  char target[PATH_MAX];
  const char* to = path;
  if (exists && S_ISLNK(old.st_mode)) {
    if (!realpath(path, target)) return fail_with(error, Status::kFileWrite, path, errno);
    to = target;
    exists = stat(to, &old) == 0;
  }
  // A device or a pipe must be written to; a rename would put a file in its place.
  if (exists && !S_ISREG(old.st_mode)) {
    const int device = open(to, O_WRONLY | O_CLOEXEC);
    int reason = errno;
    if (device >= 0 && fill_temporary(device, pieces, nullptr, reason)) return Status::kOk;
    return fail_with(error, Status::kFileWrite, path, reason);
  }

  // Only in the same folder can a rename be atomic. The name does not grow with that of the file,
  // which may be as long as names can be. Unique among processes by the process number, among threads
  // by a stack address.
  const char* const slash = strrchr(to, '/');
  const size_t folder = slash ? static_cast<size_t>(slash + 1 - to) : 0;
  const size_t capacity = folder + 48;
  char* temporary = static_cast<char*>(allocator.get(capacity, 1));
  if (!temporary) return fail_file(error, Status::kMemory, "write", path, "no memory");
  memcpy(temporary, to, folder);
  snprintf(temporary + folder, capacity - folder, ".mien%d-%zx", static_cast<int>(getpid()),
           reinterpret_cast<size_t>(&old));

  // Nobody else may read what will replace a file that they may not read.
  const int descriptor =
      open(temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, exists ? 0600 : 0666);
  int reason = errno;
  bool written =
      descriptor >= 0 && fill_temporary(descriptor, pieces, exists ? &old : nullptr, reason);
  if (written && rename(temporary, to) != 0) {
    written = false;
    reason = errno;
  }
  if (descriptor >= 0 && !written) unlink(temporary);
  allocator.put(temporary, capacity, 1);
  return written ? Status::kOk : fail_with(error, Status::kFileWrite, path, reason);
}

}  // namespace mien

#endif
