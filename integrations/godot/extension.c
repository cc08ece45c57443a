/* SPDX-License-Identifier: MIT
 * The entry that mien.gdextension names, and what it registers at which level. */
#include <stddef.h>

#include "classes.h"
#include "godot.h"

#if defined(_WIN32)
#define MIEN_EXPORT __declspec(dllexport)
#else
#define MIEN_EXPORT __attribute__((visibility("default")))
#endif

static void initialize(void* userdata, int32_t level) {
  (void)userdata;
  if (level == GD_LEVEL_SCENE) {
    gd_make_names();
    mien_register_rig();
    mien_register_face_3d();
  }
  if (level == GD_LEVEL_EDITOR) mien_register_importer();
}

static void deinitialize(void* userdata, int32_t level) {
  (void)userdata;
  if (level == GD_LEVEL_EDITOR) mien_unregister_importer();
  if (level == GD_LEVEL_SCENE) {
    mien_unregister_face_3d();
    mien_unregister_rig();
  }
}

/* Refuses a Godot that lacks a function. */
MIEN_EXPORT uint8_t mien_godot_init(GdGetProcAddress get, void* library,
                                    GdInitialization* initialization) {
  if (!gd_load(get, library)) return 0;
  initialization->minimum_level = GD_LEVEL_SCENE;
  initialization->userdata = NULL;
  initialization->initialize = initialize;
  initialization->deinitialize = deinitialize;
  return 1;
}
