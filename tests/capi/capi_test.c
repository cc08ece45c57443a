/* SPDX-License-Identifier: MIT
 *
 * The whole life of a rig, as a program in C sees it: nothing but mien.h and the shared library.
 * Compiled as strict C11 and, once more, as C++. */
#include <mien_author.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures = 0;

#define CHECK(condition) check((condition) ? 1 : 0, #condition, __LINE__)
#define CHECK_OK(call) check_ok((call), #call, __LINE__)

static void check(int good, const char* what, int line) {
  if (good) return;
  ++failures;
  fprintf(stderr, "%s:%d: %s\n", __FILE__, line, what);
}

static void check_ok(MienStatus status, const char* what, int line) {
  if (status == MIEN_OK) return;
  ++failures;
  fprintf(stderr, "%s:%d: %s: %s\n", __FILE__, line, what, mien_status_name(status));
}

/* Zero a struct, then set struct_size to its sizeof. */
#define PREPARE(s) (memset(&(s), 0, sizeof(s)), (s).struct_size = (uint32_t)sizeof(s))

static int is_text(MienStringView view, const char* text) {
  return view.count == strlen(text) && memcmp(view.data, text, view.count) == 0;
}

/* ---- Library --------------------------------------------------------------------------------- */

static void test_library(void) {
  static const struct {
    MienStatus status;
    const char* name;
  } statuses[] = {{MIEN_OK, "OK"},
                  {MIEN_ERROR_NULL_ARGUMENT, "NULL_ARGUMENT"},
                  {MIEN_ERROR_INVALID_ARGUMENT, "INVALID_ARGUMENT"},
                  {MIEN_ERROR_STRUCT_SIZE, "STRUCT_SIZE"},
                  {MIEN_ERROR_HANDLE, "HANDLE"},
                  {MIEN_ERROR_MISMATCH, "MISMATCH"},
                  {MIEN_ERROR_INDEX, "INDEX"},
                  {MIEN_ERROR_LOD, "LOD"},
                  {MIEN_ERROR_NAME, "NAME"},
                  {MIEN_ERROR_ISA, "ISA"},
                  {MIEN_ERROR_MEMORY, "MEMORY"},
                  {MIEN_ERROR_FILE_OPEN, "FILE_OPEN"},
                  {MIEN_ERROR_FILE_READ, "FILE_READ"},
                  {MIEN_ERROR_FILE_WRITE, "FILE_WRITE"},
                  {MIEN_ERROR_DNA_SIGNATURE, "DNA_SIGNATURE"},
                  {MIEN_ERROR_DNA_VERSION, "DNA_VERSION"},
                  {MIEN_ERROR_DNA_TRUNCATED, "DNA_TRUNCATED"},
                  {MIEN_ERROR_DNA_STRUCTURE, "DNA_STRUCTURE"},
                  {MIEN_ERROR_DNA_REFERENCE, "DNA_REFERENCE"},
                  {MIEN_ERROR_DNA_LIMIT, "DNA_LIMIT"},
                  {MIEN_ERROR_DNA_LAYER, "DNA_LAYER"},
                  {MIEN_ERROR_DNA_VALUE, "DNA_VALUE"},
                  {MIEN_ERROR_CLIP_SIGNATURE, "CLIP_SIGNATURE"},
                  {MIEN_ERROR_CLIP_CHECKSUM, "CLIP_CHECKSUM"},
                  {MIEN_ERROR_CLIP_VALUE, "CLIP_VALUE"},
                  {MIEN_ERROR_CLIP_LIMIT, "CLIP_LIMIT"},
                  {MIEN_ERROR_AUTHOR_MESH, "AUTHOR_MESH"},
                  {MIEN_ERROR_AUTHOR_REFUSED, "AUTHOR_REFUSED"},
                  {MIEN_ERROR_AUTHOR_CANCELED, "AUTHOR_CANCELED"},
                  {-1, "UNKNOWN"},
                  {MIEN_ERROR_UNSUPPORTED, "UNSUPPORTED"},
                  {12, "UNKNOWN"},
                  {1000, "UNKNOWN"}};
  static const char* const isas[] = {"best", "scalar", "sse2", "avx2", "avx512", "neon"};
  size_t i;

  /* A program may run with a later library of the same kind, never with an older one. */
  CHECK(mien_version() >= MIEN_VERSION);
  CHECK(mien_version() >> 24 == MIEN_VERSION_MAJOR);
  CHECK(MIEN_OK == 0);
  for (i = 0; i < sizeof statuses / sizeof statuses[0]; ++i) {
    CHECK(strcmp(mien_status_name(statuses[i].status), statuses[i].name) == 0);
  }
  for (i = 0; i < sizeof isas / sizeof isas[0]; ++i) {
    CHECK(strcmp(mien_isa_name((uint32_t)i), isas[i]) == 0);
  }
  CHECK(strcmp(mien_isa_name(MIEN_ISA_ENVIRONMENT), "environment") == 0);
  CHECK(strcmp(mien_isa_name(6), "unknown") == 0);
  CHECK(strcmp(mien_isa_name(UINT32_MAX), "unknown") == 0);
  CHECK(mien_isa_available(MIEN_ISA_BEST) == 1);
  CHECK(mien_isa_available(MIEN_ISA_SCALAR) == 1);
  CHECK(mien_isa_available(6) == 0);
  CHECK(mien_isa_available(UINT32_MAX) == 0);
}

/* ---- DNA: generate, write, open -------------------------------------------------------------- */

typedef struct Bytes {
  unsigned char* data;
  size_t count;
} Bytes;

/* The size first, then the bytes. */
static Bytes write_memory(const MienDna* dna, const MienWriteDesc* desc) {
  Bytes bytes = {NULL, 0};
  size_t written = 0;
  CHECK_OK(mien_dna_write_memory(dna, desc, NULL, 0, &bytes.count, NULL));
  bytes.data = (unsigned char*)malloc(bytes.count);
  CHECK_OK(mien_dna_write_memory(dna, desc, bytes.data, bytes.count, &written, NULL));
  CHECK(written == bytes.count);
  return bytes;
}

static MienDna* generate(uint32_t preset, uint64_t seed) {
  MienGenerateDesc desc;
  MienDna* dna = NULL;
  PREPARE(desc);
  desc.preset = preset;
  desc.seed = seed;
  CHECK_OK(mien_dna_generate(&desc, &dna, NULL));
  CHECK(dna != NULL);
  return dna;
}

static void test_generate(void) {
  MienDna *dna = NULL, *same = generate(MIEN_PRESET_TINY, 0),
          *other = generate(MIEN_PRESET_TINY, 1);
  MienDnaInfo info;
  Bytes a, b, c;

  CHECK_OK(mien_dna_generate(NULL, &dna, NULL)); /* tiny, seed 0 */
  a = write_memory(dna, NULL);
  b = write_memory(same, NULL);
  c = write_memory(other, NULL);
  CHECK(a.count == b.count && memcmp(a.data, b.data, a.count) == 0);
  CHECK(a.count != c.count || memcmp(a.data, c.data, a.count) != 0);
  CHECK(a.count > 7 && memcmp(a.data, "DNA\0\2\0\10", 7) == 0);

  PREPARE(info);
  CHECK_OK(mien_dna_info(dna, &info));
  CHECK(info.file_bytes == a.count && info.is_mapped == 0);
  CHECK(info.memory_bytes > 0);
  free(a.data);
  free(b.data);
  free(c.data);
  mien_dna_close(dna);
  mien_dna_close(same);
  mien_dna_close(other);
  mien_dna_close(NULL);

  dna = generate(MIEN_PRESET_LARGE, 0);
  CHECK_OK(mien_dna_info(dna, &info));
  CHECK(info.joint_count == 870 && info.raw_control_count == 260 && info.lod_count == 8);
  mien_dna_close(dna);
}

static void test_fields(const MienDna* dna) {
  MienDnaInfo info;
  MienDnaField field;
  MienStringView name, again;
  float values[3], all[1024];
  char endless[600];
  int64_t numbers[2];
  uint32_t i;

  PREPARE(info);
  PREPARE(field);
  CHECK_OK(mien_dna_info(dna, &info));
  CHECK_OK(mien_dna_field(dna, "", &field, NULL));
  CHECK(field.type == MIEN_FIELD_RECORD && field.count > 4);
  CHECK_OK(mien_dna_child_name(dna, "", 0, &name, NULL));
  CHECK(is_text(name, "desc"));
  CHECK_OK(mien_dna_child_name(dna, "defn.neutralJointTranslations", 2, &name, NULL));
  CHECK(is_text(name, "zs"));

  CHECK_OK(mien_dna_field(dna, "defn.jointNames", &field, NULL));
  CHECK(field.type == MIEN_FIELD_LIST && field.count == info.joint_count);
  CHECK(field.byte_offset == MIEN_NO_OFFSET);
  CHECK_OK(mien_dna_field(dna, "defn.jointNames[0]", &field, NULL));
  CHECK_OK(mien_dna_read_string(dna, "defn.jointNames[0]", &name, NULL));
  CHECK(field.type == MIEN_FIELD_STRING && field.count == name.count && name.count > 0);
  CHECK_OK(mien_dna_read_string(dna, "desc.name", &name, NULL));
  CHECK(name.data != NULL);
  for (i = 0; i < info.metadata_count; ++i) {
    char path[64];
    snprintf(path, sizeof path, "desc.metadata[%u].key", (unsigned)i);
    CHECK_OK(mien_dna_read_string(dna, path, &again, NULL));
  }

  CHECK_OK(mien_dna_field(dna, "defn.neutralJointTranslations.xs", &field, NULL));
  CHECK(field.type == MIEN_FIELD_F32 && field.count == info.joint_count && field.count <= 1024);
  CHECK_OK(
      mien_dna_read_floats(dna, "defn.neutralJointTranslations.xs", 0, field.count, all, NULL));
  CHECK_OK(mien_dna_read_floats(dna, "defn.neutralJointTranslations.xs", 1, 3, values, NULL));
  CHECK(memcmp(values, all + 1, sizeof values) == 0);
  CHECK_OK(mien_dna_read_floats(dna, "defn.neutralJointTranslations.xs[2]", 0, 1, values, NULL));
  CHECK(memcmp(values, all + 2, sizeof values[0]) == 0);

  CHECK_OK(mien_dna_field(dna, "desc.lodCount", &field, NULL));
  CHECK(field.type == MIEN_FIELD_U16 && field.count == 1);
  CHECK_OK(mien_dna_read_integers(dna, "desc.lodCount", 0, 1, numbers, NULL));
  CHECK(numbers[0] == (int64_t)info.lod_count);
  CHECK_OK(mien_dna_read_integers(dna, "dsce.rotationSign.x", 0, 1, numbers, NULL));
  CHECK(numbers[0] == info.rotation_signs[0]);
  CHECK_OK(mien_dna_read_integers(dna, "defn.jointHierarchy", 0, 2, numbers, NULL));
  CHECK(numbers[0] == 0 && numbers[1] < (int64_t)info.joint_count);
  CHECK(mien_dna_field(dna, "defn.jointNmaes", &field, NULL) == MIEN_ERROR_NAME);

  /* By length: the first bytes of a longer text, and no zero byte among them. */
  memset(endless, 'x', sizeof endless);
  CHECK_OK(mien_dna_field_n(dna, "desc.lodCount[0]", 13, &field, NULL));
  CHECK(field.type == MIEN_FIELD_U16);
  CHECK_OK(mien_dna_child_name_n(dna, "desc", 0, 0, &name, NULL));
  CHECK(name.count == 4 && memcmp(name.data, "desc", 4) == 0);
  CHECK_OK(mien_dna_read_integers_n(dna, "desc.lodCount[0]", 13, 0, 1, numbers, NULL));
  CHECK_OK(mien_dna_read_string_n(dna, "desc.name.", 9, &name, NULL));
  CHECK_OK(
      mien_dna_read_floats_n(dna, "defn.neutralJointTranslations.xs!", 32, 1, 3, values, NULL));
  CHECK(memcmp(values, all + 1, sizeof values) == 0);
  CHECK(mien_dna_field_n(dna, "desc.lodCount", 14, &field, NULL) == MIEN_ERROR_NAME);
  CHECK(mien_dna_field_n(dna, endless, sizeof endless, &field, NULL) == MIEN_ERROR_NAME);
  CHECK(mien_dna_field_n(dna, NULL, 0, &field, NULL) == MIEN_ERROR_NULL_ARGUMENT);
}

static void test_file(const MienDna* dna, const char* path) {
  MienWriteDesc old;
  MienDnaDesc desc;
  MienDnaInfo info;
  MienDnaLayer layer;
  MienDna *opened = NULL, *part = NULL;
  Bytes bytes = write_memory(dna, NULL), again, older;
  uint32_t i;

  /* A file, mapped; another one, read; the same from memory: all give the same bytes again. */
  for (i = 0; i < 3; ++i) {
    PREPARE(desc);
    desc.file_access = i == 1 ? MIEN_FILE_READ : MIEN_FILE_MAP;
    if (i < 2) {
      CHECK_OK(mien_dna_write_file(dna, path, NULL, NULL));
      CHECK_OK(mien_dna_open_file(path, &desc, &opened, NULL));
    } else {
      CHECK_OK(mien_dna_open_memory(bytes.data, bytes.count, NULL, &opened, NULL));
    }
    PREPARE(info);
    CHECK_OK(mien_dna_info(opened, &info));
    CHECK(info.generation == 2 && info.version == 8 && info.file_bytes == bytes.count);
    CHECK(i == 0 || info.is_mapped == 0);
    CHECK(info.layers == MIEN_LAYER_ALL && info.layer_count == 11);
    test_fields(opened);
    again = write_memory(opened, NULL);
    CHECK(again.count == bytes.count && memcmp(again.data, bytes.data, bytes.count) == 0);
    free(again.data);
    if (i < 2) mien_dna_close(opened);
  }

  /* The layers follow each other to the end of the file. */
  for (i = 0; i < info.layer_count; ++i) {
    PREPARE(layer);
    CHECK_OK(mien_dna_layer(opened, i, &layer));
    CHECK(layer.is_loaded == 1 && layer.layer != 0);
    CHECK(i != 0 || strcmp(layer.code, "desc") == 0);
    CHECK(i != 0 || (layer.version_major == 1 && layer.version_minor == 1));
    CHECK(i != 0 || layer.byte_offset == 11 + 16 * (uint64_t)info.layer_count);
    CHECK(i + 1 < info.layer_count || layer.byte_offset + layer.byte_count == info.file_bytes);
  }

  /* Part of it. */
  PREPARE(desc);
  desc.layers = MIEN_LAYER_BEHAVIOR;
  desc.lods = 2;
  CHECK_OK(mien_dna_open_memory(bytes.data, bytes.count, &desc, &part, NULL));
  CHECK_OK(mien_dna_info(part, &info));
  CHECK(info.layers == (MIEN_LAYER_DESCRIPTOR | MIEN_LAYER_DEFINITION | MIEN_LAYER_BEHAVIOR));
  CHECK(info.lod_count == 1 && info.max_lod == 1);
  mien_dna_close(part);

  /* The oldest version knows the four classic layers only. */
  PREPARE(old);
  old.version = 1;
  older = write_memory(opened, &old);
  CHECK(older.count < bytes.count && memcmp(older.data, "DNA\0\2\0\1", 7) == 0);
  CHECK_OK(mien_dna_open_memory(older.data, older.count, NULL, &part, NULL));
  CHECK_OK(mien_dna_info(part, &info));
  CHECK(info.version == 1 && info.layer_count == 4);
  mien_dna_close(part);
  mien_dna_close(opened);
  free(older.data);
  free(bytes.data);
}

static void test_report(const MienDna* dna) {
  Bytes bytes = write_memory(dna, NULL);
  MienReport* report = NULL;
  MienFinding finding;
  MienError error;
  MienDna* refused = NULL;
  uint32_t errors = 1, warnings = 1;

  CHECK_OK(mien_dna_validate_memory(bytes.data, bytes.count, NULL, &report, NULL));
  CHECK_OK(mien_report_counts(report, &errors, &warnings));
  CHECK(errors == 0 && warnings == 0);
  mien_report_destroy(report);
  mien_report_destroy(NULL);

  CHECK_OK(mien_dna_validate_memory(bytes.data, bytes.count - 1, NULL, &report, NULL));
  CHECK_OK(mien_report_counts(report, &errors, &warnings));
  CHECK(errors == 1);
  PREPARE(finding);
  CHECK_OK(mien_report_finding(report, 0, &finding));
  CHECK(finding.severity == MIEN_SEVERITY_ERROR && finding.status == MIEN_ERROR_DNA_TRUNCATED);
  CHECK(finding.message.count > 0);
  CHECK(mien_report_finding(report, errors + warnings, &finding) == MIEN_ERROR_INDEX);
  mien_report_destroy(report);

  PREPARE(error);
  CHECK(mien_dna_open_memory(bytes.data, bytes.count - 1, NULL, &refused, &error) ==
        MIEN_ERROR_DNA_TRUNCATED);
  CHECK(refused == NULL && error.status == MIEN_ERROR_DNA_TRUNCATED);
  CHECK(error.message[0] != 0 && memchr(error.message, 0, sizeof error.message) != NULL);
  free(bytes.data);
}

/* ---- Rig ------------------------------------------------------------------------------------- */

/* By a terminated name and by as many bytes of a longer one. */
static void test_find(const MienRig* rig) {
  MienCoordinateSystem system = mien_coordinate_system_default();
  uint32_t found = 1;
  CHECK_OK(mien_rig_find(rig, MIEN_KIND_PSD_CONTROL, "psd0", &found));
  CHECK(found == 0);
  CHECK_OK(mien_rig_find_n(rig, MIEN_KIND_PSD_CONTROL, "psd01", 4, &found));
  CHECK(found == 0);
  CHECK(mien_rig_find(rig, MIEN_KIND_PSD_CONTROL, "psd", &found) == MIEN_ERROR_NAME);
  CHECK(mien_rig_find_n(rig, MIEN_KIND_PSD_CONTROL, "psd0", 5, &found) == MIEN_ERROR_NAME);
  CHECK(mien_rig_find(rig, MIEN_KIND_PSD_CONTROL, NULL, &found) == MIEN_ERROR_NULL_ARGUMENT);
  CHECK_OK(mien_coordinate_system_find("unity", &system));
  CHECK(system.axes[1] == MIEN_DIRECTION_UP && system.translation_unit == 1);
  CHECK_OK(mien_coordinate_system_find_n("unity3d", 5, &system));
  CHECK(mien_coordinate_system_find_n("unity3d", 7, &system) == MIEN_ERROR_NAME);
}

static void test_names(const MienRig* rig) {
  uint32_t kind, count, i, found;
  MienStringView name;
  for (kind = MIEN_KIND_GUI_CONTROL; kind <= MIEN_KIND_ML_MASK; ++kind) {
    CHECK_OK(mien_rig_count(rig, kind, &count));
    for (i = 0; i < count; ++i) {
      CHECK_OK(mien_rig_name(rig, kind, i, &name));
      CHECK_OK(mien_rig_find_n(rig, kind, name.data, name.count, &found));
      CHECK(found == i);
    }
    CHECK(mien_rig_name(rig, kind, count, &name) == MIEN_ERROR_INDEX && name.data == NULL);
    CHECK(mien_rig_find_n(rig, kind, "not there", 9, &found) == MIEN_ERROR_NAME && found == 0);
  }
  test_find(rig);
  CHECK_OK(mien_rig_name(rig, MIEN_KIND_PSD_CONTROL, 1, &name));
  CHECK(is_text(name, "psd1"));
  CHECK_OK(mien_rig_count(rig, MIEN_KIND_JOINT_GROUP, &count));
  CHECK(count > 0);
  CHECK_OK(mien_rig_name(rig, MIEN_KIND_JOINT_GROUP, 0, &name));
  CHECK(name.count == 0);
}

static void test_rig(const MienRig* rig) {
  static const uint32_t lod_kinds[] = {MIEN_KIND_JOINT, MIEN_KIND_BLEND_SHAPE_CHANNEL,
                                       MIEN_KIND_ANIMATED_MAP, MIEN_KIND_MESH};
  MienRigInfo info;
  MienRigStatistics statistics;
  MienIndex16View indices, parents;
  MienFloatView floats;
  uint32_t lod, count, joints, psds, i;
  size_t k;

  PREPARE(info);
  CHECK_OK(mien_rig_info(rig, &info));
  CHECK_OK(mien_rig_count(rig, MIEN_KIND_JOINT, &joints));
  CHECK(info.joint_value_count == 9 * joints);
  CHECK(info.isa != MIEN_ISA_BEST && mien_isa_available(info.isa) == 1);
  CHECK(info.rig_bytes > 0 && info.instance_bytes > 0);
  CHECK(info.rotation_output == MIEN_ROTATION_OUTPUT_EULER);
  for (count = 0, i = MIEN_KIND_RAW_CONTROL; i <= MIEN_KIND_RBF_CONTROL; ++i) {
    uint32_t more;
    CHECK_OK(mien_rig_count(rig, i, &more));
    count += more;
  }
  CHECK(info.control_count == count);
  test_names(rig);

  for (lod = 0; lod < info.lod_count; ++lod) {
    PREPARE(statistics);
    CHECK_OK(mien_rig_statistics(rig, lod, &statistics));
    for (k = 0; k < sizeof lod_kinds / sizeof lod_kinds[0]; ++k) {
      CHECK_OK(mien_rig_count(rig, lod_kinds[k], &count));
      CHECK_OK(mien_rig_lod_indices(rig, lod_kinds[k], lod, &indices));
      for (i = 0; i < indices.count; ++i) CHECK(indices.data[i] < count);
      if (lod_kinds[k] == MIEN_KIND_JOINT) CHECK(statistics.joint_count == indices.count);
    }
    CHECK_OK(mien_rig_variable_joint_values(rig, lod, &indices));
    CHECK(indices.count > 0 && indices.count <= statistics.joint_row_count);
    for (i = 0; i < indices.count; ++i) {
      CHECK(indices.data[i] < info.joint_value_count);
      if (i > 0) CHECK(indices.data[i - 1] < indices.data[i]);
    }
    CHECK(statistics.joint_entry_count >= statistics.joint_row_count);
    CHECK(statistics.joint_byte_count >= 4 * statistics.joint_entry_count);
  }
  CHECK(mien_rig_statistics(rig, info.lod_count, &statistics) == MIEN_ERROR_LOD);

  CHECK_OK(mien_rig_joint_parents(rig, &parents));
  CHECK(parents.count == joints && parents.data[0] == 0);
  for (i = 0; i < parents.count; ++i) CHECK(parents.data[i] < joints);
  CHECK_OK(mien_rig_neutral_joint_values(rig, &floats));
  CHECK(floats.count == info.joint_value_count);
  for (i = 0; i < floats.count; ++i) {
    if (i % 9 >= 6) CHECK(floats.data[i] == 1.0f);
  }
  CHECK_OK(mien_rig_count(rig, MIEN_KIND_PSD_CONTROL, &psds));
  for (i = 0; i < psds; ++i) {
    CHECK_OK(mien_rig_psd_inputs(rig, i, &indices));
    CHECK(indices.count > 0);
    for (k = 0; k < indices.count; ++k) CHECK(indices.data[k] < info.control_count);
  }
  CHECK(mien_rig_psd_inputs(rig, psds, &indices) == MIEN_ERROR_INDEX && indices.data == NULL);
  CHECK_OK(mien_rig_count(rig, MIEN_KIND_RAW_CONTROL, &count));
  CHECK_OK(mien_rig_initial_raw_controls(rig, &floats));
  CHECK(floats.count == count);
}

/* ---- Instance -------------------------------------------------------------------------------- */

static int all_zero(MienFloatView view) {
  size_t i;
  for (i = 0; i < view.count; ++i) {
    if (view.data[i] != 0.0f) return 0;
  }
  return 1;
}

static void fill(MienMutableFloatView view, float value) {
  size_t i;
  for (i = 0; i < view.count; ++i) view.data[i] = value;
}

/* Stages and groups, one after another, give what one call for all of them gives. */
static void test_parts(const MienRig* rig, MienInstance* whole, MienInstance* parts, uint32_t lod) {
  static const uint32_t stages[] = {MIEN_STAGE_ML, MIEN_STAGE_RBF, MIEN_STAGE_PSD,
                                    MIEN_STAGE_BLEND_SHAPES, MIEN_STAGE_ANIMATED_MAPS};
  MienFloatView a, b;
  uint32_t groups, setups, solvers, i;
  size_t s;
  CHECK_OK(mien_rig_evaluate(rig, whole, lod));
  for (s = 0; s < sizeof stages / sizeof stages[0]; ++s) {
    CHECK_OK(mien_rig_evaluate_stages(rig, parts, lod, stages[s]));
  }
  CHECK_OK(mien_rig_count(rig, MIEN_KIND_JOINT_GROUP, &groups));
  for (i = 0; i < groups; ++i) CHECK_OK(mien_rig_evaluate_joint_group(rig, parts, lod, i));
  CHECK(mien_rig_evaluate_joint_group(rig, parts, lod, groups) == MIEN_ERROR_INDEX);
  CHECK_OK(mien_rig_count(rig, MIEN_KIND_TWIST_SWING, &setups));
  for (i = 0; i < setups; ++i) CHECK_OK(mien_rig_evaluate_twist_swing(rig, parts, lod, i));
  CHECK(mien_rig_evaluate_twist_swing(rig, parts, lod, setups) == MIEN_ERROR_INDEX);
  CHECK_OK(mien_rig_count(rig, MIEN_KIND_RBF_SOLVER, &solvers));
  CHECK(mien_rig_evaluate_rbf_solver(rig, parts, lod, solvers) == MIEN_ERROR_INDEX);

  CHECK_OK(mien_instance_controls(whole, &a));
  CHECK_OK(mien_instance_controls(parts, &b));
  CHECK(a.count == b.count && memcmp(a.data, b.data, a.count * sizeof(float)) == 0);
  CHECK_OK(mien_instance_joints(whole, &a));
  CHECK_OK(mien_instance_joints(parts, &b));
  CHECK(a.count == b.count && memcmp(a.data, b.data, a.count * sizeof(float)) == 0);
  CHECK_OK(mien_instance_blend_shapes(whole, &a));
  CHECK_OK(mien_instance_blend_shapes(parts, &b));
  CHECK(a.count == b.count && memcmp(a.data, b.data, a.count * sizeof(float)) == 0);
  CHECK_OK(mien_instance_animated_maps(whole, &a));
  CHECK_OK(mien_instance_animated_maps(parts, &b));
  CHECK(a.count == b.count && memcmp(a.data, b.data, a.count * sizeof(float)) == 0);
}

static void test_control_row(const MienRig* rig, MienInstance* instance) {
  MienMutableFloatView raw;
  MienFloatView controls, psd, ml, rbf;
  MienRigInfo info;
  PREPARE(info);
  CHECK_OK(mien_rig_info(rig, &info));
  CHECK_OK(mien_instance_raw_controls(instance, &raw));
  CHECK_OK(mien_instance_controls(instance, &controls));
  CHECK_OK(mien_instance_psd_controls(instance, &psd));
  CHECK_OK(mien_instance_ml_controls(instance, &ml));
  CHECK_OK(mien_instance_rbf_controls(instance, &rbf));
  CHECK(controls.count == info.control_count);
  CHECK(raw.count + psd.count + ml.count + rbf.count == controls.count);
  CHECK((const float*)raw.data == controls.data);
  CHECK(psd.data == controls.data + raw.count);
  CHECK(ml.count == 0 || ml.data == psd.data + psd.count);
  CHECK(rbf.count == 0 || rbf.data == psd.data + psd.count + ml.count);
}

static void test_instance(const MienRig* rig, MienInstance* instance, MienInstance* other) {
  MienMutableFloatView gui, raw, masks, same;
  MienFloatView joints, shapes, maps, initial;
  MienRigInfo info;
  uint32_t lod, masks_of_rig;

  PREPARE(info);
  CHECK_OK(mien_rig_info(rig, &info));
  CHECK_OK(mien_instance_gui_controls(instance, &gui));
  CHECK_OK(mien_instance_raw_controls(instance, &raw));
  CHECK_OK(mien_instance_ml_masks(instance, &masks));
  CHECK_OK(mien_instance_joints(instance, &joints));
  CHECK_OK(mien_instance_blend_shapes(instance, &shapes));
  CHECK_OK(mien_instance_animated_maps(instance, &maps));
  CHECK_OK(mien_rig_count(rig, MIEN_KIND_ML_MASK, &masks_of_rig));
  CHECK(masks.count == masks_of_rig && joints.count == info.joint_value_count);
  CHECK(gui.count > 0 && shapes.count > 0 && maps.count > 0);
  CHECK_OK(mien_rig_initial_raw_controls(rig, &initial));
  CHECK(memcmp(raw.data, initial.data, raw.count * sizeof(float)) == 0);
  CHECK(all_zero(joints) && all_zero(shapes) && all_zero(maps));
  test_control_row(rig, instance);

  /* From the sliders to the joints, at every LOD and back at the first. */
  fill(gui, 0.75f);
  CHECK_OK(mien_rig_map_gui_to_raw(rig, instance));
  CHECK_OK(mien_instance_raw_controls(other, &same));
  memcpy(same.data, raw.data, raw.count * sizeof(float));
  for (lod = 0; lod <= info.lod_count; ++lod) {
    test_parts(rig, instance, other, lod % info.lod_count);
    CHECK(!all_zero(joints));
  }
  CHECK(!all_zero(shapes));
  CHECK(mien_rig_evaluate(rig, instance, info.lod_count) == MIEN_ERROR_LOD);
  CHECK_OK(mien_rig_map_raw_to_gui(rig, instance));

  /* The views are what they were. */
  CHECK_OK(mien_instance_raw_controls(instance, &same));
  CHECK(same.data == raw.data && same.count == raw.count);

  CHECK_OK(mien_instance_reset(instance));
  CHECK(memcmp(raw.data, initial.data, raw.count * sizeof(float)) == 0);
  CHECK(all_zero(joints) && all_zero(shapes) && all_zero(maps) && gui.data[0] == 0.0f);
}

/* The same rig, its rotations as quaternions: ten values per joint, at rest no rotation. */
static void test_quaternions(const MienDna* dna, const MienRig* euler) {
  MienRigDesc desc;
  MienRigInfo info, euler_info;
  MienRig* rig = NULL;
  MienInstance* instance = NULL;
  MienFloatView joints;
  uint32_t i, count;

  PREPARE(desc);
  desc.rotation_output = MIEN_ROTATION_OUTPUT_QUATERNION;
  CHECK_OK(mien_rig_create(dna, &desc, &rig, NULL));
  PREPARE(info);
  PREPARE(euler_info);
  CHECK_OK(mien_rig_info(rig, &info));
  CHECK_OK(mien_rig_info(euler, &euler_info));
  CHECK_OK(mien_rig_count(rig, MIEN_KIND_JOINT, &count));
  CHECK(info.rotation_output == MIEN_ROTATION_OUTPUT_QUATERNION &&
        info.joint_value_count == 10 * count);
  CHECK(euler_info.joint_value_count == 9 * count);

  CHECK_OK(mien_instance_create(rig, NULL, &instance, NULL));
  CHECK_OK(mien_instance_joints(instance, &joints));
  CHECK(joints.count == info.joint_value_count);
  for (i = 0; i < joints.count; ++i) CHECK(joints.data[i] == (i % 10 == 6 ? 1.0f : 0.0f));
  CHECK_OK(mien_rig_evaluate(rig, instance, 0));
  mien_instance_destroy(instance);
  mien_rig_destroy(rig);
}

/* Created and destroyed in one order or the other; the DNA is closed before anything is used. */
/* Runs the tasks backwards; a real one hands them to its threads. */
static void run_backwards(void* user, uint32_t count, void (*task)(void* context, uint32_t index),
                          void* context) {
  uint32_t* tasks = (uint32_t*)user;
  *tasks += count;
  while (count-- > 0) task(context, count);
}

static void test_deformer(const MienDna* dna, const MienRig* rig) {
  MienDeformerDesc desc;
  MienDeformerInfo info;
  MienMesh mesh;
  MienDeformer* deformer = NULL;
  MienDeformerInstance *pose = NULL, *other = NULL, *both[2];
  MienInstance* instance = NULL;
  MienMutableFloatView raw;
  MienFloatView before, after, matrices, weights;
  MienIndex16View joints;
  uint32_t tasks = 0, moved = 0, m, i;
  MienParallelFor parallel;
  parallel.user = &tasks;
  parallel.run = run_backwards;

  PREPARE(desc);
  desc.weights = MIEN_WEIGHTS_FIX;
  CHECK_OK(mien_deformer_create(dna, rig, &desc, &deformer, NULL));
  PREPARE(info);
  CHECK_OK(mien_deformer_info(deformer, &info));
  CHECK(info.mesh_count > 0 && info.weights == MIEN_WEIGHTS_FIX);
  CHECK(info.normals == MIEN_NORMALS_RECOMPUTED && info.instance_bytes > 0);
  CHECK_OK(mien_deformer_instance_create(deformer, NULL, &pose, NULL));
  CHECK_OK(mien_deformer_instance_create(deformer, NULL, &other, NULL));
  CHECK_OK(mien_instance_create(rig, NULL, &instance, NULL));
  CHECK_OK(mien_instance_raw_controls(instance, &raw));
  fill(raw, 0.5f);
  CHECK_OK(mien_rig_evaluate(rig, instance, 0));
  CHECK_OK(mien_deformer_instance_update(pose, instance));
  CHECK_OK(mien_deformer_instance_update(other, instance));
  CHECK_OK(mien_deformer_instance_joint_matrices(pose, &matrices));
  CHECK(matrices.count == 16 * (size_t)info.joint_count && matrices.data[15] == 1);
  CHECK_OK(mien_deformer_instance_skin_matrices(pose, &matrices));
  CHECK_OK(mien_deformer_bind_matrices(deformer, &matrices));
  CHECK_OK(mien_deformer_inverse_bind_matrices(deformer, &matrices));

  both[0] = pose;
  both[1] = other;
  for (m = 0; m < info.mesh_count; ++m) {
    PREPARE(mesh);
    CHECK_OK(mien_deformer_mesh(deformer, m, &mesh));
    CHECK_OK(mien_deformer_influences(deformer, m, 0, &joints, &weights));
    CHECK(joints.count == weights.count && joints.count <= mesh.max_influences);
    CHECK_OK(mien_deformer_instance_deform_batch(both, 2, m, MIEN_NORMALS_SKINNED, &parallel));
    CHECK_OK(mien_deformer_instance_deform(pose, m, MIEN_NORMALS_DEFAULT, NULL));
    CHECK_OK(mien_deformer_instance_normals(pose, m, &after));
    CHECK(after.count == mesh.normals.count);
    CHECK_OK(mien_deformer_instance_positions(pose, m, &before));
    CHECK_OK(mien_deformer_instance_positions(other, m, &after));
    CHECK(before.count == mesh.positions.count && after.count == before.count);
    CHECK(memcmp(before.data, after.data, before.count * sizeof(float)) == 0);
    for (i = 0; i < before.count; ++i) moved += before.data[i] != mesh.positions.data[i];
  }
  CHECK(moved > 0);
  mien_deformer_destroy(deformer);
  CHECK_OK(mien_deformer_instance_update_from_values(pose, NULL, 0, NULL, 0));
  CHECK_OK(mien_deformer_instance_deform(pose, 0, MIEN_NORMALS_NONE, NULL));
  mien_deformer_instance_destroy(pose);
  mien_deformer_instance_destroy(other);
  mien_instance_destroy(instance);
}

static void test_life(int rig_first) {
  MienDna* dna = generate(MIEN_PRESET_SMALL, 7);
  MienRig* rig = NULL;
  MienInstance *instance = NULL, *other = NULL;
  MienFloatView joints;
  MienError error;

  PREPARE(error);
  CHECK_OK(mien_rig_create(dna, NULL, &rig, &error));
  test_quaternions(dna, rig);
  test_deformer(dna, rig);
  mien_dna_close(dna);
  CHECK_OK(mien_instance_create(rig, NULL, &instance, &error));
  CHECK_OK(mien_instance_create(rig, NULL, &other, &error));
  test_rig(rig);
  test_instance(rig, instance, other);
  CHECK_OK(mien_rig_evaluate(rig, instance, 0));
  mien_instance_destroy(other);
  if (rig_first) {
    mien_rig_destroy(rig);
    CHECK_OK(mien_instance_joints(instance, &joints));
    CHECK(joints.count > 0 && joints.data[0] == joints.data[0]);
    CHECK_OK(mien_instance_reset(instance));
    mien_instance_destroy(instance);
  } else {
    mien_instance_destroy(instance);
    mien_rig_destroy(rig);
  }
  mien_rig_destroy(NULL);
  mien_instance_destroy(NULL);
}

int main(int argc, char** argv) {
  char path[4096];
  MienDna* dna;
  if (argc < 1 || snprintf(path, sizeof path, "%s.written.dna", argv[0]) >= (int)sizeof path)
    return 2;

  test_library();
  test_generate();
  dna = generate(MIEN_PRESET_SMALL, 3);
  test_fields(dna);
  test_file(dna, path);
  test_report(dna);
  mien_dna_close(dna);
  test_life(0);
  test_life(1);
  CHECK(remove(path) == 0);

  if (failures != 0) fprintf(stderr, "%d checks failed\n", failures);
  return failures != 0;
}
