// SPDX-License-Identifier: MIT
// A document as the commands change it: names instead of numbers, and failures that say which edit.
#pragma once

#include <mien_author.h>

#include <string>
#include <vector>

#include "integrations/program/io/handles.h"
#include "integrations/program/io/terminal.h"

namespace mien::cli {

using DocumentHandle = std::unique_ptr<MienDocument, Destroy<MienDocument, mien_document_destroy>>;

struct Document {
  std::string shown;  // the file, for messages
  std::string edit;   // the option that is being applied, for messages
  const Session* session = nullptr;
  DocumentHandle handle;
  uint32_t version = 0;  // to be written: 2.version; 0: that of the file

  MienDocument* get() const { return handle.get(); }
};

Document open_document(const std::string& path, const Session& session);

/// What was typed cannot be done with this file: exit code 2.
[[noreturn]] void fail_edit(const Document& document, const std::string& why,
                            const std::string& what_to_do);

/// Fails unless `status` is MIEN_OK. For arguments that do not suit the document, it shows the message of
/// the library.
void check_edit(const Document& document, MienStatus status, const MienError& error);

/// "joint", "mesh", "blend shape", "raw control", ...
const char* kind_noun(uint32_t kind);

/// Fails with the nearest name.
uint32_t find_element(const Document& document, uint32_t kind, const std::string& name);

uint64_t field_count(const Document& document, const std::string& path);
std::string read_string(const Document& document, const std::string& path);
std::vector<int64_t> read_integers(const Document& document, const std::string& path);

/// 3 numbers per position of a mesh.
std::vector<float> mesh_positions(const Document& document, uint32_t mesh);

}  // namespace mien::cli
