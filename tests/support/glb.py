# SPDX-License-Identifier: MIT
"""Reads GLB files and deforms what is in them, in double precision, as a viewer would."""
import array
import json
import math
import struct
import sys

COMPONENTS = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}
SHAPES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
IDENTITY = (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0)


def multiply(a, b):
    """Product of affine matrices: three rows of four, one after the other."""
    product = []
    for row in range(0, 12, 4):
        for column in range(4):
            total = a[row + 3] if column == 3 else 0.0
            for k in range(3):
                total += a[row + k] * b[4 * k + column]
            product.append(total)
    return product


def transform(m, p):
    x, y, z = p
    return (m[0] * x + m[1] * y + m[2] * z + m[3], m[4] * x + m[5] * y + m[6] * z + m[7],
            m[8] * x + m[9] * y + m[10] * z + m[11])


def local_matrix(node):
    tx, ty, tz = node.get("translation", (0, 0, 0))
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    s = node.get("scale", (1, 1, 1))
    rotation = ((1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)),
                (2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)),
                (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)))
    rows = []
    for row, t in zip(rotation, (tx, ty, tz)):
        rows += [row[0] * s[0], row[1] * s[1], row[2] * s[2], t]
    return rows


class Glb:
    def __init__(self, data):
        magic, version, length = struct.unpack_from("<4sII", data)
        assert (magic, version, length) == (b"glTF", 2, len(data))
        size, kind = struct.unpack_from("<I4s", data, 12)
        assert kind == b"JSON" and size % 4 == 0
        self.json = json.loads(data[20:20 + size])
        binary_size, kind = struct.unpack_from("<I4s", data, 20 + size)
        assert kind == b"BIN\0" and 28 + size + binary_size == length
        self.binary = data[28 + size:]
        self.known = {}  # accessors that were read, moves of targets, influences
        assert self.json["buffers"] == [{"byteLength": binary_size}]

    def numbers(self, view, offset, component, count, width=1):
        """`count` groups of numbers, which stand close together or begin at multiples of the stride."""
        view = self.json["bufferViews"][view]
        values = array.array(COMPONENTS[component])
        size = width * values.itemsize
        stride = view.get("byteStride", size)
        first = view.get("byteOffset", 0) + offset
        assert stride >= size and stride % values.itemsize == 0 and first % values.itemsize == 0
        assert count == 0 or offset + (count - 1) * stride + size <= view["byteLength"]
        for at in range(first, first + count * stride, stride):
            values.frombytes(self.binary[at:at + size])
        if sys.byteorder == "big":
            values.byteswap()
        return values

    def accessor(self, index):
        """One tuple per element, or one number. The list is kept, and is not to be changed."""
        if index not in self.known:
            self.known[index] = self.read_accessor(index)
        return self.known[index]

    def moves(self, index):
        """Elements of an accessor that are not 0, with their numbers."""
        if ("moves", index) not in self.known:
            self.known["moves", index] = [(i, move) for i, move in enumerate(self.accessor(index)) if any(move)]
        return self.known["moves", index]

    def influences(self, attributes):
        """Joint and weight of what each vertex follows."""
        key = ("influences", attributes["JOINTS_0"])
        if key not in self.known:
            influences = [[] for _ in self.accessor(attributes["JOINTS_0"])]
            for number in range(3):
                if "JOINTS_%d" % number not in attributes:
                    break
                pairs = zip(self.accessor(attributes["JOINTS_%d" % number]),
                            self.accessor(attributes["WEIGHTS_%d" % number]))
                for influence, (joint, weight) in zip(influences, pairs):
                    influence += [(j, w) for j, w in zip(joint, weight) if w != 0]
            for influence in influences:
                assert abs(sum(w for _, w in influence) - 1) < 1e-6, influence
            self.known[key] = influences
        return self.known[key]

    def read_accessor(self, index):
        accessor = self.json["accessors"][index]
        width, count, component = SHAPES[accessor["type"]], accessor["count"], accessor["componentType"]
        if "bufferView" in accessor:
            flat = list(self.numbers(accessor["bufferView"], accessor.get("byteOffset", 0), component, count,
                                     width))
        else:
            flat = [0] * (count * width)
        if "sparse" in accessor:
            sparse = accessor["sparse"]
            places = self.numbers(sparse["indices"]["bufferView"], sparse["indices"]["byteOffset"],
                                  sparse["indices"]["componentType"], sparse["count"])
            values = self.numbers(sparse["values"]["bufferView"], sparse["values"]["byteOffset"],
                                  component, sparse["count"], width)
            assert list(places) == sorted(set(places))
            for i, place in enumerate(places):
                flat[place * width:(place + 1) * width] = values[i * width:(i + 1) * width]
        for bound, choose in (("min", min), ("max", max)):
            if bound in accessor:
                assert accessor[bound] == [choose(flat[k::width]) for k in range(width)], index
        if accessor.get("normalized"):
            most = {"b": 127, "B": 255, "h": 32767, "H": 65535}[COMPONENTS[component]]
            flat = [value / most for value in flat]
        if width == 1:
            return flat
        return [tuple(flat[i:i + width]) for i in range(0, len(flat), width)]

    def mesh_nodes(self, scene=None):
        """Nodes with meshes, by number."""
        nodes = self.json["nodes"]
        shown = range(len(nodes)) if scene is None else self.json["scenes"][scene]["nodes"]
        return [number for number in shown if "mesh" in nodes[number]]

    def node_of(self, name):
        numbers = [i for i, node in enumerate(self.json["nodes"]) if node.get("name") == name]
        assert len(numbers) == 1, name
        return numbers[0]

    def target_names(self, node):
        mesh = self.json["meshes"][self.json["nodes"][node]["mesh"]]
        return mesh.get("extras", {}).get("targetNames", [])

    def posed_nodes(self, frame=None):
        """Nodes with the values of a frame of the animation, if one is asked for."""
        nodes = [dict(node) for node in self.json["nodes"]]
        for node in nodes:
            if "mesh" in node:
                node["weights"] = self.json["meshes"][node["mesh"]].get("weights", [])
        if frame is None:
            return nodes
        animation, = self.json["animations"]
        for channel in animation["channels"]:
            sampler = animation["samplers"][channel["sampler"]]
            target, values = channel["target"], self.accessor(sampler["output"])
            node = nodes[target["node"]]
            if target["path"] == "weights":
                count = len(node["weights"])
                assert len(values) == count * len(self.accessor(sampler["input"]))
                node["weights"] = values[frame * count:(frame + 1) * count]
            else:
                node[target["path"]] = values[frame]
        return nodes

    def world_matrices(self, nodes):
        parents = {child: i for i, node in enumerate(nodes) for child in node.get("children", [])}
        known = {}

        def world(i):
            if i not in known:
                own = local_matrix(nodes[i])
                known[i] = multiply(world(parents[i]), own) if i in parents else own
            return known[i]
        return [world(i) for i in range(len(nodes))]

    def deformed(self, number, frame=None, weights=None):
        """Positions of the vertices of a node's mesh: targets first, then the skin. `weights` by
        name of the target take the place of those in the file; correctives follow from them."""
        nodes = self.posed_nodes(frame)
        node = nodes[number]
        primitive, = self.json["meshes"][node["mesh"]]["primitives"]
        attributes = primitive["attributes"]
        points = list(self.accessor(attributes["POSITION"]))
        used = node["weights"]
        if weights is not None:
            used = [weights.get(name, 0) for name in self.target_names(number)]
            extras = self.json["meshes"][node["mesh"]].get("extras", {})
            for corrective in extras.get("correctives", []):
                used[corrective["target"]] = math.prod(used[i] for i in corrective["product"])
        for target, weight in zip(primitive.get("targets", []), used):
            if weight != 0:
                for v, (x, y, z) in self.moves(target["POSITION"]):
                    p = points[v]
                    points[v] = (p[0] + weight * x, p[1] + weight * y, p[2] + weight * z)
        if "skin" not in node:
            own = local_matrix(node)
            return [transform(own, point) for point in points]
        skin = self.json["skins"][node["skin"]]
        world = self.world_matrices(nodes)
        palette = []
        for joint, m in zip(skin["joints"], self.accessor(skin["inverseBindMatrices"])):
            assert m[3::4] == (0, 0, 0, 1)
            rows = [m[c * 4 + r] for r in range(3) for c in range(4)]
            palette.append(multiply(world[joint], rows))
        result = []
        for (x, y, z), influence in zip(points, self.influences(attributes)):
            a = b = c = 0.0
            for j, w in influence:
                m = palette[j]
                a += w * (m[0] * x + m[1] * y + m[2] * z + m[3])
                b += w * (m[4] * x + m[5] * y + m[6] * z + m[7])
                c += w * (m[8] * x + m[9] * y + m[10] * z + m[11])
            result.append((a, b, c))
        return result


class Obj:
    """Groups of an OBJ file as Mien writes it: vertices are the pairs of normal and position."""

    def __init__(self, text):
        self.groups = {}
        positions, colors, normals, uvs = [], [], 0, 0
        for line in text.splitlines():
            tag, *words = line.split() or [""]
            if tag == "o":
                group = self.groups[words[0]] = {"first": normals, "vertex": {}, "faces": []}
            elif tag == "v":
                numbers = [float(word) for word in words]
                positions.append(tuple(numbers[:3]))
                colors.append(tuple(numbers[3:]))
            elif tag == "vt":
                uvs += 1
            elif tag == "vn":
                normals += 1
                assert abs(math.hypot(*map(float, words)) - 1) < 1e-3, line
            elif tag == "f":
                face = []
                for word in words:
                    position, uv, normal = word.split("/")
                    assert not uv or 1 <= int(uv) <= uvs
                    vertex = int(normal) - 1 - group["first"]
                    group["vertex"][vertex] = int(position) - 1
                    face.append(vertex)
                group["faces"].append(face)
        for group in self.groups.values():
            group["positions"] = {v: positions[p] for v, p in group["vertex"].items()}
            group["colors"] = {v: colors[p] for v, p in group["vertex"].items()}
