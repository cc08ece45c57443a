// SPDX-License-Identifier: MIT
// Values of the options of `mien edit`, and calls of the library that fail with the option.
#pragma once

#include <string>
#include <vector>

#include "integrations/program/commands/edit_options.h"

namespace mien::cli {

[[noreturn]] void fail_edit_value(const Document& document, const std::string& why,
                                  const std::string& what_to_do);

struct NamePair {
  std::string first, second;
};

/// At the first separator, or the last one. `form` is for the message.
NamePair split_pair(const Document& document, const std::string& value, char separator,
                    const char* form, bool at_last = false);

/// Finite numbers, separated by commas.
std::vector<double> parse_list(const Document& document, const std::string& list);
std::vector<double> parse_list_of(const Document& document, const std::string& list, size_t count,
                                  const char* form);

/// MIEN_KIND_... of "joint", "mesh", ...
uint32_t kind_named(const Document& document, const std::string& word);

struct MeshAndFile {
  std::string name;
  uint32_t mesh;
  std::string path;
};
MeshAndFile parse_mesh_and_file(const Document& document, const std::string& value);

/// "1 delta", "1,234 deltas"
std::string amount_text(uint64_t count, const std::string& noun);
/// With 3 digits.
std::string length_text(double length);

/// Calls a function of the library with the document, `given` and a place for what went wrong.
template <class Function, class... Given>
void edited(const Document& document, Function* function, Given... given) {
  auto error = sized<MienError>();
  check_edit(document, function(document.get(), given..., &error), error);
}

/// Calls edit(mesh) for the mesh of this name, or for "all".
template <class EditMesh>
std::string edit_meshes(const Document& document, const std::string& name, EditMesh&& edit) {
  if (name != "all") {
    edit(find_element(document, MIEN_KIND_MESH, name));
    return "mesh \"" + name + "\"";
  }
  const uint64_t count = field_count(document, "geom.meshes");
  for (uint32_t mesh = 0; mesh < count; ++mesh) edit(mesh);
  return "all meshes";
}

// Groups of edit_options() --------------------------------------------------------------------------

std::vector<EditOption> mesh_edit_options();
std::vector<EditOption> other_file_edit_options();

}  // namespace mien::cli
