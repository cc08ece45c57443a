/* SPDX-License-Identifier: MIT
 * The classes of the extension, registered in the order of mien_godot_init() and unregistered in the reverse one. */
#ifndef MIEN_GODOT_CLASSES_H
#define MIEN_GODOT_CLASSES_H

/* MienFace3D: a character. */
void mien_register_face_3d(void);
void mien_unregister_face_3d(void);

/* MienRig: a baked rig as a resource. */
void mien_register_rig(void);
void mien_unregister_rig(void);

/* In the editor: MienImporter, and the plug-in that adds it. */
void mien_register_importer(void);
void mien_unregister_importer(void);

#endif
