// SPDX-License-Identifier: MIT
// A document as JSON, for version control: the same bytes again when it is read back.
//
//     {
//      "dna": "2.8",                             version of the file; first
//      "layers": [["desc", "1.1"], ..., ["note", "1.0", ["HEX", ...]]],   in file order; of unknown
//                                                kinds with their bytes
//      "desc": {"name": "Ada", ...},             the fields of docs/dna-format.md by name
//      ...
//     }
//
// Floats are the shortest decimals that give them back; those that are not finite are strings of their bits, such
// as "0x7fc00000". A string that is not UTF-8 is {"hex": "..."}.
#pragma once

#include "integrations/program/edit/document.h"
#include "integrations/program/io/output.h"

namespace mien::cli {

/// Writes while it walks through the document.
void write_json_document(const Document& document, Output& output);

/// Reads while the document grows; "-" is standard input. Exit code 2 for what is no document, with the path of the
/// field. Fields that the text lacks are empty.
Document read_json_document(const std::string& path, const Session& session);

}  // namespace mien::cli
