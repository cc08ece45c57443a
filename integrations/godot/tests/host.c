/* SPDX-License-Identifier: MIT
 * Runs the extension for Godot 4 in a host that plays Godot: the editor imports files; a node takes a rig, controls and
 * nodes to drive as properties, and by methods as GDScript calls them. What a skeleton, blend shapes and vertex buffers got
 * is what the library computes. No value, object or reference may be left.
 *
 *     godot_test FOLDER */
#include "host.h"

#include <math.h>
#include <mien_author.h>
#include <stdio.h>

uint8_t mien_godot_init(GdGetProcAddress get, void* owner, GdInitialization* initialization);

/* The same rig with the library alone, in Godot's axes. */
static MienDna* dna;
static MienRig* rig;
static MienDeformer* deformer;
static MienInstance* instance;
static MienDeformerInstance* pose;
static char dna_path[1200], rig_path[1200], asset_path[1200], broken_path[1200], crowded_path[1200];

static void write_bytes(const char* path, const void* bytes, size_t size) {
  FILE* file = fopen(path, "wb");
  assert(file && fwrite(bytes, 1, size, file) == size && fclose(file) == 0);
}

static void make_files(void) {
  snprintf(dna_path, sizeof dna_path, "%s/godot_test.dna", project_folder);
  snprintf(rig_path, sizeof rig_path, "%s/godot_test.rig", project_folder);
  snprintf(asset_path, sizeof asset_path, "%s/godot_test.UAsset", project_folder);
  snprintf(broken_path, sizeof broken_path, "%s/godot_test_broken.uasset", project_folder);
  snprintf(crowded_path, sizeof crowded_path, "%s/godot_test_crowded.uasset", project_folder);
  MienGenerateDesc generate = mien_generate_desc_default();
  generate.preset = MIEN_PRESET_SMALL;
  MienDna* made;
  size_t size = 0;
  assert(mien_dna_generate(&generate, &made, NULL) == MIEN_OK);
  assert(mien_dna_write_file(made, dna_path, NULL, NULL) == MIEN_OK);
  assert(mien_dna_write_memory(made, NULL, NULL, 0, &size, NULL) == MIEN_OK);
  /* An asset: other bytes, among them the beginning of a DNA that is none, then the DNA, then others. */
  unsigned char* bytes = calloc(size + 300, 1);
  assert(bytes);
  memcpy(bytes + 50, "DNA\0\2\0\1", 7);
  assert(mien_dna_write_memory(made, NULL, bytes + 100, size, &size, NULL) == MIEN_OK);
  memset(bytes + 100 + size, 0xcd, 200);
  write_bytes(asset_path, bytes, size + 300);
  write_bytes(broken_path, bytes, 90);
  /* As many beginnings as are tried, and the DNA behind them. */
  unsigned char* crowded = calloc(size + 1000, 1);
  assert(crowded);
  for (size_t i = 0; i < 64; ++i) memcpy(crowded + 10 * i, "DNA\0\2", 5);
  memcpy(crowded + 700, bytes + 100, size);
  write_bytes(crowded_path, crowded, size + 1000);
  free(crowded);
  free(bytes);
  mien_dna_close(made);
  MienCoordinateSystem system = mien_coordinate_system_default();
  assert(mien_coordinate_system_find("godot", &system) == MIEN_OK);
  MienDnaDesc desc = mien_dna_desc_default();
  desc.system = &system;
  assert(mien_dna_open_file(dna_path, &desc, &dna, NULL) == MIEN_OK);
  assert(mien_rig_create(dna, NULL, &rig, NULL) == MIEN_OK);
  assert(mien_deformer_create(dna, rig, NULL, &deformer, NULL) == MIEN_OK);
  assert(mien_instance_create(rig, NULL, &instance, NULL) == MIEN_OK);
  assert(mien_deformer_instance_create(deformer, NULL, &pose, NULL) == MIEN_OK);
  assert(mien_bake_file(rig, deformer, rig_path, NULL) == MIEN_OK);
}

static void remove_files(void) {
  remove(dna_path), remove(rig_path), remove(asset_path), remove(broken_path), remove(crowded_path);
  mien_deformer_instance_destroy(pose);
  mien_instance_destroy(instance);
  mien_deformer_destroy(deformer);
  mien_rig_destroy(rig);
  mien_dna_close(dna);
}

static uint32_t count_of(uint32_t kind) {
  uint32_t count;
  assert(mien_rig_count(rig, kind, &count) == MIEN_OK);
  return count;
}

static const char* name_in(uint32_t kind, uint32_t index) {
  MienStringView view;
  assert(mien_rig_name(rig, kind, index, &view) == MIEN_OK);
  char* name = malloc(view.count + 1);
  assert(name);
  memcpy(name, view.data, view.count);
  name[view.count] = 0;
  return name;
}

/* ---- calls as GDScript makes them: with variants, or with pointers where types are known ------------- */

static int64_t call(Object* node, const char* name, int with_pointers, const void* first,
                    const void* second) {
  const void* values[2] = {first, second};
  const GdMethodInfo* info = find_method(node, name);
  int64_t number = 0;
  if (with_pointers) {
    info->ptrcall(info->method_userdata, node->instance, values, &number);
    return number;
  }
  GdVariant arguments[2], result = {{0}}, wrong = {{GD_NIL}};
  const GdVariant *list[2] = {&arguments[0], &arguments[1]},
                  *wrong_list[2] = {&wrong, &arguments[1]};
  GdCallError error = {0, 0, 0};
  const int64_t count = info->argument_count;
  for (int64_t i = 0; i < count; ++i) make(&arguments[i], info->arguments[i].type, values[i]);
  info->call(info->method_userdata, node->instance, list, count - 1, &result, &error);
  assert(error.error == GD_CALL_TOO_FEW);
  info->call(info->method_userdata, node->instance, wrong_list, count, &result, &error);
  assert(error.error == GD_CALL_INVALID_ARGUMENT && error.argument == 0);
  info->call(info->method_userdata, node->instance, list, count, &result, &error);
  assert(error.error == GD_CALL_OK);
  take(&number, info->result->type, &result);
  for (int64_t i = 0; i < count; ++i) variant_destroy(&arguments[i]);
  variant_destroy(&result);
  return number;
}

static int64_t call_with_text(Object* node, const char* name, int with_pointers, const char* text,
                              const void* second) {
  GdString string;
  string_new(&string, text);
  const int64_t number = call(node, name, with_pointers, &string, second);
  string_destroy(&string);
  return number;
}

static uint8_t set_value(Object* node, const char* name, int32_t type, const void* value) {
  GdVariant variant;
  make(&variant, type, value);
  const uint8_t is_set = set_property(node, name, &variant);
  variant_destroy(&variant);
  return is_set;
}

static void set_path(Object* node, const char* name, Object* target) {
  char text[32];
  GdString string;
  snprintf(text, sizeof text, "%p", (void*)target);
  string_new(&string, text);
  assert(set_value(node, name, GD_NODE_PATH, &string));
  string_destroy(&string);
}

/* ---- what the library computes ---------------------------------------------------------------------- */

static float control_at(uint32_t control, uint32_t frame) {
  return (float)((control * 7 + frame * 3) % 11) / 10;
}

static void evaluate_alone(uint32_t frame) {
  MienMutableFloatView controls;
  assert(mien_instance_raw_controls(instance, &controls) == MIEN_OK);
  for (uint32_t c = 0; c < controls.count; ++c) controls.data[c] = control_at(c, frame);
  assert(mien_rig_evaluate(rig, instance, 0) == MIEN_OK);
  assert(mien_deformer_instance_update(pose, instance) == MIEN_OK);
}

static void compare_targets(const Object* skeleton, const Object* mesh) {
  float transforms[MAX_TARGETS * 10];
  MienFloatView weights;
  assert(mien_deformer_instance_local_transforms(pose, transforms, sizeof transforms / 4) ==
         MIEN_OK);
  assert(mien_instance_blend_shapes(instance, &weights) == MIEN_OK);
  for (int i = 0; i < skeleton->count; ++i)
    assert(!memcmp(skeleton->values[i], transforms + 10 * (skeleton->count - 1 - i), 40));
  int moved = 0;
  for (int i = 0; i < mesh->count; ++i) {
    assert(mesh->values[i][0] == weights.data[mesh->count - 1 - i]);
    moved += mesh->values[i][0] != 0;
  }
  assert(moved != 0);
}

/* The direction that 2 x 16 bits stand for, on the octahedron. */
static void decode_normal(const unsigned char* bits, double* out) {
  uint16_t raw[2];
  memcpy(raw, bits, 4);
  const double x = raw[0] / 65535. * 2 - 1, y = raw[1] / 65535. * 2 - 1;
  const double z = 1 - fabs(x) - fabs(y), fold = z < 0 ? -z : 0;
  const double v[3] = {x + (x >= 0 ? -fold : fold), y + (y >= 0 ? -fold : fold), z};
  const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  for (int k = 0; k < 3; ++k) out[k] = v[k] / length;
}

/* Faces are wound as Godot draws them, clockwise seen from outside, and v is counted from the top. */
static void compare_surface(const Object* array_mesh, const MienMesh* neutral) {
  double outward = 0;
  assert(array_mesh->index_count == (size_t)3 * neutral->triangle_count);
  for (size_t t = 0; t < array_mesh->index_count; t += 3) {
    const float* corners[3];
    for (size_t k = 0; k < 3; ++k) {
      const int32_t vertex = array_mesh->indices[t + k];
      corners[k] =
          neutral->positions.data + (size_t)3 * neutral->vertex_position_indices.data[vertex];
    }
    const float* normal = neutral->normals.data + 3 * array_mesh->indices[t];
    for (int k = 0; k < 3; ++k) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      outward +=
          (double)normal[k] *
          ((double)(corners[1][a] - corners[0][a]) * (double)(corners[2][b] - corners[0][b]) -
           (double)(corners[1][b] - corners[0][b]) * (double)(corners[2][a] - corners[0][a]));
    }
  }
  assert(outward < 0);
  for (size_t v = 0; v < neutral->vertex_count; ++v) {
    assert(array_mesh->texture_coordinates[2 * v] == neutral->texture_coordinates.data[2 * v]);
    assert(array_mesh->texture_coordinates[2 * v + 1] ==
           1 - neutral->texture_coordinates.data[2 * v + 1]);
  }
}

/* The vertex buffer of a MeshInstance3D has a mesh of the rig as it is deformed now. */
static void compare_vertices(const Object* mesh_instance, uint32_t mesh) {
  Object* array_mesh;
  MienMesh neutral = mien_mesh_default();
  MienFloatView positions, normals;
  assert(mesh_instance->has_mesh);
  take(&array_mesh, GD_OBJECT, &mesh_instance->mesh);
  assert(mien_deformer_mesh(deformer, mesh, &neutral) == MIEN_OK);
  assert(mien_deformer_instance_deform(pose, mesh, MIEN_NORMALS_DEFAULT, NULL) == MIEN_OK);
  assert(mien_deformer_instance_positions(pose, mesh, &positions) == MIEN_OK);
  assert(mien_deformer_instance_normals(pose, mesh, &normals) == MIEN_OK);
  assert(array_mesh->vertex_count == neutral.vertex_count && array_mesh->update_count > 0);
  compare_surface(array_mesh, &neutral);
  int moved = 0;
  for (uint32_t v = 0; v < neutral.vertex_count; ++v) {
    const size_t p = neutral.vertex_position_indices.data[v];
    double normal[3];
    assert(!memcmp(array_mesh->buffer + (size_t)12 * v, positions.data + 3 * p, 12));
    moved += memcmp(neutral.positions.data + 3 * p, positions.data + 3 * p, 12) != 0;
    decode_normal(array_mesh->buffer + 12 * array_mesh->vertex_count + (size_t)4 * v, normal);
    for (int k = 0; k < 3; ++k)
      assert(fabs(normal[k] - (double)normals.data[(size_t)3 * v + (size_t)k]) < 2e-4);
  }
  assert(moved != 0);
}

/* In another order, and without the last. */
static Object* make_target(const char* class_name, uint32_t kind) {
  Object* object = construct(class_name);
  const uint32_t count = count_of(kind);
  assert(count > 2 && count < MAX_TARGETS);
  for (uint32_t i = 0; i + 1 < count; ++i) object->names[i] = name_in(kind, count - 2 - i);
  object->count = (int)count - 1;
  return object;
}

static void free_target(Object* object) {
  for (int i = 0; i < object->count; ++i) free((void*)(uintptr_t)object->names[i]);
  free_object(object);
}

/* ---- methods ---------------------------------------------------------------------------------------- */

static void test_methods(void) {
  Object *node = construct("MienFace3D"), *none = NULL;
  Object* skeleton = make_target("Skeleton3D", MIEN_KIND_JOINT);
  Object* mesh = make_target("MeshInstance3D", MIEN_KIND_BLEND_SHAPE_CHANNEL);
  const int64_t lod = 0, no_lod = 99;
  const double half = 0.5;
  errors = 0;
  assert(!call(node, "evaluate", 0, &lod, NULL) &&
         !call(node, "drive_skeleton", 0, &skeleton, NULL));
  assert(call_with_text(node, "open", 0, "no such file.dna", NULL) == MIEN_ERROR_FILE_OPEN);
  assert(call_with_text(node, "open", 1, "no such file.rig", NULL) != MIEN_OK);
  assert(call_with_text(node, "open", 1, "no such file.uasset", NULL) == MIEN_ERROR_FILE_OPEN);
  assert(call_with_text(node, "open", 1, broken_path, NULL) != MIEN_OK && errors == 4);
  assert(call_with_text(node, "open", 1, crowded_path, NULL) != MIEN_OK && errors == 5);

  const char* const paths[] = {dna_path, rig_path, asset_path};
  for (int way = 0; way < 3; ++way) { /* variants first, then pointers */
    assert(call_with_text(node, "open", way, paths[way], NULL) == MIEN_OK);
    assert(!call_with_text(node, "set_control", way, "no such control", &half));
    assert(!call(node, "evaluate", way, &no_lod, NULL));
    assert(!call(node, "drive_skeleton", way, &none, NULL) &&
           !call(node, "drive_mesh", way, &none, NULL));
    GdString first_mesh, no_mesh;
    const char* name = name_in(MIEN_KIND_MESH, 0);
    string_new(&first_mesh, name);
    string_new(&no_mesh, "no such mesh");
    free((void*)(uintptr_t)name);
    for (uint32_t frame = 0; frame < 3; ++frame) {
      for (uint32_t c = 0; c < count_of(MIEN_KIND_RAW_CONTROL); ++c) {
        const double set = (double)control_at(c, frame + (uint32_t)way);
        name = name_in(MIEN_KIND_RAW_CONTROL, c);
        assert(call_with_text(node, "set_control", way, name, &set));
        free((void*)(uintptr_t)name);
      }
      assert(call(node, "evaluate", way, &lod, NULL));
      assert(call(node, "drive_skeleton", way, &skeleton, NULL));
      assert(call(node, "drive_mesh", way, &mesh, NULL));
      assert(call(node, "drive_vertices", way, &mesh, &first_mesh));
      assert(!call(node, "drive_vertices", way, &mesh, &no_mesh));
      evaluate_alone(frame + (uint32_t)way);
      compare_targets(skeleton, mesh);
      compare_vertices(mesh, 0);
    }
    string_destroy(&first_mesh);
    string_destroy(&no_mesh);
  }
  free_object(node);
  free_target(skeleton);
  free_target(mesh);
}

/* ---- the importer ----------------------------------------------------------------------------------- */

static void run(const Object* object, const char* name, const void* const* arguments,
                void* result) {
  const GdVirtual method = virtual_of(object, name);
  assert(method);
  method(object->instance, arguments, result);
}

static void expect_text(const Object* object, const char* name, const char* text) {
  GdString string = {NULL};
  const int64_t first = 0;
  const void* const arguments[] = {&first};
  run(object, name, arguments, &string);
  assert(!strcmp(string.opaque, text));
  string_destroy(&string);
}

static int64_t import_file(const char* name) {
  GdString source, target;
  int64_t error = -1;
  const GdPackedArray options = {{NULL, NULL}};
  char path[256];
  snprintf(path, sizeof path, "res://%s", name);
  string_new(&source, path);
  string_new(&target, "res://.godot/imported/it");
  const void* const arguments[] = {&source, &target, &options, &options, &options};
  run(import_plugin, "_import", arguments, &error);
  string_destroy(&source);
  string_destroy(&target);
  return error;
}

static Object* saved_rig(void) {
  Object* resource;
  assert(type_of(&saved) == GD_OBJECT && !strcmp(saved_path, "res://.godot/imported/it.res"));
  take(&resource, GD_OBJECT, &saved);
  assert(is_class(resource, "MienRig"));
  return resource;
}

static void test_importer(Object* plugin) {
  run(plugin, "_enter_tree", NULL, NULL);
  assert(import_plugin && import_plugin->refs == 2); /* the editor's and the plug-in's */
  expect_text(import_plugin, "_get_importer_name", "mien.rig");
  expect_text(import_plugin, "_get_visible_name", "Mien Rig");
  expect_text(import_plugin, "_get_save_extension", "res");
  expect_text(import_plugin, "_get_resource_type", "MienRig");
  expect_text(import_plugin, "_get_preset_name", "Default");
  int64_t number = -1;
  double priority = 0;
  uint8_t truth = 0;
  run(import_plugin, "_get_preset_count", NULL, &number);
  assert(number == 1);
  run(import_plugin, "_get_import_order", NULL, &number);
  run(import_plugin, "_get_priority", NULL, &priority);
  run(import_plugin, "_get_option_visibility", NULL, &truth);
  assert(number == 0 && priority == 1 && truth == 1);
  GdPackedArray list = {{NULL, NULL}}, options = {{NULL, NULL}};
  run(import_plugin, "_get_recognized_extensions", NULL, &list);
  run(import_plugin, "_get_import_options", NULL, &options);
  const Block* extensions = list.opaque[0];
  assert(extensions->count == 3 && !options.opaque[0]);
  GdString second;
  memcpy(&second, extensions->data + sizeof second, sizeof second);
  assert(!strcmp(second.opaque, "uasset"));
  packed_destroy(&list);
  assert(!virtual_of(import_plugin, "_no_such_method"));

  errors = 0;
  assert(import_file("godot_test_broken.uasset") == 16 && import_file("none.dna") == 16 &&
         errors == 2);
  assert(type_of(&saved) == GD_NIL);
  const char* const names[] = {"godot_test.UAsset", "godot_test.rig", "godot_test.dna"};
  for (int i = 0; i < 3; ++i) {
    assert(import_file(names[i]) == 0);
    Object* resource = saved_rig();
    assert(resource->refs == 1); /* what was saved keeps it */
    GdVariant bytes;
    assert(get_property(resource, "baked", &bytes));
    const Block* block = block_of(&bytes);
    size_t size = 0;
    assert(mien_bake_memory(rig, deformer, NULL, 0, &size, NULL) == MIEN_OK &&
           block->count == size);
    unsigned char* wanted = malloc(size);
    assert(wanted && mien_bake_memory(rig, deformer, wanted, size, &size, NULL) == MIEN_OK);
    assert(!memcmp(wanted, block->data, size));
    free(wanted);
    variant_destroy(&bytes);
  }
  run(plugin, "_exit_tree", NULL, NULL);
  assert(!import_plugin);
}

/* ---- properties, as the editor and scenes set them --------------------------------------------------- */

static double control_property(Object* node, uint32_t control, double set) {
  char property[600];
  GdVariant variant;
  const char* name = name_in(MIEN_KIND_RAW_CONTROL, control);
  snprintf(property, sizeof property, "controls/%s", name);
  free((void*)(uintptr_t)name);
  double value = set;
  if (set >= 0) assert(set_value(node, property, GD_FLOAT, &value));
  assert(get_property(node, property, &variant));
  take(&value, GD_FLOAT, &variant);
  variant_destroy(&variant);
  return value;
}

/* Numbers of properties that are stored in scenes, and of all. */
static uint32_t stored_properties(Object* node, uint32_t* out_all) {
  const GdClassInfo2* info = class_info(node);
  uint32_t stored = 0;
  const GdPropertyInfo* list = info->get_property_list(node->instance, out_all);
  assert(!strcmp(name_text(list[0].name), "rig")); /* opened before controls are set */
  for (uint32_t p = 0; p < *out_all; ++p) stored += (list[p].usage & GD_USAGE_STORAGE) != 0;
  info->free_property_list(node->instance, list);
  return stored;
}

static void process(Object* node) {
  const double delta = 1. / 60;
  const void* const arguments[] = {&delta};
  run(node, "_process", arguments, NULL);
}

static void test_preview(void) {
  Object *node = construct("MienFace3D"), *resource = saved_rig(), *nothing = NULL;
  Object* skeleton = make_target("Skeleton3D", MIEN_KIND_JOINT);
  Object* mesh = make_target("MeshInstance3D", MIEN_KIND_BLEND_SHAPE_CHANNEL);
  const uint32_t control_count = count_of(MIEN_KIND_RAW_CONTROL),
                 mesh_count = count_of(MIEN_KIND_MESH);
  uint32_t all = 0;
  const uint8_t on = 1, off = 0;
  const int64_t no_lod = 99, lod = 0;
  const double half = 0.5;
  errors = list_changes = 0;
  process(node); /* without a rig */
  assert(stored_properties(node, &all) == 5 && all == 5);
  assert(!set_value(node, "no such property", GD_FLOAT, &half) &&
         !set_value(node, "rig", GD_FLOAT, &half));
  assert(set_value(node, "rig", GD_OBJECT, &resource) && list_changes == 1 && resource->refs == 2);
  assert(stored_properties(node, &all) == 5 && all == 5 + control_count);
  assert(!set_value(node, "controls/no such control", GD_FLOAT, &half));
  set_path(node, "skeleton", skeleton);
  set_path(node, "mesh", mesh);
  for (uint32_t frame = 0; frame < 3; ++frame) {
    if (frame == 1) assert(set_value(node, "show_geometry", GD_BOOL, &on));
    for (uint32_t c = 0; c < control_count; ++c)
      assert((float)control_property(node, c, (double)control_at(c, frame)) ==
             control_at(c, frame));
    process(node);
    evaluate_alone(frame);
    compare_targets(skeleton, mesh);
    assert(node->child_count == 0 || frame > 0);
  }
  assert(stored_properties(node, &all) > 5); /* controls that are not 0 */

  /* Meshes of its own: those of the LOD, as children that show the same. */
  uint32_t shown = 0;
  Object* child = NULL;
  while (next_child(node, child)) {
    child = next_child(node, child);
    MienMesh neutral = mien_mesh_default();
    while (mien_deformer_mesh(deformer, shown, &neutral) == MIEN_OK && !(neutral.lods & 1)) ++shown;
    assert(shown < mesh_count);
    compare_vertices(child, shown++);
  }
  assert(child && child->is_visible);

  /* Nothing happens until something changes; then what changed shows. */
  skeleton->values[0][0] = 1234;
  process(node);
  assert(skeleton->values[0][0] == 1234);
  control_property(node, 0, 0.25);
  process(node);
  assert(skeleton->values[0][0] != 1234);
  assert(set_value(node, "lod", GD_INT, &no_lod) && errors == 0);
  process(node);
  assert(errors == 1);
  assert(set_value(node, "lod", GD_INT, &lod) && set_value(node, "show_geometry", GD_BOOL, &off));
  end_frame();
  assert(node->child_count == 0);
  process(node);

  /* A node that is gone, a resource that is no rig, and no rig again. */
  set_path(node, "skeleton", NULL);
  free_target(skeleton);
  process(node);
  Object* other = construct("MienFace3D");
  assert(!set_value(node, "show_geometry", GD_OBJECT, &other) && errors == 1);
  assert(set_value(node, "rig", GD_OBJECT, &other) && errors == 2 && resource->refs == 1);
  process(node);
  assert(set_value(node, "rig", GD_OBJECT, &nothing) && resource->refs == 1);
  process(node);
  assert(stored_properties(node, &all) == 5 && all == 5 && errors == 2);
  free_object(other);
  free_object(node);
  free_target(mesh);
}

int main(int argc, char** argv) {
  assert(argc == 2);
  snprintf(project_folder, sizeof project_folder, "%s", argv[1]);
  make_files();
  GdInitialization start;
  missing = "variant_call"; /* a Godot that lacks a function is refused */
  assert(!mien_godot_init(get_proc_address, &library, &start));
  missing = NULL;
  assert(mien_godot_init(get_proc_address, &library, &start) &&
         start.minimum_level == GD_LEVEL_SCENE);
  const Alive before = alive;
  for (int32_t level = GD_LEVEL_SCENE; level <= GD_LEVEL_EDITOR; ++level) {
    start.initialize(start.userdata, level);
    assert(class_count() == (level == GD_LEVEL_SCENE ? 2 : 4));
  }
  assert(method_count() == 6 && editor_plugin);
  const Alive kept = alive; /* what the classes keep */

  test_methods();
  Object* plugin = construct(editor_plugin);
  test_importer(plugin);
  test_preview();
  variant_destroy(&saved);
  free_object(plugin);
  assert(!memcmp(&alive, &kept, sizeof alive));

  start.deinitialize(start.userdata, GD_LEVEL_EDITOR);
  assert(!editor_plugin && class_count() == 2);
  start.deinitialize(start.userdata, GD_LEVEL_SCENE);
  assert(class_count() == 0 && !memcmp(&alive, &before, sizeof alive));
  remove_files();
  puts("importer, node, skeleton, blend shapes and vertex buffers agree with the library");
  return 0;
}
