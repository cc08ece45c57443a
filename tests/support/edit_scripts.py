# SPDX-License-Identifier: MIT
"""Random scripts for `mien edit`: right, wrong and half right."""
import json

# The word of `mien edit` for each kind, and the list of `mien info --names all`.
LISTS = {"joint": "joints", "mesh": "meshes", "blend-shape": "channels", "animated-map": "maps", "raw": "raw",
         "gui": "gui"}


def element_names(info):
    """{kind: names} from what `mien info --json --names all` prints."""
    names = {kind: info["names"][listed] for kind, listed in LISTS.items()}
    return {**names, "psd": ["psd0", "psd1", "psd2"], "ml": [], "none": []}


def random_edit(draw, names, other, array):
    def name(kind):
        return draw.choice(names[kind] + ["none", "", "a=b"])
    kind = draw.choice(list(names))
    number = draw.choice(("0", "1", "2", "0.5", "-1", "1e9", "nan", "", "x", "99999999999"))
    three = ",".join(draw.choice(("0", "1", "-30", "0.25", "inf", "")) for _ in range(draw.choice((2, 3, 3, 3, 4))))
    mesh = name("mesh")
    channel = name("blend-shape")
    return draw.choice((
        ["--rename", f"{kind}:{name(kind)}={draw.choice(('new', 'other', '', 'jaw'))}"],
        ["--remove", f"{kind}:{name(kind)}"], ["--remove", f"{kind}:{name(kind)}"],
        ["--clear", draw.choice(("blend-shapes", "animated-maps", "joint-animation", "joint-animation:" + name("joint")))],
        ["--lods", draw.choice(("0", "1-2", "0,2", "9", "2-1", ""))], ["--name", number], ["--metadata", "k=" + number],
        ["--version", draw.choice(("2.1", "2.5", "2.8", "3"))], ["--neutral", f"{name('joint')}:{three}"],
        ["--scale", number], ["--rotate", three], ["--translate", three],
        ["--system", draw.choice(("unreal", "maya", "none"))], ["--limit-influences", number],
        ["--normalize-weights", draw.choice((mesh, "all"))], ["--smooth-weights", f"{mesh}={number}"],
        ["--prune-targets", number], ["--prune-joints", three], ["--make-lod", number, "--from", "0"],
        ["--make-lod", "1", "--from", number, "--match", draw.choice(("uv", "surface", "x"))],
        ["--from", number], ["--copy-mesh", f"{mesh}={other}"],
        ["--copy-layers", f"{draw.choice(('descriptor', 'geometry', 'behavior', 'none'))}={other}"],
        ["--merge-joints", other], ["--split-joints", other], ["--transplant", other],
        ["--positions", f"{mesh}={array}"], ["--conform", f"{mesh}={array}"], ["--targets", f"{mesh}/{channel}={array}"],
        ["--skin-weights", f"{mesh}={array}"], ["--script", "x"], ["--none", "x"], [number], []))


def random_script(draw, names, other, array):
    """The text of a script. `other` is another DNA file, `array` a JSON file of positions."""
    script = [random_edit(draw, names, other, array) for _ in range(draw.choice((1, 1, 2, 3, 8)))]
    text = json.dumps(script)
    return text[:draw.randrange(len(text))] if draw.random() < 0.05 else text
