# SPDX-License-Identifier: MIT
"""Mien in Blender: facial rigs in DNA files, live."""
bl_info = {
    "name": "Mien: facial rigs",
    "author": "The Mien authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "File > Import > Facial rig (.dna, .uasset); 3D Viewport > Sidebar > Mien",
    "description": "Imports facial rigs in DNA files and evaluates them live",
    "category": "Rigging",
}

from . import (auto_rig, bake_keys, export_rig, expression_operators, handlers, live, operators, panels,  # noqa: E402
               properties, take_operators)

_PARTS = (properties, live, operators, bake_keys, take_operators, expression_operators, export_rig, auto_rig, panels,
          handlers)


def register():
    for part in _PARTS:
        part.register()


def unregister():
    for part in reversed(_PARTS):
        part.unregister()
