# SPDX-License-Identifier: MIT
"""Meshes of a rig as Blender's meshes: faces, UVs, normals, colors, weights, shape keys."""
import base64
import re

import bpy
import numpy as np

from .binding import mien
from .rig_file import read_faces, read_weights

# Words in the name of a mesh -> color and roughness of a new material. The last is for all others.
LOOKS = (
    (("teeth",), (0.80, 0.74, 0.62), 0.30),
    (("tongue", "saliva"), (0.55, 0.18, 0.18), 0.40),
    (("eyeshell", "cartilage"), (0.62, 0.28, 0.24), 0.40),
    (("lash", "brow", "hair"), (0.06, 0.035, 0.02), 0.70),
    (("eye",), (0.85, 0.84, 0.82), 0.08),
    (("",), (0.74, 0.49, 0.39), 0.55),
)


def material_name(mesh_name):
    """The part of a mesh's name that its LODs share: "head" for "head_lod0_mesh"."""
    return re.sub(r"_?lod\d+|_?mesh$", "", mesh_name, flags=re.IGNORECASE) or mesh_name


def name_of_part(thing, names):
    """The name of the file's mesh that an object shows, copies included, or None."""
    for name in (thing.data.name, thing.name):
        while name not in names and "." in name:
            name = name.rpartition(".")[0]
        if name in names:
            return name
    return None


def material_for(mesh_name, has_colors):
    """The material of this name if the file has one, else a new one."""
    name = material_name(mesh_name)
    material = bpy.data.materials.get(name)
    if material is not None:
        return material
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    low = name.lower()
    color, roughness = next((c, r) for words, c, r in LOOKS if any(word in low for word in words))
    shader = next((n for n in material.node_tree.nodes if n.type == "BSDF_PRINCIPLED"), None)
    if shader is not None:
        shader.inputs["Base Color"].default_value = (*color, 1)
        shader.inputs["Roughness"].default_value = roughness
        if has_colors:
            colors = material.node_tree.nodes.new("ShaderNodeVertexColor")
            colors.layer_name = "Color"
            colors.location = shader.location[0] - 250, shader.location[1]
            material.node_tree.links.new(colors.outputs["Color"], shader.inputs["Base Color"])
    material.diffuse_color = (*color, 1)
    return material


def vertex_colors(rig_file):
    """uint8 (positions, 3) in sRGB by names of meshes, from the metadata that `mien demo-head` writes."""
    dna, found = rig_file.dna, {}
    for i in range(dna.info.metadata_count):
        key = dna.read(f"desc.metadata[{i}].key")
        if key.startswith("mien.colors."):
            colors = np.frombuffer(base64.b64decode(dna.read(f"desc.metadata[{i}].value")), np.uint8)
            found[key[len("mien.colors."):]] = colors.reshape(-1, 3)
    return found


def _set_faces(mesh, sizes, corners):
    starts = np.zeros(len(sizes), np.int32)
    np.cumsum(sizes[:-1], out=starts[1:])
    mesh.loops.add(len(corners))
    mesh.loops.foreach_set("vertex_index", np.ascontiguousarray(corners, np.int32))
    mesh.polygons.add(len(sizes))
    mesh.polygons.foreach_set("loop_start", starts)
    try:
        mesh.polygons.foreach_set("loop_total", sizes)
    except (AttributeError, RuntimeError, TypeError):
        pass  # computed from the starts since Blender 4.1
    mesh.polygons.foreach_set("use_smooth", np.ones(len(sizes), bool))


def _set_colors(mesh, colors):
    srgb = colors.astype(np.float32) / 255
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    attribute = mesh.color_attributes.new("Color", "FLOAT_COLOR", "POINT")
    attribute.data.foreach_set("color", np.column_stack([linear, np.ones(len(linear))]).astype(np.float32).ravel())


def build_mesh(rig_file, index, colors=None, with_normals=True):
    """A new mesh data-block with everything but weights and shape keys. colors: as of vertex_colors."""
    part = rig_file.deformer.mesh(index)
    mesh = bpy.data.meshes.new(part.name)
    mesh.vertices.add(part.position_count)
    mesh.vertices.foreach_set("co", np.ascontiguousarray(part.positions, np.float32).ravel())
    sizes, vertices = read_faces(rig_file, index)
    if rig_file.dna.info.face_winding == mien.FaceWinding.INWARD:
        vertices = np.concatenate([face[::-1] for face in np.split(vertices, np.cumsum(sizes)[:-1])])
    if len(sizes):
        _set_faces(mesh, sizes, part.vertex_position_indices[vertices])
        uvs = mesh.uv_layers.new(name="UVMap")
        uvs.data.foreach_set("uv", np.ascontiguousarray(part.texture_coordinates[vertices], np.float32).ravel())
    if colors is not None and len(colors) == part.position_count:
        _set_colors(mesh, colors)
    mesh.materials.append(material_for(part.name, colors is not None))
    mesh.update(calc_edges=True)
    if with_normals and len(sizes):
        if hasattr(mesh, "use_auto_smooth"):  # before Blender 4.1
            mesh.use_auto_smooth = True
        mesh.normals_split_custom_set(part.normals[vertices])
    return mesh


def add_weights(rig_file, index, thing):
    """Vertex groups of all joints that influence a mesh."""
    positions, joints, weights = read_weights(rig_file, index)
    order = np.lexsort((weights, joints))
    positions, joints, weights = positions[order], joints[order], weights[order]
    # Positions with the same joint and the same weight are added by one call.
    is_first = np.ones(len(joints), bool)
    is_first[1:] = (joints[1:] != joints[:-1]) | (weights[1:] != weights[:-1])
    starts = np.flatnonzero(is_first).tolist() + [len(joints)]
    groups = {}
    indices, joint_list, weight_list = positions.tolist(), joints.tolist(), weights.tolist()
    for start, end in zip(starts, starts[1:]):
        joint = joint_list[start]
        group = groups.get(joint)
        if group is None:
            group = groups[joint] = thing.vertex_groups.new(name=rig_file.joints[joint])
        group.add(indices[start:end], weight_list[start], "REPLACE")


def add_shape_keys(rig_file, index, thing, progress=None):
    """A shape key for each target of a mesh. Returns how many."""
    deformer, part, mesh = rig_file.deformer, rig_file.deformer.mesh(index), thing.data
    if not part.target_count:
        return 0
    neutral = np.ascontiguousarray(part.positions, np.float32).ravel()
    thing.shape_key_add(name="Basis", from_mix=False)
    # A new key copies the vertices of the mesh: writing those is faster than writing the key's own points.
    for target, channel in enumerate(part.target_channels):
        moved = neutral + deformer.target(index, target).ravel()
        mesh.vertices.foreach_set("co", moved)
        key = thing.shape_key_add(name=rig_file.channels[channel], from_mix=False)
        key.slider_min, key.slider_max = -10, 10
        key.value = 0
        if progress and target % 64 == 0:
            progress(target / part.target_count)
    mesh.vertices.foreach_set("co", neutral)
    return part.target_count
