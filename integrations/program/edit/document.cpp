// SPDX-License-Identifier: MIT
#include "integrations/program/edit/document.h"

#include "integrations/program/io/dna_fields.h"
#include "integrations/program/io/nearest_name.h"
#include "integrations/program/io/rig_file.h"

namespace mien::cli {

namespace {

struct KindNames {
  uint32_t kind;
  const char* noun;
  const char* path;  // of the list of names; null: "psd0", "psd1", ...
};

constexpr KindNames kKinds[] = {
    {MIEN_KIND_JOINT, "joint", "defn.jointNames"},
    {MIEN_KIND_MESH, "mesh", "defn.meshNames"},
    {MIEN_KIND_BLEND_SHAPE_CHANNEL, "blend shape", "defn.blendShapeChannelNames"},
    {MIEN_KIND_ANIMATED_MAP, "animated map", "defn.animatedMapNames"},
    {MIEN_KIND_RAW_CONTROL, "raw control", "defn.rawControlNames"},
    {MIEN_KIND_GUI_CONTROL, "GUI control", "defn.guiControlNames"},
    {MIEN_KIND_PSD_CONTROL, "PSD control", nullptr},
    {MIEN_KIND_ML_CONTROL, "ML control", "mlbh.mlControlNames"},
    {MIEN_KIND_RBF_CONTROL, "RBF control", "rbfe.poseControlNames"},
};

const KindNames& names_of_kind(uint32_t kind) {
  const KindNames* found = kKinds;
  while (found->kind != kind) ++found;
  return *found;
}

/// Maps a DNA file; null if it is not one but may hold one.
DocumentHandle map_document(const std::string& path) {
  auto desc = sized<MienDocumentDesc>();
  MienDocument* made = nullptr;
  auto error = sized<MienError>();
  const MienStatus status = mien_document_open_file(path.c_str(), &desc, &made, &error);
  if (status != MIEN_ERROR_DNA_SIGNATURE) check(status, &error, "cannot open rig", path);
  return DocumentHandle(made);
}

}  // namespace

Document open_document(const std::string& path, const Session& session) {
  Document document;
  document.session = &session;
  document.shown = shown_name(path);
  if (!is_stream(path)) document.handle = map_document(path);
  if (document.handle) return document;
  auto desc = sized<MienDnaDesc>();
  desc.layers = MIEN_LAYER_ALL;
  desc.unknown_layers = MIEN_UNKNOWN_LAYERS_KEEP;
  desc.file_access = MIEN_FILE_MAP;
  const RigFile file = open_rig_file(path, desc, session);
  document.shown = file.shown;
  MienDocument* made = nullptr;
  auto error = sized<MienError>();
  check(mien_document_create(file.dna.get(), nullptr, &made, &error), &error, "cannot edit",
        file.shown);
  document.handle.reset(made);
  return document;
}

void fail_edit(const Document& document, const std::string& why, const std::string& what_to_do) {
  fail(kInvalid, "cannot edit", document.shown + ", " + document.edit, why, what_to_do);
}

void check_edit(const Document& document, MienStatus status, const MienError& error) {
  if (status == MIEN_ERROR_INVALID_ARGUMENT || status == MIEN_ERROR_MISMATCH) {
    fail_edit(document, error.message, "see 'mien help edit'");
  }
  check(status, &error, "cannot edit", document.shown + ", " + document.edit);
}

const char* kind_noun(uint32_t kind) { return names_of_kind(kind).noun; }

uint32_t find_element(const Document& document, uint32_t kind, const std::string& name) {
  uint32_t index = 0;
  auto error = sized<MienError>();
  const MienStatus status = mien_document_find(document.get(), kind, name.c_str(), &index, &error);
  if (status != MIEN_ERROR_NAME) {
    check_edit(document, status, error);
    return index;
  }
  const KindNames& names = names_of_kind(kind);
  const std::string missing = std::string("there is no ") + names.noun + " \"" + name + "\"";
  if (!names.path) fail_edit(document, missing, "they are psd0, psd1, ...");
  NearestName nearest(name);
  const uint64_t count = field_count(document, names.path);
  for (uint64_t i = 0; i < count; ++i) nearest.offer(read_string(document, element(names.path, i)));
  fail_edit(document, missing, nearest.question("see 'mien info --names all'"));
}

uint64_t field_count(const Document& document, const std::string& path) {
  auto field = sized<MienDnaField>();
  auto error = sized<MienError>();
  check(mien_document_field(document.get(), path.c_str(), &field, &error), &error,
        "cannot read " + path, document.shown);
  return field.count;
}

std::string read_string(const Document& document, const std::string& path) {
  MienStringView view{};
  auto error = sized<MienError>();
  check(mien_document_read_string(document.get(), path.c_str(), &view, &error), &error,
        "cannot read " + path, document.shown);
  return to_string(view);
}

std::vector<int64_t> read_integers(const Document& document, const std::string& path) {
  std::vector<int64_t> values(field_count(document, path));
  auto error = sized<MienError>();
  check(mien_document_read_integers(document.get(), path.c_str(), 0, values.size(), values.data(),
                                    &error),
        &error, "cannot read " + path, document.shown);
  return values;
}

std::vector<float> mesh_positions(const Document& document, uint32_t mesh) {
  if (mesh >= field_count(document, "geom.meshes")) {
    fail_edit(document, "the file has no geometry of this mesh", "give the file with geometry");
  }
  std::vector<float> positions;
  const char* const axes[] = {".positions.xs", ".positions.ys", ".positions.zs"};
  for (size_t axis = 0; axis < 3; ++axis) {
    const std::string path = element("geom.meshes", mesh, axes[axis]);
    const uint64_t count = field_count(document, path);
    positions.resize(3 * count);
    std::vector<float> values(count);
    auto error = sized<MienError>();
    check(mien_document_read_floats(document.get(), path.c_str(), 0, count, values.data(), &error),
          &error, "cannot read " + path, document.shown);
    for (size_t i = 0; i < count; ++i) positions[3 * i + axis] = values[i];
  }
  return positions;
}

}  // namespace mien::cli
