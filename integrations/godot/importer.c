/* SPDX-License-Identifier: MIT
 * Files of a project become resources: MienImporter bakes .dna, .uasset and .rig files to a MienRig, which Godot saves among
 * its imported files and puts into exported games. */
#include <stdlib.h>
#include <string.h>

#include "classes.h"
#include "face.h"
#include "godot.h"

/* ---- MienRig: a Resource with the bytes of a baked file -------------------------------------------- */

typedef struct {
  GdVariant baked;
} Rig;

static GdPropertyInfo rig_properties[1];
static GdString no_text;

static GdObject create_rig(void* userdata) {
  (void)userdata;
  Rig* rig = malloc(sizeof *rig);
  if (!rig) return NULL;
  rig->baked = gd_empty(GD_PACKED_BYTES);
  GdObject object = gd.classdb_construct_object(&gd_names.Resource);
  gd.object_set_instance(object, &gd_names.MienRig, rig);
  return object;
}

static void free_rig(void* userdata, void* instance) {
  (void)userdata;
  gd.variant_destroy(&((Rig*)instance)->baked);
  free(instance);
}

static uint8_t set_rig(void* instance, const GdStringName* name, const GdVariant* value) {
  Rig* rig = instance;
  if (!gd_is_equal(name, &gd_names.baked) || gd.variant_get_type(value) != GD_PACKED_BYTES)
    return 0;
  gd.variant_destroy(&rig->baked);
  rig->baked = gd_copy(value);
  return 1;
}

static uint8_t get_rig(void* instance, const GdStringName* name, GdVariant* result) {
  if (!gd_is_equal(name, &gd_names.baked)) return 0;
  gd.variant_new_copy(result, &((Rig*)instance)->baked);
  return 1;
}

static const GdPropertyInfo* list_rig(void* instance, uint32_t* count) {
  (void)instance;
  *count = 1;
  return rig_properties;
}

static void free_list(void* instance, const GdPropertyInfo* list) { (void)instance, (void)list; }

void mien_register_rig(void) {
  gd.string_new_with_utf8_chars(&no_text, "");
  /* Stored, and not shown: it may be megabytes. */
  const GdPropertyInfo baked = {GD_PACKED_BYTES, &gd_names.baked, &gd_names.none, 0,
                                &no_text,        GD_USAGE_STORAGE};
  rig_properties[0] = baked;
  GdClassInfo2 info;
  memset(&info, 0, sizeof info);
  info.is_exposed = 1;
  info.create_instance = create_rig;
  info.free_instance = free_rig;
  info.set = set_rig;
  info.get = get_rig;
  info.get_property_list = list_rig;
  info.free_property_list = free_list;
  gd.classdb_register_extension_class2(gd.library, &gd_names.MienRig, &gd_names.Resource, &info);
}

void mien_unregister_rig(void) {
  gd.classdb_unregister_extension_class(gd.library, &gd_names.MienRig);
  gd.destroy[GD_STRING](&no_text);
}

/* ---- MienImporter: an EditorImportPlugin ------------------------------------------------------------ */

/* Numbers of Godot's Error. */
enum { ERROR_OK = 0, ERROR_OUT_OF_MEMORY = 6, ERROR_FILE_CORRUPT = 16 };

#define UNUSED (void)instance, (void)arguments

static void return_text(void* result, const char* text) {
  gd.string_new_with_utf8_chars(result, text);
}

static void importer_name(void* instance, const void* const* arguments, void* result) {
  UNUSED;
  return_text(result, "mien.rig");
}

static void visible_name(void* instance, const void* const* arguments, void* result) {
  UNUSED;
  return_text(result, "Mien Rig");
}

static void preset_name(void* instance, const void* const* arguments, void* result) {
  UNUSED;
  return_text(result, "Default");
}

static void save_extension(void* instance, const void* const* arguments, void* result) {
  UNUSED;
  return_text(result, "res");
}

static void resource_type(void* instance, const void* const* arguments, void* result) {
  UNUSED;
  return_text(result, "MienRig");
}

static void return_zero(void* instance, const void* const* arguments, void* result) {
  UNUSED;
  *(int64_t*)result = 0;
}

static void return_one(void* instance, const void* const* arguments, void* result) {
  UNUSED;
  *(int64_t*)result = 1;
}

static void priority(void* instance, const void* const* arguments, void* result) {
  UNUSED;
  *(double*)result = 1;
}

static void return_true(void* instance, const void* const* arguments, void* result) {
  UNUSED;
  *(uint8_t*)result = 1;
}

static void recognized_extensions(void* instance, const void* const* arguments, void* result) {
  UNUSED;
  static const char* const kExtensions[] = {"dna", "uasset", "rig"};
  GdVariant list = gd_empty(GD_PACKED_STRINGS);
  for (int i = 0; i < 3; ++i) {
    GdVariant extension = gd_text(kExtensions[i]);
    GdVariant nothing = gd_call(&list, &gd_names.append, &extension, 1);
    gd.variant_destroy(&nothing);
  }
  gd.to[GD_PACKED_STRINGS](result, &list);
  gd.variant_destroy(&list);
}

static void import_options(void* instance, const void* const* arguments, void* result) {
  UNUSED;
  (void)result; /* an empty Array */
}

/* The path in the file system of a path in the project. */
static void read_global_path(const GdString* path, char* out_path, size_t capacity) {
  GdVariant settings = gd_singleton(&gd_names.ProjectSettings),
            argument = gd_value(GD_STRING, path);
  GdVariant global = gd_call(&settings, &gd_names.globalize_path, &argument, 1);
  out_path[0] = 0;
  if (gd.variant_get_type(&global) == GD_STRING) {
    GdString text;
    gd.to[GD_STRING](&text, &global);
    gd_read_text(&text, out_path, capacity);
    gd.destroy[GD_STRING](&text);
  }
  gd.variant_destroy(&global);
  gd.variant_destroy(&settings);
}

static int64_t save_rig(const void* bytes, size_t size, const char* path) {
  GdObject object = gd.classdb_construct_object(&gd_names.MienRig);
  if (!object) return ERROR_OUT_OF_MEMORY;
  GdVariant rig = gd_value(GD_OBJECT, &object); /* owns it */
  GdVariant property[2] = {gd_value(GD_STRING_NAME, &gd_names.baked),
                           gd_packed(GD_PACKED_BYTES, bytes, size, 1)};
  GdVariant nothing = gd_call(&rig, &gd_names.set, property, 2);
  gd.variant_destroy(&nothing);
  GdVariant saver = gd_singleton(&gd_names.ResourceSaver);
  GdVariant file[2] = {rig, gd_text(path)}; /* the call destroys both */
  const int64_t error = gd_call_int(&saver, &gd_names.save, file, 2);
  gd.variant_destroy(&saver);
  return error;
}

/* _import(source_file: String, save_path: String, ...) -> Error. May run in any thread. */
static void import_file(void* instance, const void* const* arguments, void* result) {
  (void)instance;
  enum { CAPACITY = 4096 };
  char source[CAPACITY], target[CAPACITY];
  read_global_path(arguments[0], source, sizeof source);
  gd_read_text(arguments[1], target, sizeof target - 4);
  strcat(target, ".res");
  void* bytes = NULL;
  size_t size = 0;
  MienError error = mien_error_default();
  const MienStatus status = face_bake(source, &bytes, &size, &error);
  if (status == MIEN_OK) {
    *(int64_t*)result = save_rig(bytes, size, target);
  } else {
    gd.print_error(error.message[0] ? error.message : mien_status_name(status), "MienImporter",
                   __FILE__, __LINE__, 1);
    *(int64_t*)result = status == MIEN_ERROR_MEMORY ? ERROR_OUT_OF_MEMORY : ERROR_FILE_CORRUPT;
  }
  free(bytes);
}

/* ---- MienEditorPlugin: adds the importer ------------------------------------------------------------ */

typedef struct {
  GdObject object;
  GdVariant importer; /* nil outside of the tree */
} Plugin;

static void enter_tree(void* instance, const void* const* arguments, void* result) {
  (void)arguments, (void)result;
  Plugin* plugin = instance;
  GdObject importer = gd.classdb_construct_object(&gd_names.MienImporter);
  plugin->importer = gd_value(GD_OBJECT, &importer);
  GdVariant values[2] = {gd_copy(&plugin->importer), gd_bool(0)};
  GdVariant nothing = gd_call_object(plugin->object, &gd_names.add_import_plugin, values, 2);
  gd.variant_destroy(&nothing);
}

static void exit_tree(void* instance, const void* const* arguments, void* result) {
  (void)arguments, (void)result;
  Plugin* plugin = instance;
  GdVariant nothing =
      gd_call_object(plugin->object, &gd_names.remove_import_plugin, &plugin->importer, 1);
  gd.variant_destroy(&nothing);
  plugin->importer = gd_nil();
}

static GdObject create_importer(void* userdata) {
  (void)userdata;
  static char no_state;
  GdObject object = gd.classdb_construct_object(&gd_names.EditorImportPlugin);
  gd.object_set_instance(object, &gd_names.MienImporter, &no_state);
  return object;
}

static void free_importer(void* userdata, void* instance) { (void)userdata, (void)instance; }

static GdObject create_plugin(void* userdata) {
  (void)userdata;
  Plugin* plugin = malloc(sizeof *plugin);
  if (!plugin) return NULL;
  plugin->object = gd.classdb_construct_object(&gd_names.EditorPlugin);
  plugin->importer = gd_nil();
  gd.object_set_instance(plugin->object, &gd_names.MienEditorPlugin, plugin);
  return plugin->object;
}

static void free_plugin(void* userdata, void* instance) {
  (void)userdata;
  gd.variant_destroy(&((Plugin*)instance)->importer);
  free(instance);
}

typedef struct {
  const char* name;
  GdVirtual run;
} Virtual;

static const Virtual kImporterVirtuals[] = {{"_get_importer_name", importer_name},
                                            {"_get_visible_name", visible_name},
                                            {"_get_recognized_extensions", recognized_extensions},
                                            {"_get_save_extension", save_extension},
                                            {"_get_resource_type", resource_type},
                                            {"_get_preset_count", return_one},
                                            {"_get_preset_name", preset_name},
                                            {"_get_import_options", import_options},
                                            {"_get_option_visibility", return_true},
                                            {"_get_import_order", return_zero},
                                            {"_get_priority", priority},
                                            {"_import", import_file},
                                            {NULL, NULL}};
static const Virtual kPluginVirtuals[] = {
    {"_enter_tree", enter_tree}, {"_exit_tree", exit_tree}, {NULL, NULL}};

/* Asked once per class and method. `userdata` is one of the lists above. */
static GdVirtual get_virtual(void* userdata, const GdStringName* name) {
  for (const Virtual* list = userdata; list->name; ++list) {
    const GdStringName listed = gd_name(list->name);
    if (gd_is_equal(name, &listed)) return list->run;
  }
  return NULL;
}

void mien_register_importer(void) {
  GdClassInfo2 info;
  memset(&info, 0, sizeof info);
  info.create_instance = create_importer;
  info.free_instance = free_importer;
  info.get_virtual = get_virtual;
  info.class_userdata = (void*)(uintptr_t)kImporterVirtuals;
  gd.classdb_register_extension_class2(gd.library, &gd_names.MienImporter,
                                       &gd_names.EditorImportPlugin, &info);
  info.create_instance = create_plugin;
  info.free_instance = free_plugin;
  info.class_userdata = (void*)(uintptr_t)kPluginVirtuals;
  gd.classdb_register_extension_class2(gd.library, &gd_names.MienEditorPlugin,
                                       &gd_names.EditorPlugin, &info);
  gd.editor_add_plugin(&gd_names.MienEditorPlugin);
}

void mien_unregister_importer(void) {
  gd.editor_remove_plugin(&gd_names.MienEditorPlugin);
  gd.classdb_unregister_extension_class(gd.library, &gd_names.MienEditorPlugin);
  gd.classdb_unregister_extension_class(gd.library, &gd_names.MienImporter);
}
