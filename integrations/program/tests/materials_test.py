#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Materials and textures: from meshes to rigs, images and exported files, and files that are wrong.

    materials_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)

Textures are small PNG files made here.
"""
import json
import os
import re
import struct
import sys
import zlib

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "tests", "support"))
from glb import Glb  # noqa: E402
from picture import Picture  # noqa: E402
from program import FILE, INVALID, USAGE, ProgramTest, main, make, make_folder, path, read, write  # noqa: E402

MESH = "head_lod0_mesh"


def png(color, size=4, other=None):
    """A chessboard of two colors, or one color; of three numbers, or of four with an alpha."""
    rows = b"".join(b"\0" + b"".join(bytes(color if (x + y) % 2 == 0 or not other else other) for x in range(size))
                    for y in range(size))
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", size, size, 8, 2 if len(color) == 3 else 6, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


RED, FLAT, ROUGH = png((200, 20, 20)), png((128, 128, 255)), png((30, 30, 30))


def setUpModule():
    make_folder()
    make("gen", "-o", path("tiny.dna"), "--preset", "tiny")
    make("demo-head", "-o", path("person.dna"))
    os.mkdir(path("textures"))
    write("textures/head_basecolor.png", RED)
    write("textures/T_Head_Normal.png", FLAT)
    write("textures/head_roughness.png", ROUGH)


class MaterialsTest(ProgramTest):
    def tearDown(self):
        if os.path.exists(path("tiny.materials.json")):
            os.remove(path("tiny.materials.json"))

    def sidecar(self, content):
        return write("tiny.materials.json", content if isinstance(content, (str, bytes)) else json.dumps(content))

    def image(self, glb, material, *keys):
        """Bytes of the image of a texture of a material, embedded or beside."""
        for key in keys:
            material = material[key]
        image = glb.json["images"][glb.json["textures"][material["index"]]["source"]]
        if "uri" in image:
            return image["uri"]
        view = glb.json["bufferViews"][image["bufferView"]]
        self.assertEqual(image["mimeType"], "image/png")
        return glb.binary[view["byteOffset"]:view["byteOffset"] + view["byteLength"]]

    def material(self, glb, mesh):
        found, = [m for m in glb.json["meshes"] if m["name"] == mesh]
        primitive, = found["primitives"]
        return glb.json["materials"][primitive["material"]], primitive["attributes"]


class GeneratedHead(MaterialsTest):
    def test_textures_of_the_skin(self):
        self.ok("demo-head", "-o", path("made.dna"), "--textures", path("made"), "-q")
        sidecar = json.loads(read("made.materials.json"))
        parts = {"head": "skin", "eyeLeft": "eyes", "eyeRight": "eyes", "tongue": "tongue", "teeth": "teeth",
                 "hair": "hair",
                 "brows": "brows", "lashes": "lashes"}
        self.assertEqual(sidecar["meshes"],
                         {"%s_lod%d_mesh" % (part, lod): name for part, name in parts.items() for lod in range(8)})
        skin, eyes, tongue, teeth, *hairs = sidecar["materials"]
        self.assertEqual(skin["textures"], {"base_color": "made/skin_basecolor.png", "normal": "made/skin_normal.png",
                                            "roughness": "made/skin_roughness.png"})
        self.assertEqual(teeth["textures"], {"base_color": "made/teeth_basecolor.png", "normal": "made/teeth_normal.png",
                                             "roughness": "made/teeth_roughness.png"})
        for name, size in (("skin_basecolor", (1152, 768)), ("skin_normal", (1152, 768)), ("skin_roughness", (576, 384)),
                           ("teeth_basecolor", (512, 256)), ("teeth_normal", (256, 128)), ("teeth_roughness", (256, 128))):
            self.assertEqual(struct.unpack(">II", read("made/%s.png" % name)[16:24]), size)
        self.assertEqual(eyes["textures"], {"base_color": "made/eyes_basecolor.png", "normal": "made/eyes_normal.png"})
        self.assertEqual(set(eyes["cornea"]), {"depth", "iris"})
        self.assertEqual(tongue["textures"], {"normal": "made/tongue_normal.png"})
        # The iris has the color that the eyes have without a texture: blue, while the white is not.
        iris = Picture(read("made/eyes_basecolor.png"))
        below, white = iris.at(256, 256 + 62), iris.at(256 + 120, 256)
        self.assertGreater(below[2], 1.2 * below[0])
        self.assertGreater(white[0], white[2])
        self.assertLess(max(iris.at(256, 256)), 16, "the pupil")
        self.ok("demo-head", "-o", path("plain.dna"), "-q")
        pictures = {}
        for name in ("plain", "made"):
            self.ok("render", path(name + ".dna"), "-o", path(name + ".png"), "--target", "face", "--size", "96", "-q")
            pictures[name] = Picture(read(name + ".png"))
        made, plain = pictures["made"], pictures["plain"]
        # Lips are redder than the forehead, as with the colors of vertices; what differs is little, but nearly everywhere.
        forehead, lip = made.at(48, 9), made.at(48, 63)
        self.assertGreater(lip[0] / lip[1], 1.08 * forehead[0] / forehead[1])
        apart = [sum(abs(a - b) for a, b in zip(made.at(x, y), plain.at(x, y))) for x in range(30, 66) for y in range(30, 66)]
        self.assertLess(sum(apart) / len(apart), 24)
        self.assertGreater(sum(d > 0 for d in apart) / len(apart), 0.7)
        self.ok("export", path("made.dna"), "-o", path("made.glb"), "--lod", "4", "-q")
        glb = Glb(read("made.glb"))
        material, attributes = self.material(glb, "head_lod4_mesh")
        self.assertEqual(self.image(glb, material, "normalTexture"), read("made/skin_normal.png"))
        self.assertNotIn("COLOR_0", attributes)
        self.assertEqual(self.material(glb, "eyeLeft_lod4_mesh")[0]["extras"]["cornea"], eyes["cornea"])
        self.assertNotIn("extras", material)
        material, attributes = self.material(glb, "tongue_lod4_mesh")
        self.assertEqual(self.image(glb, material, "normalTexture"), read("made/tongue_normal.png"))
        self.assertIn("COLOR_0", attributes)
        # Hair, brows and lashes share an image of gray and alpha, each with the color of its hairs, and are cut out.
        self.assertEqual(struct.unpack(">IIBB", read("made/hair.png")[16:26]), (512, 640, 8, 4))
        for hair in hairs:
            self.assertEqual(hair["textures"], {"base_color": "made/hair.png"})
            self.assertEqual(hair["base_color"][3], 1)
            self.assertLess(hair["base_color"][2], hair["base_color"][0], "brown")
            material, attributes = self.material(glb, hair["name"] + "_lod4_mesh")
            self.assertEqual((material["alphaMode"], material["alphaCutoff"], material["doubleSided"]),
                             ("MASK", hair["alpha_cutoff"], True))
            self.assertEqual(material["pbrMetallicRoughness"]["baseColorFactor"], hair["base_color"])
            self.assertNotIn("COLOR_0", attributes)
        self.assertNotIn("alphaMode", self.material(glb, "head_lod4_mesh")[0])
        self.assertEqual(sum("hair" in image.get("name", "") for image in glb.json["images"]), 1)
        # Drawn, there is skin between the hairs of the brows: more of it than between the strips without a texture.
        dark = {}
        for name in ("plain", "made"):
            self.ok("render", path(name + ".dna"), "-o", path("brow.png"), "--meshes", "brows*", "--size", "192",
                    "--background", "light", "--force", "-q")
            picture = Picture(read("brow.png"))
            dark[name] = sum(max(picture.at(x, y)) < 110 for x in range(192) for y in range(192))
        self.assertGreater(dark["made"], 40)
        self.assertLess(dark["made"], 0.85 * dark["plain"])
        self.ok("export", path("made.dna"), "-o", path("made.usda"), "--lod", "4", "-q")
        text = read("made.usda").decode()
        self.assertEqual(text.count("float inputs:opacityThreshold = 0.25"), 2)
        self.assertEqual(text.count("float inputs:opacityThreshold = 0.3"), 1)
        self.assertEqual(len(re.findall(r"float inputs:opacity.connect = <.*/BaseColor.outputs:a>", text)), 3)
        self.fails(USAGE, "demo-head", "-o", "-", "--textures", path("made"), says="--textures")


class Export(MaterialsTest):
    def test_a_folder_of_textures(self):
        write("textures/unknown_thing.png", RED)
        done = self.ok("export", path("tiny.dna"), "-o", path("t.glb"), "--textures", path("textures"))
        os.remove(path("textures/unknown_thing.png"))
        self.assertIn("unknown_thing.png", done.stderr)
        glb = Glb(read("t.glb"))
        material, attributes = self.material(glb, MESH)
        surface = material["pbrMetallicRoughness"]
        self.assertEqual(self.image(glb, surface, "baseColorTexture"), RED)
        self.assertEqual(self.image(glb, surface, "metallicRoughnessTexture"), ROUGH)
        self.assertEqual(self.image(glb, material, "normalTexture"), FLAT)
        self.assertEqual(surface["baseColorFactor"], [1, 1, 1, 1])
        self.assertEqual((surface["metallicFactor"], surface["roughnessFactor"]), (0, 1))
        self.assertNotIn("COLOR_0", attributes)
        self.assertEqual(len(glb.json["images"]), 3)

    def test_links(self):
        os.makedirs(path("out"), exist_ok=True)
        self.ok("export", path("tiny.dna"), "-o", path("out/t.glb"), "--textures", path("textures"), "--link-textures")
        glb = Glb(read("out/t.glb"))
        uri = self.image(glb, self.material(glb, MESH)[0]["pbrMetallicRoughness"], "baseColorTexture")
        self.assertEqual(uri, "../textures/head_basecolor.png")
        self.ok("export", path("tiny.dna"), "-o", path("out/t.obj"), "--textures", path("textures"))
        self.assertIn("map_Kd ../textures/head_basecolor.png\n", read("out/t.mtl").decode())
        self.assertIn("norm ../textures/T_Head_Normal.png\n", read("out/t.mtl").decode())
        self.ok("export", path("tiny.dna"), "-o", path("out/t.usda"), "--textures", path("textures"))
        text = read("out/t.usda").decode()
        for name in ("head_basecolor", "T_Head_Normal", "head_roughness"):
            self.assertIn("asset inputs:file = @../textures/%s.png@" % name, text)
        for ending in ("vrm", "usda"):
            self.fails(USAGE, "export", path("tiny.dna"), "-o", path("no." + ending), "--link-textures",
                       says="--link-textures")

    def test_a_vrm_holds_them(self):
        self.ok("export", path("person.dna"), "-o", path("p.vrm"), "--lod", "6", "--textures", path("textures"), "-q")
        glb = Glb(read("p.vrm"))
        self.assertEqual(self.image(glb, self.material(glb, "head_lod6_mesh")[0]["pbrMetallicRoughness"],
                                    "baseColorTexture"), RED)

    def test_wrong_folders(self):
        export = ("export", path("tiny.dna"), "-o", path("no.glb"), "--influences", "12", "--textures")
        self.fails(FILE, *export, path("nowhere"), says="nowhere")
        os.makedirs(path("empty"), exist_ok=True)
        self.fails(INVALID, *export, path("empty"), says=("empty", "no PNG or JPEG"))
        write("empty/wing_basecolor.png", RED)
        self.fails(INVALID, *export, path("empty"), says=("wing_basecolor.png", "head_basecolor.png"))
        os.rename(path("empty/wing_basecolor.png"), path("empty/head_basecolor.png"))
        write("empty/head_basecolor.png", b"GIF89a")
        self.fails(INVALID, *export, path("empty"), says=("head_basecolor.png", "neither PNG nor JPEG"))
        self.fails(USAGE, *export, path("textures"), "--no-uvs", says="--no-uvs")


class Sidecar(MaterialsTest):
    def test_beside_the_rig(self):
        self.sidecar({"materials": [{"name": "clay", "base_color": [0.5, 0.25, 1, 1], "roughness": 0.25,
                                     "textures": {"base_color": "textures/head_basecolor.png"}}],
                      "meshes": {MESH: "clay"}})
        self.ok("export", path("tiny.dna"), "-o", path("t.glb"))
        glb = Glb(read("t.glb"))
        material, _ = self.material(glb, MESH)
        self.assertEqual(material["name"], "clay")
        self.assertEqual(material["pbrMetallicRoughness"]["baseColorFactor"], [0.5, 0.25, 1, 1])
        self.assertEqual(material["pbrMetallicRoughness"]["roughnessFactor"], 0.25)
        self.assertEqual(self.image(glb, material["pbrMetallicRoughness"], "baseColorTexture"), RED)

    def draw(self, **textures):
        for kind, data in textures.items():
            write(kind + ".png", data)
        self.sidecar({"materials": [{"name": "skin", "textures": {kind: kind + ".png" for kind in textures}}],
                      "meshes": {MESH: "skin"}})
        self.ok("render", path("tiny.dna"), "-o", path("drawn.png"), "--size", "160", "--force")
        return Picture(read("drawn.png"))

    def test_cutouts_come_back_from_a_glb(self):
        self.sidecar({"materials": [{"name": "hair", "alpha_cutoff": 0.25,
                                     "textures": {"base_color": "cut.png"}}], "meshes": {MESH: "hair"}})
        write("cut.png", png((200, 20, 20, 128)))
        self.ok("export", path("tiny.dna"), "-o", path("cut.glb"), "--force")
        material, _ = self.material(Glb(read("cut.glb")), MESH)
        self.assertEqual((material["alphaMode"], material["alphaCutoff"]), ("MASK", 0.25))
        self.ok("author", path("cut.glb"), "-o", path("cut.dna"), "--confidence", "0", "--force", "-q")
        back, = [m for m in json.loads(read("cut.materials.json"))["materials"] if m["name"] == "hair"]
        self.assertEqual(back["alpha_cutoff"], 0.25)

    def test_images_show_the_textures(self):
        plain = self.draw(base_color=png((128, 128, 128)))
        red = self.draw(base_color=RED)
        middle = [picture.at(80, 80) for picture in (plain, red)]
        self.assertLess(max(middle[0]) - min(middle[0]), 40)
        self.assertGreater(middle[1][0], 2 * max(middle[1][1:]))
        gray = png((128, 128, 128))
        places = [(x, y) for x in range(40, 120, 4) for y in range(40, 120, 4)]
        def apart(a, b):
            return sum(abs(p - q) for place in places for p, q in zip(a.at(*place), b.at(*place))) / len(places)
        # A normal map of straight normals changes nothing to see, one of slanted normals does; so does gloss.
        self.assertLess(apart(plain, self.draw(base_color=gray, normal=FLAT)), 3)
        self.assertGreater(apart(plain, self.draw(base_color=gray, normal=png((220, 128, 200)))), 8)
        glossy = self.draw(base_color=gray, roughness=png((20, 20, 20)))
        chalk = self.draw(base_color=gray, roughness=png((255, 255, 255)))
        self.assertGreater(apart(glossy, chalk), 2)

    def test_alpha_shows_what_is_behind(self):
        """A surface of alpha 0 is not there, and one of a half lets half of the backdrop through."""
        def at(color):
            picture = self.draw(base_color=png(color))
            return picture.at(80, 80), picture.at(2, 80)
        (opaque, backdrop), (gone, _), (half, _) = (at((200, 20, 20) + alpha) for alpha in ((255,), (0,), (128,)))
        self.assertEqual(at((200, 20, 20))[0], opaque)
        self.assertGreater(opaque[0], 2 * opaque[2])
        self.assertLess(max(gone) - min(gone), 40, "the backdrop is gray")
        self.assertLess(abs(half[0] - (opaque[0] + gone[0]) / 2), 45)
        self.assertGreater(min(opaque[0] - half[0], half[0] - gone[0]) if opaque[0] > gone[0] else 99, 5)
        # The same by the alpha of the material.
        self.sidecar({"materials": [{"name": "a", "base_color": [1, 0, 0, 0]}], "meshes": {MESH: "a"}})
        self.ok("render", path("tiny.dna"), "-o", path("drawn.png"), "--size", "160", "--force")
        self.assertEqual(Picture(read("drawn.png")).at(80, 80), gone)

    def test_jpeg_goes_along_but_is_not_drawn(self):
        jpeg = b"\xff\xd8\xff\xe0" + bytes(64)
        write("a.jpg", jpeg)
        self.sidecar({"materials": [{"name": "a", "textures": {"base_color": "a.jpg"}}], "meshes": {MESH: "a"}})
        done = self.ok("render", path("tiny.dna"), "-o", path("drawn.png"), "--size", "32", "--force")
        self.assertIn("JPEG textures are not drawn", done.stderr)
        self.ok("export", path("tiny.dna"), "-o", path("t.glb"))
        self.assertIn(jpeg, read("t.glb"))

    def test_hostile_files(self):
        one = {"name": "a", "textures": {"base_color": "textures/head_basecolor.png"}}
        many = [{"name": str(i)} for i in range(4097)]
        wrong = [("[]", "object"), ("{", "byte"), ("", "tiny.materials.json"), ({"other": 1}, "other"),
                 ({"materials": 1}, "list"), ({"materials": [1]}, "materials[0]"), ({"materials": [{}]}, "name"),
                 ({"materials": [one, one]}, '"a"'), ({"materials": many}, "4096"),
                 ({"materials": [{"name": "a" * 256}]}, "255"), ({"materials": [{"name": "a\0b"}]}, "NUL"),
                 ({"materials": [{"name": "a", "base_color": [1, 1, 1]}]}, "four"),
                 ({"materials": [{"name": "a", "base_color": [1, 1, 1, 2]}]}, "0 to 1"),
                 ({"materials": [{"name": "a", "roughness": "x"}]}, "0 to 1"),
                 ({"materials": [{"name": "a", "alpha_cutoff": 2}]}, "0 to 1"),
                 ({"materials": [{"name": "a", "cornea": 0.4}]}, "object"),
                 ({"materials": [{"name": "a", "cornea": {"depth": 0.4, "index": 1}}]}, "index"),
                 ({"materials": [{"name": "a", "cornea": {"depth": 0.4}}]}, "depth"),
                 ({"materials": [{"name": "a", "cornea": {"depth": 0, "iris": 0.2}}]}, "more than 0"),
                 ({"materials": [{"name": "a", "cornea": {"depth": 0.4, "iris": 0.6}}]}, "0.5"),
                 ({"materials": [{"name": "a", "cornea": {"depth": 2, "iris": 0.2}}]}, "0 to 1"),
                 ({"materials": [{"name": "a", "textures": {"gloss": "x"}}]}, "gloss"),
                 ({"materials": [{"name": "a", "textures": {"normal": "x" * 4096}}]}, "4095"),
                 ({"materials": [{"name": "a"}], "meshes": {MESH: "b"}}, "no such material"),
                 ({"materials": [{"name": "a"}], "meshes": [1]}, "object"),
                 ('{"materials": [], "materials": []}', "twice"), (b" " * (17 << 20), "16 MB")]
        for content, says in wrong:
            self.sidecar(content)
            for command in (("export", path("tiny.dna"), "-o", path("no.glb")),
                            ("render", path("tiny.dna"), "-o", path("no.png"), "--size", "8")):
                self.fails(INVALID, *command, says=says)

    def test_hostile_textures(self):
        os.makedirs(path("odd"), exist_ok=True)
        os.mkfifo(path("odd/pipe"))
        wide = bytearray(RED)
        struct.pack_into(">II", wide, 16, 1 << 14, 1 << 14)
        struct.pack_into(">I", wide, 29, zlib.crc32(wide[12:29]))
        broken = bytearray(RED)
        broken[len(RED) // 2] ^= 255
        for data, code, says in ((b"", INVALID, "neither"), (b"%PDF", INVALID, "neither"), (bytes(wide), INVALID, "2^26"),
                                 (RED[:50], INVALID, "libpng"), (bytes(broken), INVALID, "libpng"),
                                 (None, FILE, "no such file"), ("pipe", FILE, "regular"), ("/dev/zero", FILE, "regular")):
            name = data if isinstance(data, str) else "a.png"
            if isinstance(data, bytes):
                write("odd/a.png", data)
            elif data is None:
                os.remove(path("odd/a.png"))
            self.sidecar({"materials": [{"name": "a", "textures": {"base_color": os.path.join("odd", name)}}],
                          "meshes": {MESH: "a"}})
            self.fails(code, "render", path("tiny.dna"), "-o", path("no.png"), "--size", "8", says=says)


class Author(MaterialsTest):
    def test_from_a_glb_to_a_rig_and_on(self):
        """The default export, of integers, is read back where it was; its textures lie beside the rig."""
        self.ok("export", path("person.dna"), "-o", path("in.glb"), "--lod", "6", "--bake", "arkit", "-q",
                "--textures", path("textures"))
        self.ok("author", path("in.glb"), "-o", path("made.dna"), "--joints", "16", "--lods", "1")
        table = json.loads(read("made.materials.json"))
        names = self.names("made.dna", "meshes")
        self.assertEqual(set(table["meshes"]), set(names))
        head, = [m for m in table["materials"] if m["name"] == table["meshes"]["head_lod6_mesh_lod0_mesh"]]
        self.assertEqual(read(head["textures"]["base_color"]), RED)
        self.assertEqual(read(head["textures"]["normal"]), FLAT)
        self.assertTrue(head["textures"]["roughness"].startswith("made.textures"))
        self.ok("export", path("made.dna"), "-o", path("again.glb"))
        glb = Glb(read("again.glb"))
        material, _ = self.material(glb, "head_lod6_mesh_lod0_mesh")
        self.assertEqual(self.image(glb, material["pbrMetallicRoughness"], "baseColorTexture"), RED)
        before = Glb(self.ok("export", path("person.dna"), "-o", "-", "--lod", "6", "-q").stdout)
        boxes = []
        for file, mesh in ((before, "head_lod6_mesh"), (glb, "head_lod6_mesh_lod0_mesh")):
            points = file.deformed(file.node_of(mesh))
            boxes.append([limit(p[k] for p in points) for k in range(3) for limit in (min, max)])
        for a, b in zip(*boxes):
            self.assertAlmostEqual(a, b, places=4)
        self.ok("render", path("made.dna"), "-o", path("made.png"), "--size", "160")
        middle = Picture(read("made.png")).at(80, 80)
        self.assertGreater(middle[0], 2 * max(middle[1:]))

    def attach(self, mtl, uses="usemtl a"):
        write("bad.mtl", mtl)
        write("hat.obj", "mtllib bad.mtl\no hat\n%s\nv 0 0.2 0\nv 0.1 0.2 0\nv 0 0.2 0.1\nf 1 2 3\n" % uses)
        return ("export", path("tiny.dna"), "-o", path("no.glb"), "--influences", "12", "--attach", path("hat.obj"))

    def test_attached_meshes_bring_their_materials(self):
        mtl = "newmtl felt\nKd 0.5 0.25 1\nPr 0.75\nd 0.5\nmap_Kd %s\n" % "textures/head_basecolor.png"
        command = list(self.attach(mtl, "usemtl felt"))
        write("hat.obj", read("hat.obj").replace(b"f 1 2 3", b"vt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3"))
        self.ok(*command, "--force")
        material, _ = self.material(Glb(read("no.glb")), "hat")
        surface = material["pbrMetallicRoughness"]
        self.assertEqual(material["name"], "felt")
        self.assertAlmostEqual(surface["roughnessFactor"], 0.75)
        self.assertEqual((surface["baseColorFactor"][3], material["alphaMode"]), (0.5, "BLEND"))
        self.assertEqual(self.image(Glb(read("no.glb")), surface, "baseColorTexture"), RED)
        # A GLB holds its image, which a USD file cannot name.
        write("hat.glb", read("no.glb"))
        other = [path("hat.glb") if word == path("hat.obj") else word for word in command]
        self.ok(*other, "--force")
        glb = Glb(read("no.glb"))
        felt, = [m for m in glb.json["materials"] if m["name"] == "felt"]
        self.assertEqual(self.image(glb, felt["pbrMetallicRoughness"], "baseColorTexture"), RED)
        usd = self.ok(*[path("no.usda") if word == path("no.glb") else word for word in other], "--force")
        self.assertIn("hat.glb#0", usd.stderr)
        # What stands beside the rig wins.
        self.sidecar({"materials": [{"name": "straw", "roughness": 0.25}], "meshes": {"hat": "straw"}})
        self.ok(*command, "--force")
        self.assertEqual(self.material(Glb(read("no.glb")), "hat")[0]["name"], "straw")
        write("bad.mtl", mtl.replace("head_basecolor", "nowhere"))
        os.remove(path("tiny.materials.json"))
        self.assertIn("nowhere.png", self.ok(*command, "--force").stderr)

    def test_hostile_mtl(self):
        for mtl, says in (("newmtl a\nKd x 0 0\n", "line 2"), ("Kd 1 1 1\n", "newmtl"), ("newmtl a\nKd 1 1\n", "lacks"),
                          ("newmtl " + "a" * 256 + "\n", "255"), ("newmtl a\nmap_Kd -bm 1\n", "no file name"),
                          ("newmtl a\nmap_Kd " + "a" * 4096 + "\n", "4095"), ("newmtl a\nd nan\n", "line 2"),
                          ("newmtl a\n# " + "x" * (1 << 20) + "\n", "megabyte"),
                          ("newmtl a\n" * 65537, "65536")):
            self.fails(INVALID, *self.attach(mtl), says=("bad.mtl", says))
        self.fails(INVALID, *self.attach("", "usemtl " + "a" * 256), says=("hat.obj", "255"))
        self.fails(INVALID, *self.attach("", "\n".join("usemtl a%d" % i for i in range(4097))), says="4096")
        self.fails(INVALID, *self.attach("", "mtllib x\n" * 65), says="mtllib")

    def test_parts_with_other_materials_are_meshes(self):
        """Faces that share positions stay one mesh; others are one for each material."""
        write("two.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n")
        triangle = "v %g 0.2 0\nv %g 0.2 0\nv %g 0.2 0.1\n"
        apart = triangle % (0, 0.1, 0) + triangle % (1, 1.1, 1)
        write("two.obj", "mtllib two.mtl\no hat\n" + apart + "usemtl red\nf 1 2 3\nusemtl blue\nf 4 5 6\n")
        self.ok("export", path("tiny.dna"), "-o", path("t.glb"), "--attach", path("two.obj"))
        names = [mesh["name"] for mesh in Glb(read("t.glb")).json["meshes"]]
        self.assertTrue({"hat.red", "hat.blue"} <= set(names), names)
        write("two.obj", "mtllib two.mtl\no hat\n" + apart + "usemtl red\nf 1 2 3\nusemtl blue\nf 3 4 5\nf 4 5 6\n")
        self.ok("export", path("tiny.dna"), "-o", path("t.glb"), "--attach", path("two.obj"))
        names = [mesh["name"] for mesh in Glb(read("t.glb")).json["meshes"]]
        self.assertIn("hat", names)


if __name__ == "__main__":
    main()
