// SPDX-License-Identifier: MIT
#if defined(_WIN32)

#include <windows.h>

#include <cstdio>
#include <cstring>
#include <cwchar>

#include "runtime/base/file_pages.h"

namespace mien {
namespace {

/// A path as the system takes it, with the prefix that lifts the limit of 260 characters.
struct WidePath {
  wchar_t* text = nullptr;  // null if there is no memory, or if the path is not UTF-8
  size_t capacity = 0;
  bool is_utf8 = false;
  Allocator allocator;

  WidePath(const char* path, const Allocator& memory) : allocator(memory) {
    const int count = MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, nullptr, 0);
    if (count <= 0) return;
    is_utf8 = true;
    wchar_t* plain = make(static_cast<size_t>(count));
    if (!plain) return;
    MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, plain, count);
    const DWORD full = GetFullPathNameW(plain, 0, nullptr, nullptr);
    if (full < 220 || (plain[0] == L'\\' && plain[1] == L'\\')) {
      text = plain;
      capacity = static_cast<size_t>(count);
      return;
    }
    capacity = full + 4 + size_t{24};  // of a temporary name
    text = make(capacity);
    if (text) {
      wmemcpy(text, L"\\\\?\\", 4);
      GetFullPathNameW(plain, full, text + 4, nullptr);
    }
    allocator.put(plain, sizeof(wchar_t) * static_cast<size_t>(count), alignof(wchar_t));
  }
  ~WidePath() {
    if (text) allocator.put(text, sizeof(wchar_t) * capacity, alignof(wchar_t));
  }
  WidePath(const WidePath&) = delete;
  WidePath& operator=(const WidePath&) = delete;

  wchar_t* make(size_t count) const {
    return static_cast<wchar_t*>(allocator.get(sizeof(wchar_t) * count, alignof(wchar_t)));
  }
};

Status fail_path(Error& error, Status status, const char* action, const char* path,
                 const WidePath& wide) {
  return wide.is_utf8 ? fail_file(error, Status::kMemory, action, path, "no memory")
                      : fail_file(error, status, action, path, "not UTF-8");
}

Status fail_with(Error& error, Status status, const char* path, DWORD reason) {
  char text[128] = "";
  FormatMessageA(FORMAT_MESSAGE_FROM_SYSTEM | FORMAT_MESSAGE_IGNORE_INSERTS, nullptr, reason, 0,
                 text, sizeof(text), nullptr);
  text[strcspn(text, "\r\n")] = 0;
  const char* const action = status == Status::kFileOpen    ? "open"
                             : status == Status::kFileWrite ? "write"
                                                            : "read";
  return fail_file(error, status, action, path, text[0] ? text : "the system refuses");
}

int64_t read_some(void* user, void* to, size_t size) {
  DWORD count = 0;
  if (!ReadFile(user, to, static_cast<DWORD>(size < (1u << 30) ? size : 1u << 30), &count,
                nullptr)) {
    return GetLastError() == ERROR_BROKEN_PIPE ? 0 : -1;
  }
  return count;
}

bool map_file(HANDLE file, uint64_t size, MappedFile& out) {
  const HANDLE section = CreateFileMappingW(file, nullptr, PAGE_READONLY, 0, 0, nullptr);
  if (!section) return false;
  const void* bytes = MapViewOfFile(section, FILE_MAP_READ, 0, 0, 0);
  CloseHandle(section);
  if (!bytes) return false;
  out.bytes = static_cast<const uint8_t*>(bytes);
  out.size = static_cast<size_t>(size);
  out.mapped = true;
  return true;
}

bool write_all(HANDLE file, const uint8_t* bytes, size_t size) {
  while (size != 0) {
    DWORD count = 0;
    const DWORD wanted = static_cast<DWORD>(size < (1u << 30) ? size : 1u << 30);
    if (!WriteFile(file, bytes, wanted, &count, nullptr)) return false;
    bytes += count;
    size -= count;
  }
  return true;
}

bool write_all(HANDLE file, const Pieces& pieces) {
  while (true) {
    const Span<const uint8_t> piece = pieces.next(pieces.user);
    if (piece.empty()) return true;
    if (!write_all(file, piece.data, piece.count)) return false;
  }
}

}  // namespace

Status open_file(const char* path, FileAccess access, const FileLimits& limits,
                 const Allocator& allocator, MappedFile& out, Error& error) {
  out = {};
  const WidePath wide(path, allocator);
  if (!wide.text) {
    return fail_path(error, Status::kFileOpen, "open", path, wide);
  }
  // Others may rename and delete the file while it is open, as elsewhere.
  const HANDLE file = CreateFileW(wide.text, GENERIC_READ, FILE_SHARE_READ | FILE_SHARE_DELETE,
                                  nullptr, OPEN_EXISTING, FILE_ATTRIBUTE_NORMAL, nullptr);
  if (file == INVALID_HANDLE_VALUE) {
    return fail_with(error, Status::kFileOpen, path, GetLastError());
  }
  LARGE_INTEGER length = {};
  const bool regular =
      GetFileType(file) == FILE_TYPE_DISK && GetFileSizeEx(file, &length) && length.QuadPart > 0;
  const uint64_t size = regular ? static_cast<uint64_t>(length.QuadPart) : 64 * 1024;
  if (size > SIZE_MAX - 1) {
    CloseHandle(file);
    return fail_file(error, Status::kMemory, "read", path, "too large for the address space");
  }
  Status status = Status::kOk;
  if (access != FileAccess::kMap || !regular || !map_file(file, size, out)) {
    bool good;
    const size_t expected = static_cast<size_t>(size < limits.bytes ? size : limits.bytes);
    status = read_to_end({file, read_some}, path, expected, limits, allocator, out, good, error);
    if (!good) status = fail_with(error, Status::kFileRead, path, GetLastError());
  }
  CloseHandle(file);
  return status;
}

void forget_pages(const MappedFile&) {}  // the system drops them when it needs the memory

void close_file(MappedFile& file) {
  if (file.mapped) {
    UnmapViewOfFile(file.bytes);
  } else {
    file.allocator.put(const_cast<uint8_t*>(file.bytes), file.capacity, kCopyAlignment);
  }
  file = {};
}

// Links are followed by the system, and a file that is replaced gives its name only.
Status write_file(const char* path, const Pieces& pieces, const Allocator& allocator,
                  Error& error) {
  const WidePath to(path, allocator);
  if (!to.text) {
    return fail_path(error, Status::kFileWrite, "write", path, to);
  }
  size_t folder = 0, length = 0;
  for (; to.text[length]; ++length) {
    if (to.text[length] == L'\\' || to.text[length] == L'/') folder = length + 1;
  }
  const size_t capacity = folder + 48;
  wchar_t* temporary = to.make(capacity);
  if (!temporary) return fail_file(error, Status::kMemory, "write", path, "no memory");
  wmemcpy(temporary, to.text, folder);
  swprintf(temporary + folder, capacity - folder, L".mien%lu-%lx", GetCurrentProcessId(),
           GetCurrentThreadId());
  const HANDLE file =
      CreateFileW(temporary, GENERIC_WRITE, 0, nullptr, CREATE_NEW, FILE_ATTRIBUTE_NORMAL, nullptr);
  DWORD reason = GetLastError();
  bool written = file != INVALID_HANDLE_VALUE;
  if (written) {
    written = write_all(file, pieces);
    if (!written) reason = GetLastError();
    if (!CloseHandle(file) && written) {
      reason = GetLastError();
      written = false;
    }
    if (written && !MoveFileExW(temporary, to.text, MOVEFILE_REPLACE_EXISTING)) {
      reason = GetLastError();
      written = false;
    }
    if (!written) DeleteFileW(temporary);
  }
  allocator.put(temporary, sizeof(wchar_t) * capacity, alignof(wchar_t));
  return written ? Status::kOk : fail_with(error, Status::kFileWrite, path, reason);
}

}  // namespace mien

#endif
