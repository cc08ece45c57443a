// SPDX-License-Identifier: MIT
#include "integrations/cli/rig_file.h"

#include "integrations/cli/image_file.h"
#include "integrations/cli/names.h"
#include "integrations/cli/options.h"
#include "integrations/cli/output.h"

namespace mien::cli {

std::string shown_name(const std::string& path) { return path == "-" ? "standard input" : path; }

RigFile open_rig_file(const std::string& path, const MienDnaDesc& desc, const Session& session) {
  RigFile file;
  file.shown = shown_name(path);
  MienDna* dna = nullptr;
  auto error = sized<MienError>();
  MienStatus status;
  if (path == "-") {
    file.bytes = read_standard_input();
    status = mien_dna_open_memory(file.bytes.data(), file.bytes.size(), &desc, &dna, &error);
  } else {
    status = mien_dna_open_file(path.c_str(), &desc, &dna, &error);
  }
  if (status == MIEN_ERROR_DNA_SIGNATURE &&
      (path == "-" ? is_image_bytes(file.bytes) : is_image(path))) {
    fail(kInvalid, "cannot open rig", file.shown, "it is a baked rig, and this needs the DNA file",
         "give the file that it was baked from");
  }
  check(status, &error, "cannot open rig", file.shown);
  file.dna.reset(dna);
  file.info = sized<MienDnaInfo>();
  check(mien_dna_info(dna, &file.info), nullptr, "cannot examine rig", file.shown);

  uint64_t named = 0;
  for (uint64_t mask = desc.lods; mask != 0; mask &= mask - 1) ++named;
  // A range may reach past the end (its default does); a list names what somebody expects to be
  // there.
  const bool range = (desc.lods & (uint64_t{1} << kLastMaskLod)) != 0;
  if (!range && named > file.info.lod_count) {
    note(session, file.shown + ": of " + std::to_string(named) + " LODs named it has only " +
                      std::to_string(file.info.lod_count));
  }
  return file;
}

Rig create_rig(const RigFile& file, const MienRigDesc& desc) {
  auto error = sized<MienError>();
  MienRig* rig = nullptr;
  check(mien_rig_create(file.dna.get(), &desc, &rig, &error), &error, "cannot prepare rig",
        file.shown);
  return Rig(rig);
}

MienRigInfo rig_info(const MienRig* rig) {
  auto info = sized<MienRigInfo>();
  check(mien_rig_info(rig, &info), nullptr, "cannot examine rig", "");
  return info;
}

uint32_t rig_count(const MienRig* rig, uint32_t kind) {
  uint32_t count = 0;
  check(mien_rig_count(rig, kind, &count), nullptr, "cannot examine rig", "");
  return count;
}

}  // namespace mien::cli
