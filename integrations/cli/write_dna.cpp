// SPDX-License-Identifier: MIT
#include "integrations/cli/write_dna.h"

#include <vector>

#include "integrations/cli/output.h"

namespace mien::cli {

void refuse_terminal(const std::string& path, const Session& session, const char* what) {
  if (path != "-" || !session.terminal.out_is_terminal) return;
  fail_usage("-o -", std::string(what) + " is not for a terminal",
             "name a file, or pipe the output");
}

void write_dna(const MienDna* dna, const MienWriteDesc& desc, const std::string& path) {
  // By way of memory, so that files, devices and standard output are all written by Output, which
  // also cleans up after an interrupt.
  const std::string shown = path == "-" ? "standard output" : path;
  auto error = sized<MienError>();
  size_t size = 0;
  check(mien_dna_write_memory(dna, &desc, nullptr, 0, &size, &error), &error, "cannot write DNA",
        shown);
  std::vector<char> bytes(size);
  check(mien_dna_write_memory(dna, &desc, bytes.data(), bytes.size(), &size, &error), &error,
        "cannot write DNA", shown);
  Output output(path);
  output.write(bytes.data(), size);
  output.commit();
}

}  // namespace mien::cli
