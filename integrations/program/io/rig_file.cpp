// SPDX-License-Identifier: MIT
#include "integrations/program/io/rig_file.h"

#include "integrations/program/io/baked_file.h"
#include "integrations/program/io/dna_streams.h"
#include "integrations/program/io/input.h"

namespace mien::cli {

RigFile open_rig_file(const std::string& path, const MienDnaDesc& desc, const Session& session) {
  RigFile file;
  file.shown = shown_name(path);
  MienDna* dna = nullptr;
  auto error = sized<MienError>();
  MienStatus status;
  const bool stream = is_stream(path);
  if (stream) {
    file.bytes = read_rig_stream(path);
    status = mien_dna_open_memory(file.bytes.data(), file.bytes.size(), &desc, &dna, &error);
  } else {
    status = mien_dna_open_file(path.c_str(), &desc, &dna, &error);
  }
  if (status == MIEN_ERROR_DNA_SIGNATURE &&
      (stream ? is_baked_bytes(file.bytes) : is_baked_file(path))) {
    fail(kInvalid, "cannot open rig", file.shown,
         "this is a baked file, and the command needs a DNA file",
         "give the DNA file that it was baked from");
  }
  if (status == MIEN_ERROR_DNA_SIGNATURE) {
    FileBytes bytes = stream ? FileBytes(file.shown, std::move(file.bytes)) : FileBytes(path);
    if (const auto inside = only_dna_stream(bytes, "cannot open rig")) {
      file.bytes = bytes.read(inside->offset, inside->size);
      file.shown += ", DNA stream at byte " + std::to_string(inside->offset);
      status = mien_dna_open_memory(file.bytes.data(), file.bytes.size(), &desc, &dna, &error);
    }
  }
  const bool refused_system = desc.system && status == MIEN_ERROR_DNA_VALUE;
  check(status, &error, "cannot open rig", file.shown,
        refused_system ? "choose another --system or --rotation-order" : "");
  file.dna.reset(dna);
  file.info = sized<MienDnaInfo>();
  check(mien_dna_info(dna, &file.info), nullptr, "cannot read rig", file.shown);

  uint64_t named = 0;
  for (uint64_t mask = desc.lods; mask != 0; mask &= mask - 1) ++named;
  // A range may reach past the last LOD, and its default does; a list means what it names.
  const bool range = (desc.lods & (uint64_t{1} << kLastMaskLod)) != 0;
  if (!range && named > file.info.lod_count) {
    note(session, file.shown + ": only " + std::to_string(file.info.lod_count) + " of the " +
                      std::to_string(named) + " requested LODs exist");
  }
  return file;
}

bool has_geometry(const RigFile& file) {
  auto field = sized<MienDnaField>();
  const MienStatus status = mien_dna_field(file.dna.get(), "geom.meshes", &field, nullptr);
  return status == MIEN_OK && field.count != 0;
}

Rig create_rig(const RigFile& file, const MienRigDesc& desc) {
  auto error = sized<MienError>();
  MienRig* rig = nullptr;
  check(mien_rig_create(file.dna.get(), &desc, &rig, &error), &error, "cannot compile rig",
        file.shown, "export the rig again without that");
  return Rig(rig);
}

MienRigInfo rig_info(const MienRig* rig) {
  auto info = sized<MienRigInfo>();
  check(mien_rig_info(rig, &info), nullptr, "cannot read rig", "");
  return info;
}

uint32_t rig_count(const MienRig* rig, uint32_t kind) {
  uint32_t count = 0;
  check(mien_rig_count(rig, kind, &count), nullptr, "cannot read rig", "");
  return count;
}

std::string rig_name(const MienRig* rig, uint32_t kind, uint32_t index) {
  MienStringView name{};
  check(mien_rig_name(rig, kind, index, &name), nullptr, "cannot list names", "");
  return to_string(name);
}

}  // namespace mien::cli
