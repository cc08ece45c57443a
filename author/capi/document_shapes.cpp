// SPDX-License-Identifier: MIT
// Documents: parts of other documents, and operations on shapes. mien_author.h is the manual.
#include "author/capi/document.h"
#include "author/document/conform.h"
#include "author/document/copy.h"
#include "author/document/project.h"
#include "author/document/transplant.h"

using namespace mien;
using namespace mien::capi;

static_assert(MIEN_MATCH_UV == int(author::Match::kUv), "the enums agree");
static_assert(MIEN_LAYER_ALL == int(dna::kLayersAll),
              "dna_view.h and mien.h number the same layers");

namespace {

/// Both documents of a call.
MienStatus check_documents(const MienDocument* document, const MienDocument* other,
                           MienError* error) {
  if (MienStatus status = check_document(document, error)) return status;
  if (MienStatus status = check_document(other, error)) return status;
  if (document != other) return MIEN_OK;
  return give_error(error, MIEN_ERROR_INVALID_ARGUMENT, "both documents are the same");
}

MienStatus read_projection(const MienProjectDesc* desc, author::Projection& out, MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  MienProjectDesc known;
  if (MienStatus status = read_desc(desc, known, "MienProjectDesc", error)) return status;
  const MienStatus in_range =
      check_fields({{"MienProjectDesc.match", known.match, MIEN_MATCH_UV},
                    {"MienProjectDesc.keep_weights", known.keep_weights, 1},
                    {"MienProjectDesc.keep_targets", known.keep_targets, 1}},
                   error);
  if (in_range != MIEN_OK) return in_range;
  out.match = static_cast<author::Match>(known.match);
  if (known.influences != 0) out.influences = known.influences;
  out.weights = known.keep_weights == 0;
  out.targets = known.keep_targets == 0;
  return MIEN_OK;
}

/// `project` is project_mesh() with meshes or make_lod() with LODs.
template <class Project>
MienStatus projected(Project* project, MienDocument* document, uint32_t to, uint32_t from,
                     const MienProjectDesc* desc, double* out_farthest, MienError* error) {
  if (MienStatus status = clear_output(out_farthest, error)) return status;
  if (MienStatus status = check_document(document, error)) return status;
  author::Projection how;
  if (MienStatus status = read_projection(desc, how, error)) return status;
  Error detail;
  author::ProjectionResult result;
  const Status status = project(document->document, to, from, how, result, detail);
  if (status == Status::kOk) *out_farthest = result.farthest;
  return finish(status, detail, error);
}

}  // namespace

MienStatus mien_document_copy_layers(MienDocument* document, const MienDocument* from,
                                     uint32_t layers, MienError* error) {
  if (MienStatus status = check_documents(document, from, error)) return status;
  if ((layers & ~uint32_t{MIEN_LAYER_ALL}) != 0) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "layers is 0x%x, which has bits that are not a MIEN_LAYER_...", layers);
  }
  Error detail;
  return finish(author::copy_layers(document->document, from->document, layers, detail), detail,
                error);
}

MienStatus mien_document_copy_mesh(MienDocument* document, const MienDocument* from, uint32_t mesh,
                                   uint32_t* out_mesh, MienError* error) {
  if (MienStatus status = clear_output(out_mesh, error)) return status;
  if (MienStatus status = check_documents(document, from, error)) return status;
  Error detail;
  return finish(author::copy_mesh(document->document, from->document, mesh, *out_mesh, detail),
                detail, error);
}

MienStatus mien_document_merge_joints(MienDocument* document, const MienDocument* from,
                                      double tolerance, MienError* error) {
  if (MienStatus status = check_documents(document, from, error)) return status;
  Error detail;
  return finish(author::merge_joints(document->document, from->document, tolerance, detail), detail,
                error);
}

MienStatus mien_document_split_joints(MienDocument* document, const MienDocument* from,
                                      MienError* error) {
  if (MienStatus status = check_documents(document, from, error)) return status;
  Error detail;
  return finish(author::split_joints(document->document, from->document, detail), detail, error);
}

MienStatus mien_document_project(MienDocument* document, uint32_t mesh, uint32_t source,
                                 const MienProjectDesc* desc, double* out_farthest,
                                 MienError* error) {
  return projected(author::project_mesh, document, mesh, source, desc, out_farthest, error);
}

MienStatus mien_document_make_lod(MienDocument* document, uint32_t lod, uint32_t source_lod,
                                  const MienProjectDesc* desc, double* out_farthest,
                                  MienError* error) {
  return projected(author::make_lod, document, lod, source_lod, desc, out_farthest, error);
}

MienStatus mien_document_conform(MienDocument* document, uint32_t mesh, const float* positions,
                                 size_t position_count, uint32_t others,
                                 MienConformed* out_conformed, MienError* error) {
  const MienStatus cleared = clear_struct(out_conformed);
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (cleared != MIEN_OK)
    return give_error(error, cleared, "out_conformed is NULL, or its struct_size is wrong");
  if (MienStatus status = check_document(document, error)) return status;
  if (!positions && position_count != 0)
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "positions is NULL");
  if (MienStatus status = check_fields({{"others", others, 1}}, error)) return status;
  Error detail;
  author::ConformResult result;
  const Status status = author::conform(document->document, mesh, positions, position_count,
                                        others != 0, result, detail);
  if (status == Status::kOk) {
    MienConformed conformed = {};
    conformed.joint_distance = result.farthest_joint;
    conformed.joint = result.joint;
    write_struct(out_conformed, conformed);
  }
  return finish(status, detail, error);
}

MienStatus mien_document_transplant(MienDocument* document, const MienDocument* rig,
                                    const MienTransplantDesc* desc, MienControlError* out_errors,
                                    size_t capacity, size_t* out_count, MienError* error) {
  if (MienStatus status = clear_output(out_count, error)) return status;
  if (MienStatus status = check_documents(document, rig, error)) return status;
  MienTransplantDesc known;
  if (MienStatus status = read_desc(desc, known, "MienTransplantDesc", error)) return status;
  if (MienStatus status =
          check_fields({{"MienTransplantDesc.match", known.match, MIEN_MATCH_UV}}, error))
    return status;
  if (!out_errors && capacity != 0)
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "out_errors is NULL");
  author::Transplant how;
  how.match = static_cast<author::Match>(known.match);
  if (known.influences != 0) how.influences = known.influences;
  const Allocator& allocator = document->document.allocator();
  Arena arena(allocator);
  const size_t most = capacity < 65536 ? capacity : 65536;
  const Span<author::ControlError> found = arena.array<author::ControlError>(most);
  if (found.count != most)
    return give_error(error, MIEN_ERROR_MEMORY, "no memory for %zu errors", most);
  Error detail;
  uint32_t count = 0;
  const Status status =
      author::transplant(document->document, rig->document, how, found, count, detail);
  for (uint32_t i = 0; status == Status::kOk && i < count; ++i) {
    out_errors[i] = {found[i].worst, found[i].rms, found[i].moved, found[i].control, 0};
  }
  if (status == Status::kOk) *out_count = count;
  return finish(status, detail, error);
}
