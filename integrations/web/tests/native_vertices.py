# SPDX-License-Identifier: MIT
"""native_vertices.py BAKED NAME=VALUE...: deforms the meshes of LOD 0 with scalar code of the native library and
writes the positions and normals of each, as floats, to standard output."""
import sys

import mien

with mien.Baked.open(sys.argv[1]) as baked:
    rig = baked.rig(isa=mien.Isa.SCALAR)
    deformer = baked.deformer(rig)
face = rig.instance()
for setting in sys.argv[2:]:
    name, value = setting.split("=")
    face[name] = float(value)
face.evaluate(0)
meshes = deformer.instance([0])
meshes.update(face)
for mesh in rig.lod_indices(mien.Kind.MESH, 0):
    meshes.deform(int(mesh))
    for values in (meshes.positions(int(mesh)), meshes.normals(int(mesh))):
        sys.stdout.buffer.write(bytes(memoryview(values).cast("B")))
