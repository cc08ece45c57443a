// SPDX-License-Identifier: MIT
//
// What makes and changes DNA files, over mien_author.h: link libmien-author too. Everything said in mien.hpp
// holds here.
#pragma once

#include <mien_author.h>

#include <mien.hpp>

namespace mien {
inline namespace MIEN_CPP_NAMESPACE {

using GenerateDesc = Sized<MienGenerateDesc>;

/// A synthetic rig of a preset: tiny by default. The same seed gives the same bytes everywhere.
inline Result<Dna> generate(const GenerateDesc& desc = {}) {
  return make<Dna>(
      [&](MienDna** out, MienError* error) { return mien_dna_generate(&desc, out, error); });
}

using AuthorMesh = Sized<MienAuthorMesh>;
using AuthorDesc = Sized<MienAuthorDesc>;

/// What was found and measured while a rig was made.
class AuthorReport : public Owner<MienAuthorReport, mien_author_report_close> {
 public:
  using Owner::Owner;

  Result<std::string_view> json() const {
    MienStringView text = {nullptr, 0};
    const MienStatus status = mien_author_report_json(get(), &text);
    return {status, view(text)};
  }
};

/// A rig from a mesh. `report` may be null; if the call fails it is left empty.
inline Result<Dna> author_rig(const AuthorMesh& mesh, const AuthorDesc& desc = {},
                              AuthorReport* report = nullptr) {
  MienAuthorReport* made = nullptr;
  Result<Dna> dna = make<Dna>([&](MienDna** out, MienError* error) {
    return mien_author_rig(&mesh, &desc, out, report ? &made : nullptr, error);
  });
  if (report) *report = AuthorReport(made);
  return dna;
}

// ---- Documents ----------------------------------------------------------------------------------

using DocumentDesc = Sized<MienDocumentDesc>;
using PruneJointsDesc = Sized<MienPruneJointsDesc>;
using Placement = Sized<MienPlacement>;
using ProjectDesc = Sized<MienProjectDesc>;
using TransplantDesc = Sized<MienTransplantDesc>;

/// A DNA file that can be changed: its fields by the paths of Dna::field(), and as a whole by operations that
/// keep together what refers to each other. A call that fails changes nothing. For one thread at a
/// time. Fields and statuses: mien_author/document.h.
class Document : public Owner<MienDocument, mien_document_destroy> {
 public:
  using Owner::Owner;

  /// Of an open file, which may be closed afterwards.
  static Result<Document> of(const Dna& dna, const DocumentDesc& desc = {}) {
    return create(dna.get(), desc);
  }
  /// Of a whole file, which is mapped: without a copy in memory.
  static Result<Document> open_file(const char* path, const DocumentDesc& desc = {}) {
    return make<Document>([&](MienDocument** out, MienError* error) {
      return mien_document_open_file(path, &desc, out, error);
    });
  }
  /// Without anything: version 2.8.
  static Result<Document> empty(const DocumentDesc& desc = {}) { return create(nullptr, desc); }

  // Fields

  Result<MienDnaField> field(const char* path) const {
    return result<MienDnaField>(mien_document_field, path);
  }
  Result<std::string_view> field_name(const char* path, uint32_t index) const {
    return text(mien_document_child_name, path, index);
  }
  /// Valid until the document is changed.
  Result<std::string_view> string(const char* path) const {
    return text(mien_document_read_string, path);
  }
  /// An array or string as it is in the file: big-endian. Valid until the document is changed.
  Result<std::string_view> bytes(const char* path) const { return text(mien_document_bytes, path); }
  /// Fills `out` with the elements from `first` on.
  Result<void> read(const char* path, uint64_t first, Span<float> out) const {
    return done(mien_document_read_floats, path, first, out.size(), out.data());
  }
  Result<void> read(const char* path, uint64_t first, Span<int64_t> out) const {
    return done(mien_document_read_integers, path, first, out.size(), out.data());
  }

  /// Replaces the elements from `first` on.
  Result<void> write(const char* path, uint64_t first, Span<const float> values) {
    return done(mien_document_write_floats, path, first, values.size(), values.data());
  }
  Result<void> write(const char* path, uint64_t first, Span<const int64_t> values) {
    return done(mien_document_write_integers, path, first, values.size(), values.data());
  }
  Result<void> write(const char* path, std::string_view string) {
    return done(mien_document_write_string, path, string.data(), string.size());
  }
  /// Replaces elements of an array or list by new ones: zeros, empty strings or records of these.
  Result<void> splice(const char* path, uint64_t first, uint64_t removed, uint64_t inserted) {
    return done(mien_document_splice, path, first, removed, inserted);
  }
  Result<void> resize(const char* path, uint64_t count) {
    return done(mien_document_resize, path, count);
  }

  // Layers

  struct LayerCount {
    uint32_t version;  // of the file: 2.version
    uint32_t count;    // of the list
  };
  Result<LayerCount> layer_count() const {
    LayerCount found = {};
    Sized<MienError> error;
    const MienStatus status =
        mien_document_layer_count(get(), &found.version, &found.count, &error);
    return {status, std::move(found), &error};
  }
  /// A layer and, of an unknown kind, its bytes. Valid until the document is changed.
  Result<std::pair<MienDnaLayer, std::string_view>> layer(uint32_t index) const {
    Sized<MienDnaLayer> layer;
    MienStringView found = {nullptr, 0};
    Sized<MienError> error;
    const MienStatus status = mien_document_layer(get(), index, &layer, &found, &error);
    return {status, {layer, view(found)}, &error};
  }
  Result<void> clear_layers(uint32_t version) { return done(mien_document_clear_layers, version); }
  /// Without bytes if the kind is known.
  Result<void> add_layer(const char* code, uint32_t version_major, uint32_t version_minor,
                         std::string_view bytes = {}) {
    return done(mien_document_add_layer, code, version_major, version_minor, bytes.data(),
                bytes.size());
  }

  // Undoing

  Result<uint64_t> mark() { return result<uint64_t>(mien_document_mark); }
  /// To a mark, or to the beginning.
  Result<void> undo(uint64_t mark = 0) { return done(mien_document_undo, mark); }

  // Elements

  Result<uint32_t> find(MienKind kind, const char* name) const {
    return result<uint32_t>(mien_document_find, kind, name);
  }
  Result<void> rename(MienKind kind, uint32_t index, const char* name) {
    return done(mien_document_rename, kind, index, name);
  }
  Result<void> remove(MienKind kind, Span<const uint32_t> indices) {
    return done(mien_document_remove, kind, indices.data(), indices.size());
  }
  Result<void> clear(MienKind kind) { return done(mien_document_clear, kind); }
  Result<void> clear_joints(Span<const uint32_t> joints) {
    return done(mien_document_clear_joints, joints.data(), joints.size());
  }

  // Shapes and weights. Spans of vectors have 3 floats for each.

  /// Of the joints from `first_joint` on; an empty span leaves what it is for.
  Result<void> set_neutral(uint32_t first_joint, Span<const float> translations,
                           Span<const float> rotations = {}) {
    const bool moves = !translations.empty(), turns = !rotations.empty();
    if (moves && turns && translations.size() != rotations.size()) return mismatch();
    return done(mien_document_set_neutral, first_joint, moves ? translations.data() : nullptr,
                turns ? rotations.data() : nullptr,
                (moves ? translations.size() : rotations.size()) / 3);
  }
  Result<void> set_positions(uint32_t mesh, Span<const float> positions) {
    return done(mien_document_set_positions, mesh, positions.data(), positions.size() / 3);
  }
  /// Deltas of the positions `vertices`, or, if it is empty, of the first ones.
  Result<void> set_target(uint32_t mesh, uint32_t channel, Span<const float> deltas,
                          Span<const uint32_t> vertices = {}) {
    if (!vertices.empty() && 3 * vertices.size() != deltas.size()) return mismatch();
    return done(mien_document_set_target, mesh, channel,
                vertices.empty() ? nullptr : vertices.data(), deltas.data(), deltas.size() / 3);
  }
  Result<MienPrunedTargets> prune_targets(float tolerance) {
    return result<MienPrunedTargets>(mien_document_prune_targets, tolerance);
  }
  Result<MienPrunedJoints> prune_joints(const PruneJointsDesc& desc) {
    return result<MienPrunedJoints>(mien_document_prune_joints, &desc);
  }
  /// `influences` joints and weights for each position.
  Result<void> set_weights(uint32_t mesh, uint32_t influences, Span<const uint16_t> joints,
                           Span<const float> weights) {
    if (joints.size() != weights.size()) return mismatch();
    return done(mien_document_set_weights, mesh, influences, joints.data(), weights.data(),
                weights.size());
  }
  Result<void> normalize_weights(uint32_t mesh) {
    return done(mien_document_normalize_weights, mesh);
  }
  Result<void> limit_influences(uint32_t mesh, uint32_t influences) {
    return done(mien_document_limit_influences, mesh, influences);
  }
  Result<void> smooth_weights(uint32_t mesh, uint32_t iterations = 1, float strength = 0.5f,
                              uint32_t influences = 8) {
    return done(mien_document_smooth_weights, mesh, iterations, strength, influences);
  }
  Result<void> place(const Placement& placement) { return done(mien_document_place, &placement); }
  /// Bit l keeps LOD l.
  Result<void> keep_lods(uint64_t lods) { return done(mien_document_keep_lods, lods); }
  Result<void> convert(const CoordinateSystem& system) {
    return done(mien_document_convert, &system);
  }

  // Parts of other documents

  Result<void> copy_layers(const Document& from, uint32_t layers) {
    return done(mien_document_copy_layers, from.get(), layers);
  }
  /// The number of the mesh here.
  Result<uint32_t> copy_mesh(const Document& from, uint32_t mesh) {
    return result<uint32_t>(mien_document_copy_mesh, from.get(), mesh);
  }
  Result<void> merge_joints(const Document& from, double tolerance = 1e-3) {
    return done(mien_document_merge_joints, from.get(), tolerance);
  }
  Result<void> split_joints(const Document& from) {
    return done(mien_document_split_joints, from.get());
  }
  /// The largest distance to a place on `source`, or in the texture.
  Result<double> project(uint32_t mesh, uint32_t source, const ProjectDesc& desc = {}) {
    return result<double>(mien_document_project, mesh, source, &desc);
  }
  Result<double> make_lod(uint32_t lod, uint32_t source_lod, const ProjectDesc& desc = {}) {
    return result<double>(mien_document_make_lod, lod, source_lod, &desc);
  }
  Result<MienConformed> conform(uint32_t mesh, Span<const float> positions, bool others = true) {
    return result<MienConformed>(mien_document_conform, mesh, positions.data(),
                                 positions.size() / 3, others);
  }
  /// How many errors were written.
  Result<size_t> transplant(const Document& rig, Span<MienControlError> errors = {},
                            const TransplantDesc& desc = {}) {
    return result<size_t>(mien_document_transplant, rig.get(), &desc, errors.data(), errors.size());
  }

  // Results

  Result<Dna> to_dna(const DocumentDesc& desc = {}) const {
    return make<Dna>([&](MienDna** out, MienError* error) {
      return mien_document_to_dna(get(), &desc, out, error);
    });
  }
  Result<void> write_file(const char* path, const WriteDesc& desc = {}) const {
    return done(mien_document_write_file, path, &desc);
  }
  /// In pieces of at most 8 MiB.
  Result<void> write_stream(const MienByteSink& sink, const WriteDesc& desc = {}) const {
    return done(mien_document_write_stream, &sink, &desc);
  }
  /// The size of the file. Writes nothing to a buffer that is too small.
  Result<size_t> write_memory(Span<uint8_t> buffer, const WriteDesc& desc = {}) const {
    return result<size_t>(mien_document_write_memory, &desc, buffer.data(), buffer.size());
  }
  Result<Report> validate(const ValidateDesc& desc = {}) const {
    return make<Report>([&](MienReport** out, MienError* error) {
      return mien_document_validate(get(), &desc, out, error);
    });
  }

 private:
  static Result<Document> create(const MienDna* dna, const DocumentDesc& desc) {
    return make<Document>([&](MienDocument** out, MienError* error) {
      return mien_document_create(dna, &desc, out, error);
    });
  }
  template <class Function, class... Given>
  Result<void> done(Function* function, Given... given) const {
    Sized<MienError> error;
    const MienStatus status = function(get(), given..., &error);
    return {status, error};
  }
  /// The result is the parameter before the error.
  template <class Value, class Function, class... Given>
  Result<Value> result(Function* function, Given... given) const {
    Value value{};
    if constexpr (std::is_class<Value>::value) value.struct_size = sizeof(Value);
    Sized<MienError> error;
    const MienStatus status = function(get(), given..., &value, &error);
    return {status, std::move(value), &error};
  }
  template <class Function, class... Given>
  Result<std::string_view> text(Function* function, Given... given) const {
    MienStringView found = {nullptr, 0};
    Sized<MienError> error;
    const MienStatus status = function(get(), given..., &found, &error);
    return {status, view(found), &error};
  }
  static Result<void> mismatch() { return {MIEN_ERROR_MISMATCH, Sized<MienError>()}; }
};

}  // namespace MIEN_CPP_NAMESPACE
}  // namespace mien
