// SPDX-License-Identifier: MIT
#include "integrations/program/io/write_dna.h"

#include "integrations/program/io/failure.h"
#include "integrations/program/io/handles.h"
#include "integrations/program/io/output.h"

namespace mien::cli {

std::vector<char> write_dna(const MienDna* dna, const MienWriteDesc& desc, const std::string& path,
                            const Session& session) {
  // Through memory, so that Output writes files, devices and standard output alike and cleans up
  // after an interrupt.
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
  note_written(session, path, size);
  return bytes;
}

}  // namespace mien::cli
