// SPDX-License-Identifier: MIT
// Documents: operations. mien_author.h is the manual.
#include "author/capi/document.h"
#include "author/document/elements.h"
#include "author/document/geometry.h"
#include "author/document/lods.h"
#include "author/document/prune_joints.h"
#include "author/document/skin.h"
#include "capi/arguments/systems.h"

using namespace mien;
using namespace mien::capi;
using author::Document;
using author::Kind;

namespace {

/// Calls edit(document, detail).
template <class Edit>
MienStatus edited(MienDocument* document, MienError* error, const Edit& edit) {
  if (MienStatus status = check_document(document, error)) return status;
  Error detail;
  return finish(edit(document->document, detail), detail, error);
}

MienStatus check_array(const void* array, size_t count, const char* name, MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (!array && count != 0) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "%s is NULL, but its count is not 0", name);
  }
  if (count > UINT32_MAX / 4) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "%s: a count of %zu is more than a file can have", name, count);
  }
  return MIEN_OK;
}

MienStatus read_kind(uint32_t kind, Kind& out, MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  switch (kind) {
    case MIEN_KIND_GUI_CONTROL: out = Kind::kGuiControl; return MIEN_OK;
    case MIEN_KIND_RAW_CONTROL: out = Kind::kRawControl; return MIEN_OK;
    case MIEN_KIND_PSD_CONTROL: out = Kind::kPsdControl; return MIEN_OK;
    case MIEN_KIND_ML_CONTROL: out = Kind::kMlControl; return MIEN_OK;
    case MIEN_KIND_RBF_CONTROL: out = Kind::kRbfControl; return MIEN_OK;
    case MIEN_KIND_JOINT: out = Kind::kJoint; return MIEN_OK;
    case MIEN_KIND_BLEND_SHAPE_CHANNEL: out = Kind::kChannel; return MIEN_OK;
    case MIEN_KIND_ANIMATED_MAP: out = Kind::kMap; return MIEN_OK;
    case MIEN_KIND_MESH: out = Kind::kMesh; return MIEN_OK;
    default: break;
  }
  return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                    "kind is %u; elements of documents are controls, joints, blend shape channels, "
                    "animated maps and meshes",
                    kind);
}

}  // namespace

MienStatus mien_document_find(const MienDocument* document, uint32_t kind, const char* name,
                              uint32_t* out_index, MienError* error) {
  if (MienStatus status = clear_output(out_index, error)) return status;
  if (MienStatus status = check_document(document, error)) return status;
  Kind known = Kind::kMesh;
  if (MienStatus status = read_kind(kind, known, error)) return status;
  if (!name) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "name is NULL");
  Error detail;
  return finish(
      author::find_element(document->document, known, name, strlen(name), *out_index, detail),
      detail, error);
}

MienStatus mien_document_rename(MienDocument* document, uint32_t kind, uint32_t index,
                                const char* name, MienError* error) {
  Kind known = Kind::kMesh;
  if (MienStatus status = read_kind(kind, known, error)) return status;
  if (!name) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "name is NULL");
  return edited(document, error, [&](Document& of, Error& detail) {
    return author::rename_element(of, known, index, name, strlen(name), detail);
  });
}

MienStatus mien_document_remove(MienDocument* document, uint32_t kind, const uint32_t* indices,
                                size_t index_count, MienError* error) {
  Kind known = Kind::kMesh;
  if (MienStatus status = read_kind(kind, known, error)) return status;
  if (MienStatus status = check_array(indices, index_count, "indices", error)) return status;
  return edited(document, error, [&](Document& of, Error& detail) {
    return author::remove_elements(of, known, {indices, index_count}, detail);
  });
}

MienStatus mien_document_clear(MienDocument* document, uint32_t kind, MienError* error) {
  Kind known = Kind::kMesh;
  if (MienStatus status = read_kind(kind, known, error)) return status;
  return edited(document, error,
                [&](Document& of, Error& detail) { return author::clear_all(of, known, detail); });
}

MienStatus mien_document_clear_joints(MienDocument* document, const uint32_t* joints,
                                      size_t joint_count, MienError* error) {
  if (MienStatus status = check_array(joints, joint_count, "joints", error)) return status;
  return edited(document, error, [&](Document& of, Error& detail) {
    return author::clear_joint_animation(of, {joints, joint_count}, detail);
  });
}

MienStatus mien_document_set_neutral(MienDocument* document, uint32_t first_joint,
                                     const float* translations, const float* rotations,
                                     size_t count, MienError* error) {
  if (MienStatus status = check_array(document, count, "document", error)) return status;
  return edited(document, error, [&](Document& of, Error& detail) {
    return author::set_neutral(of, first_joint, static_cast<uint32_t>(count), translations,
                               rotations, detail);
  });
}

MienStatus mien_document_set_positions(MienDocument* document, uint32_t mesh,
                                       const float* positions, size_t position_count,
                                       MienError* error) {
  if (MienStatus status = check_array(positions, position_count, "positions", error)) return status;
  return edited(document, error, [&](Document& of, Error& detail) {
    return author::set_positions(of, mesh, positions, position_count, detail);
  });
}

MienStatus mien_document_set_target(MienDocument* document, uint32_t mesh, uint32_t channel,
                                    const uint32_t* vertices, const float* deltas, size_t count,
                                    MienError* error) {
  if (MienStatus status = check_array(deltas, count, "deltas", error)) return status;
  return edited(document, error, [&](Document& of, Error& detail) {
    return author::set_target(of, mesh, channel, vertices, deltas, count, detail);
  });
}

MienStatus mien_document_prune_targets(MienDocument* document, float tolerance,
                                       MienPrunedTargets* out_pruned, MienError* error) {
  const MienStatus cleared = clear_struct(out_pruned);
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (cleared != MIEN_OK)
    return give_error(error, cleared, "out_pruned is NULL, or its struct_size is wrong");
  MienPrunedTargets pruned = {};
  const MienStatus status = edited(document, error, [&](Document& of, Error& detail) {
    return author::prune_targets(of, tolerance, pruned.deltas, pruned.targets, detail);
  });
  if (status == MIEN_OK) write_struct(out_pruned, pruned);
  return status;
}

MienStatus mien_document_prune_joints(MienDocument* document, const MienPruneJointsDesc* desc,
                                      MienPrunedJoints* out_pruned, MienError* error) {
  const MienStatus cleared = clear_struct(out_pruned);
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (cleared != MIEN_OK)
    return give_error(error, cleared, "out_pruned is NULL, or its struct_size is wrong");
  if (!desc) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "desc is NULL");
  MienPruneJointsDesc known;
  if (MienStatus status = read_desc(desc, known, "MienPruneJointsDesc", error)) return status;
  if (MienStatus status =
          check_fields({{"MienPruneJointsDesc.reserved", known.reserved, 0}}, error))
    return status;
  author::PrunedJoints pruned;
  const MienStatus status = edited(document, error, [&](Document& of, Error& detail) {
    return author::prune_joint_matrix(of, {known.translation, known.rotation, known.scale}, pruned,
                                      detail);
  });
  if (status != MIEN_OK) return status;
  MienPrunedJoints result = {};
  result.entry_count = pruned.entries;
  result.removed_count = pruned.removed;
  result.worst_distance = pruned.worst.distance;
  result.worst_control = pruned.worst.control;
  result.worst_mesh = pruned.worst.mesh;
  result.worst_position = pruned.worst.position;
  write_struct(out_pruned, result);
  return MIEN_OK;
}

MienStatus mien_document_set_weights(MienDocument* document, uint32_t mesh, uint32_t influences,
                                     const uint16_t* joints, const float* weights,
                                     size_t weight_count, MienError* error) {
  if (MienStatus status = check_array(joints, weight_count, "joints", error)) return status;
  if (MienStatus status = check_array(weights, weight_count, "weights", error)) return status;
  if (influences == 0 || weight_count % influences != 0) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "%zu weights are not rows of %u influences", weight_count, influences);
  }
  return edited(document, error, [&](Document& of, Error& detail) {
    return author::set_skin_weights(of, mesh, joints, weights, weight_count / influences,
                                    influences, detail);
  });
}

MienStatus mien_document_normalize_weights(MienDocument* document, uint32_t mesh,
                                           MienError* error) {
  return edited(document, error, [&](Document& of, Error& detail) {
    return author::normalize_skin_weights(of, mesh, detail);
  });
}

MienStatus mien_document_limit_influences(MienDocument* document, uint32_t mesh,
                                          uint32_t influences, MienError* error) {
  return edited(document, error, [&](Document& of, Error& detail) {
    return author::limit_influences(of, mesh, influences, detail);
  });
}

MienStatus mien_document_smooth_weights(MienDocument* document, uint32_t mesh, uint32_t iterations,
                                        float strength, uint32_t influences, MienError* error) {
  return edited(document, error, [&](Document& of, Error& detail) {
    return author::smooth_skin_weights(of, mesh, iterations, strength, influences, detail);
  });
}

MienStatus mien_document_place(MienDocument* document, const MienPlacement* placement,
                               MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (!placement) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "placement is NULL");
  MienPlacement known;
  if (MienStatus status = read_desc(placement, known, "MienPlacement", error)) return status;
  author::CharacterPlacement given;
  if (known.scale != 0) given.scale = known.scale;
  for (int k = 0; k < 3; ++k) {
    given.rotation[k] = known.rotation[k];
    given.translation[k] = known.translation[k];
  }
  return edited(document, error, [&](Document& of, Error& detail) {
    return author::place_character(of, given, detail);
  });
}

MienStatus mien_document_keep_lods(MienDocument* document, uint64_t lods, MienError* error) {
  return edited(document, error,
                [&](Document& of, Error& detail) { return author::keep_lods(of, lods, detail); });
}

MienStatus mien_document_convert(MienDocument* document, const MienCoordinateSystem* system,
                                 MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (!system) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "system is NULL");
  CoordinateSystem known;
  if (MienStatus status = read_system(system, known, error)) return status;
  return edited(document, error, [&](Document& of, Error& detail) {
    return author::convert_document(of, known, detail);
  });
}
