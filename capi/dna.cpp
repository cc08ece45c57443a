// SPDX-License-Identifier: MIT
// mien/dna.h, except the section "DNA: validating".
#include "capi/arguments/fields.h"
#include "capi/arguments/systems.h"
#include "capi/dna_handle.h"
#include "runtime/load/dna/check/check_written.h"
#include "runtime/load/dna/dna_reader.h"
#include "runtime/load/dna/format/dna_writer.h"

using namespace mien;
using namespace mien::capi;
using dna::DnaView;

static_assert(MIEN_ERROR_ISA == int(Status::kIsa) && MIEN_ERROR_MEMORY == int(Status::kMemory) &&
                  MIEN_ERROR_FILE_WRITE == int(Status::kFileWrite) &&
                  MIEN_ERROR_DNA_SIGNATURE == int(Status::kDnaSignature) &&
                  MIEN_ERROR_DNA_LAYER == int(Status::kDnaLayer) &&
                  MIEN_ERROR_DNA_VALUE == int(Status::kDnaValue),
              "status.h and mien.h number the same things");
static_assert(MIEN_LAYER_TWIST_SWING_BEHAVIOR == int(dna::kLayerTwistSwing) &&
                  MIEN_LAYER_MACHINE_LEARNED_BEHAVIOR == int(dna::kLayerMachineLearned),
              "dna_view.h and mien.h number the same layers");
static_assert(sizeof(MienError::message) == sizeof(Error::message), "messages are copied whole");

namespace {

struct OpenArguments {
  MienDnaDesc desc;
  Allocator allocator;
  dna::ReadOptions options;
  CoordinateSystem system;  // if options point here
};

MienStatus read_open_arguments(const MienDnaDesc* desc, OpenArguments& out, MienError* error) {
  if (MienStatus status = read_desc(desc, out.desc, "MienDnaDesc", error)) return status;
  if (MienStatus status = read_allocator(out.desc.allocator, out.allocator, error)) return status;
  if (out.desc.layers & ~uint32_t{dna::kLayersAll}) {
    return give_error(error, MIEN_ERROR_INVALID_ARGUMENT,
                      "MienDnaDesc.layers is 0x%x, which has bits that are not a MIEN_LAYER_...",
                      out.desc.layers);
  }
  const MienStatus in_range = check_fields(
      {{"MienDnaDesc.unknown_layers", out.desc.unknown_layers, MIEN_UNKNOWN_LAYERS_DROP},
       {"MienDnaDesc.file_access", out.desc.file_access, MIEN_FILE_READ},
       {"MienDnaDesc.skip_blend_shape_targets", out.desc.skip_blend_shape_targets, 1}},
      error);
  if (in_range != MIEN_OK) return in_range;
  out.options.layers = out.desc.layers ? out.desc.layers : uint32_t{dna::kLayersAll};
  out.options.skip_blend_shape_targets = out.desc.skip_blend_shape_targets != 0;
  out.options.keep_unknown = out.desc.unknown_layers == MIEN_UNKNOWN_LAYERS_KEEP;
  out.options.lods = out.desc.lods;
  if (!out.desc.system) return MIEN_OK;
  out.options.system = &out.system;
  return read_system(out.desc.system, out.system, error);
}

}  // namespace

MienStatus mien_dna_open_file(const char* path, const MienDnaDesc* desc, MienDna** out_dna,
                              MienError* error) {
  if (MienStatus status = clear_output(out_dna, error)) return status;
  if (!path) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "path is NULL");
  OpenArguments arguments;
  if (MienStatus status = read_open_arguments(desc, arguments, error)) return status;
  dna::DnaFile* dna = nullptr;
  Error detail;
  const Status status =
      dna::open_dna_file(path, static_cast<FileAccess>(arguments.desc.file_access),
                         arguments.options, arguments.allocator, dna, detail);
  return give_object(status, dna, detail, out_dna, error);
}

MienStatus mien_dna_open_memory(const void* bytes, size_t size, const MienDnaDesc* desc,
                                MienDna** out_dna, MienError* error) {
  if (MienStatus status = clear_output(out_dna, error)) return status;
  if (!bytes && size != 0) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "bytes is NULL");
  OpenArguments arguments;
  if (MienStatus status = read_open_arguments(desc, arguments, error)) return status;
  dna::DnaFile* dna = nullptr;
  Error detail;
  const Status status = dna::open_dna_memory({static_cast<const uint8_t*>(bytes), size},
                                             arguments.options, arguments.allocator, dna, detail);
  return give_object(status, dna, detail, out_dna, error);
}

MienStatus mien_dna_open_stream(const MienStream* stream, const MienDnaDesc* desc,
                                MienDna** out_dna, MienError* error) {
  if (MienStatus status = clear_output(out_dna, error)) return status;
  if (!stream || !stream->read) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "stream or stream->read is NULL");
  }
  OpenArguments arguments;
  if (MienStatus status = read_open_arguments(desc, arguments, error)) return status;
  dna::DnaFile* dna = nullptr;
  Error detail;
  const Status status = dna::open_dna_stream({stream->user, stream->size, stream->read},
                                             arguments.options, arguments.allocator, dna, detail);
  return give_object(status, dna, detail, out_dna, error);
}

void mien_dna_close(MienDna* dna) { destroy(dna); }

// Looking into it ---------------------------------------------------------------------------------

MienStatus mien_dna_info(const MienDna* dna, MienDnaInfo* out_info) {
  if (MienStatus status = clear_struct(out_info)) return status;
  if (MienStatus status = check(dna)) return status;
  const dna::DnaFile& of = *object(dna);
  const DnaView& view = of.view;
  MienDnaInfo info = {};
  info.generation = view.generation;
  info.version = view.version;
  info.layers = view.loaded;
  info.file_bytes = view.file_size;
  info.memory_bytes = of.block_size + of.arena.reserved() + of.file.capacity;
  info.has_blend_shape_targets = view.has(dna::kLayerGeometry) && !view.lacks_blend_shape_targets;
  info.is_mapped = of.file.mapped;
  info.layer_count = view.index.count;
  info.translation_unit = view.desc.translation_unit;
  info.rotation_unit = view.desc.rotation_unit;
  info.axes[0] = view.desc.coordinate_system.x_axis;
  info.axes[1] = view.desc.coordinate_system.y_axis;
  info.axes[2] = view.desc.coordinate_system.z_axis;
  info.rotation_sequence = view.dsce.rotation_sequence;
  info.rotation_signs[0] = view.dsce.rotation_sign.x;
  info.rotation_signs[1] = view.dsce.rotation_sign.y;
  info.rotation_signs[2] = view.dsce.rotation_sign.z;
  info.face_winding = view.dsce.face_winding_order;
  info.lod_count = view.desc.lod_count;
  info.max_lod = view.desc.max_lod;
  info.gui_control_count = view.defn.gui_control_names.count;
  info.raw_control_count = view.defn.raw_control_names.count;
  info.psd_control_count = view.bhvr.controls.psd_count;
  info.ml_control_count = view.ml_control_count;
  info.rbf_control_count = view.rbfe.pose_control_names.count;
  info.joint_count = view.defn.joint_names.count;
  info.joint_group_count = view.bhvr.joints.groups.count;
  info.blend_shape_channel_count = view.defn.channel_names.count;
  info.animated_map_count = view.defn.map_names.count;
  info.mesh_count = view.defn.mesh_names.count;
  info.neural_network_count = view.mlbh.networks.count;
  info.rbf_solver_count = view.rbfb.solvers.count;
  info.rbf_pose_count = view.rbfb.poses.count;
  info.twist_count = view.twsw.twists.count;
  info.swing_count = view.twsw.swings.count;
  info.metadata_count = view.desc.metadata.count;
  write_struct(out_info, info);
  return MIEN_OK;
}

MienStatus mien_dna_layer(const MienDna* dna, uint32_t index, MienDnaLayer* out_layer) {
  if (MienStatus status = clear_struct(out_layer)) return status;
  if (MienStatus status = check(dna)) return status;
  const DnaView& view = object(dna)->view;
  if (index >= view.index.count) return MIEN_ERROR_INDEX;
  const dna::IndexEntry& entry = view.index[index];
  const dna::LayerKind* kind = dna::find_layer_kind(entry.code, entry.layer_version);
  MienDnaLayer layer = {};
  store_big_endian(reinterpret_cast<uint8_t*>(layer.code), entry.code);
  layer.layer = kind ? kind->loaded_by : uint32_t{MIEN_LAYER_UNKNOWN};
  layer.version_major = entry.layer_version >> 16;
  layer.version_minor = entry.layer_version & 0xFFFF;
  layer.byte_offset = entry.offset;
  layer.byte_count = entry.size;
  layer.is_loaded = kind && view.has(kind->loaded_by);
  write_struct(out_layer, layer);
  return MIEN_OK;
}

MienStatus mien_dna_field(const MienDna* dna, const char* path, MienDnaField* out_field,
                          MienError* error) {
  return mien_dna_field_n(dna, path, length_of(path), out_field, error);
}

MienStatus mien_dna_field_n(const MienDna* dna, const char* path, size_t path_count,
                            MienDnaField* out_field, MienError* error) {
  if (MienStatus status = clear_field(out_field, error)) return status;
  if (MienStatus status = check(dna, "dna", error)) return status;
  return describe_field(object(dna)->view, path, path_count, out_field, error);
}

MienStatus mien_dna_child_name(const MienDna* dna, const char* path, uint32_t index,
                               MienStringView* out_name, MienError* error) {
  return mien_dna_child_name_n(dna, path, length_of(path), index, out_name, error);
}

MienStatus mien_dna_child_name_n(const MienDna* dna, const char* path, size_t path_count,
                                 uint32_t index, MienStringView* out_name, MienError* error) {
  if (MienStatus status = clear_output(out_name, error)) return status;
  if (MienStatus status = check(dna, "dna", error)) return status;
  return name_field(object(dna)->view, path, path_count, index, out_name, error);
}

MienStatus mien_dna_read_floats(const MienDna* dna, const char* path, uint64_t first,
                                uint64_t count, float* out, MienError* error) {
  return mien_dna_read_floats_n(dna, path, length_of(path), first, count, out, error);
}

MienStatus mien_dna_read_floats_n(const MienDna* dna, const char* path, size_t path_count,
                                  uint64_t first, uint64_t count, float* out, MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (MienStatus status = check(dna, "dna", error)) return status;
  return read_field({object(dna)->view, "mien_dna"}, path, path_count, first, count, out, error);
}

MienStatus mien_dna_read_integers(const MienDna* dna, const char* path, uint64_t first,
                                  uint64_t count, int64_t* out, MienError* error) {
  return mien_dna_read_integers_n(dna, path, length_of(path), first, count, out, error);
}

MienStatus mien_dna_read_integers_n(const MienDna* dna, const char* path, size_t path_count,
                                    uint64_t first, uint64_t count, int64_t* out,
                                    MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (MienStatus status = check(dna, "dna", error)) return status;
  return read_field({object(dna)->view, "mien_dna"}, path, path_count, first, count, out, error);
}

MienStatus mien_dna_read_string(const MienDna* dna, const char* path, MienStringView* out_string,
                                MienError* error) {
  return mien_dna_read_string_n(dna, path, length_of(path), out_string, error);
}

MienStatus mien_dna_read_string_n(const MienDna* dna, const char* path, size_t path_count,
                                  MienStringView* out_string, MienError* error) {
  if (MienStatus status = clear_output(out_string, error)) return status;
  if (MienStatus status = check(dna, "dna", error)) return status;
  return read_field({object(dna)->view, "mien_dna"}, path, path_count, out_string, error);
}

// Writing -----------------------------------------------------------------------------------------

namespace {

MienStatus plan_write(const MienDna* dna, const MienWriteDesc* desc, dna::WriteOptions& options,
                      size_t& size, MienError* error) {
  if (MienStatus status = check(dna, "dna", error)) return status;
  MienWriteDesc known;
  if (MienStatus status = read_desc(desc, known, "MienWriteDesc", error)) return status;
  const MienStatus in_range = check_fields(
      {{"MienWriteDesc.version", known.version, 8},
       {"MienWriteDesc.unknown_layers", known.unknown_layers, MIEN_UNKNOWN_LAYERS_DROP}},
      error);
  if (in_range != MIEN_OK) return in_range;
  options.version =
      known.version ? static_cast<uint16_t>(known.version) : object(dna)->view.version;
  options.keep_unknown = known.unknown_layers == MIEN_UNKNOWN_LAYERS_KEEP;
  Arena arena(object(dna)->allocator);
  Error detail;
  if (dna::check_written(object(dna)->view, options, arena, detail) != Status::kOk) {
    return give_error(detail, error);
  }
  size = static_cast<size_t>(dna::encoded_size(object(dna)->view, options));
  return MIEN_OK;
}

}  // namespace

MienStatus mien_dna_write_file(const MienDna* dna, const char* path, const MienWriteDesc* desc,
                               MienError* error) {
  if (check_error(error) != MIEN_OK) return MIEN_ERROR_STRUCT_SIZE;
  if (!path) return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "path is NULL");
  dna::WriteOptions options;
  size_t size = 0;
  if (MienStatus status = plan_write(dna, desc, options, size, error)) return status;
  uint8_t* bytes = static_cast<uint8_t*>(object(dna)->allocator.get(size, kBlockAlignment));
  if (!bytes) {
    return give_error(error, MIEN_ERROR_MEMORY, "no memory for a file of %zu bytes", size);
  }
  dna::encode(object(dna)->view, options, bytes);
  Error detail;
  const Status status = write_file(path, bytes, size, object(dna)->allocator, detail);
  object(dna)->allocator.put(bytes, size, kBlockAlignment);
  return give_status(status, detail, error);
}

MienStatus mien_dna_write_memory(const MienDna* dna, const MienWriteDesc* desc, void* buffer,
                                 size_t capacity, size_t* out_size, MienError* error) {
  if (MienStatus status = clear_output(out_size, error)) return status;
  if (!buffer && capacity != 0) {
    return give_error(error, MIEN_ERROR_NULL_ARGUMENT, "buffer is NULL");
  }
  dna::WriteOptions options;
  size_t size = 0;
  if (MienStatus status = plan_write(dna, desc, options, size, error)) return status;
  *out_size = size;
  if (!buffer) return succeed(error);
  if (capacity < size) {
    return give_error(
        error, MIEN_ERROR_INVALID_ARGUMENT,
        "the file has %zu bytes, the buffer %zu: call again with a buffer of this size", size,
        capacity);
  }
  dna::encode(object(dna)->view, options, static_cast<uint8_t*>(buffer));
  return succeed(error);
}
