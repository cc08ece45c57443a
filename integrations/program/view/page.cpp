// SPDX-License-Identifier: MIT
#include "integrations/program/view/page.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "integrations/program/io/failure.h"

namespace mien::view {

namespace {

namespace fs = std::filesystem;

constexpr uintmax_t kMaxFileBytes = uintmax_t{64} << 20;

const std::map<std::string, std::string> kTypes = {
    {".html", "text/html; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".wasm", "application/wasm"},
};

bool is_page(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_regular_file(folder / "index.html", ignored) &&
         fs::is_regular_file(folder / "mien" / "mien.wasm", ignored);
}

/// PREFIX/bin/mien has it in PREFIX/share, BUILD/release/bin/mien in BUILD/web.
fs::path find_page() {
  const fs::path above = installed_folder();
  if (!above.empty()) {
    for (const fs::path& folder :
         {above / "share" / "mien" / "viewer", above.parent_path() / "web" / "viewer"}) {
      if (is_page(folder)) return folder;
    }
  }
  cli::fail(
      cli::kFile, "cannot view", "", "the page of the viewer is not installed",
      "build it with './dev web build' in the source tree of mien, or name it: --page FOLDER");
}

}  // namespace

fs::path installed_folder() {
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  return failed ? fs::path() : program.parent_path().parent_path();
}

Files load_page(const std::string& named) {
  const fs::path folder = named.empty() ? find_page() : fs::path(named);
  if (!is_page(folder)) {
    cli::fail(cli::kFile, "cannot view", named, "this folder does not have the page of the viewer",
              "name the one that './dev web build' makes: build/web/viewer");
  }
  Files files;
  std::error_code failed;
  for (auto at = fs::recursive_directory_iterator(folder, failed);
       !failed && at != fs::recursive_directory_iterator(); at.increment(failed)) {
    const auto type = kTypes.find(at->path().extension().string());
    std::error_code ignored;
    if (type == kTypes.end() || at->is_symlink(ignored) || !at->is_regular_file(ignored)) continue;
    if (at->file_size(ignored) > kMaxFileBytes) continue;
    std::ifstream stream(at->path(), std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    if (!stream) {
      cli::fail(cli::kFile, "cannot read", at->path().string(), "reading failed",
                "check its permissions");
    }
    files["/" + at->path().lexically_relative(folder).generic_string()] = {type->second,
                                                                           std::move(bytes)};
  }
  return files;
}

}  // namespace mien::view
