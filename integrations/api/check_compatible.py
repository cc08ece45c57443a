#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Whether programs built with one mien.h run with a library built with another: nothing is gone,
moved or of another type, and what was added stands where it may.

    check_compatible.py OLD.json [NEW.json]    NEW: mien_api.json
    check_compatible.py                        OLD: the last release, ../../capi/mien_abi.json
    check_compatible.py --self-test
"""
import copy
import json
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
CURRENT = HERE / "mien_api.json"
RELEASED = HERE.parent.parent / "capi" / "mien_abi.json"


def load(path):
    return json.loads(Path(path).read_text(encoding="utf-8"))


def shape(type_):
    """A type without the names of parameters, which no compiled program knows."""
    if isinstance(type_, list):
        return [shape(item) for item in type_]
    if not isinstance(type_, dict):
        return type_
    if "parameters" in type_:
        return ["function", shape(type_["returns"]), [shape(p["type"]) for p in type_["parameters"]]]
    return {key: shape(value) for key, value in type_.items()}


def by_name(entries):
    return {entry["name"]: entry for entry in entries}


def numbers(api):
    """Names of constants and of values of enums, with their numbers."""
    found = {c["name"]: c["value"] for c in api["constants"] if not c["name"].startswith("MIEN_VERSION")}
    found.update((v["name"], v["value"]) for enum in api["enums"] for v in enum["values"])
    return found


def struct_breaks(old, new):
    name = old["name"]
    if (old["sized"], old["alignment"]) != (new["sized"], new["alignment"]):
        yield f"{name} has another alignment, or struct_size has come or gone"
    fields = by_name(new["fields"])
    for field in old["fields"]:
        now = fields.get(field["name"])
        # What was reserved may have got a name: it was zero until then.
        if now is None and field["name"].startswith("reserved"):
            now = next((f for f in new["fields"] if f["offset"] == field["offset"]), None)
        if now is None:
            yield f"{name}.{field['name']} is gone"
        elif any(shape(now[key]) != shape(field[key]) for key in ("offset", "size", "type")):
            yield f"{name}.{field['name']} has moved or is of another type"
    if new["size"] < old["size"] or (not old["sized"] and new["size"] != old["size"]):
        yield f"{name} is of {new['size']} bytes, was of {old['size']}"


def breaks(old, new):
    now = numbers(new)
    for name, value in numbers(old).items():
        if now.get(name) != value:
            yield f"{name} was {value}, is {now.get(name, 'gone')}"
    for kind in ("handles", "aliases", "callbacks", "functions"):
        entries = by_name(new[kind])
        for entry in old[kind]:
            name = entry["name"]
            if name not in entries:
                yield f"{name} is gone"
            elif kind == "aliases" and shape(entries[name]["type"]) != shape(entry["type"]):
                yield f"{name} is of another type"
            elif "parameters" in entry and shape(entries[name]) != shape(entry):
                yield f"{name} takes or returns something else"
    structs = by_name(new["structs"])
    for struct in old["structs"]:
        if struct["name"] in structs:
            yield from struct_breaks(struct, structs[struct["name"]])
        else:
            yield f"{struct['name']} is gone"


def self_test():
    api = load(CURRENT)

    def changed(change):
        new = copy.deepcopy(api)
        change(new)
        return list(breaks(api, new))

    def struct(new, name):
        return by_name(new["structs"])[name]

    def grow(new, name):
        s = struct(new, name)
        s["fields"].append(dict(s["fields"][0], name="added", offset=s["size"], size=8))
        s["size"] += 8

    def swap(new):
        f = struct(new, "MienRigDesc")["fields"]
        f[1]["offset"], f[2]["offset"] = f[2]["offset"], f[1]["offset"]

    function = {"name": "mien_added", "returns": {"kind": "void"}, "parameters": []}
    allowed = {
        "nothing": lambda new: None,
        "a function more": lambda new: new["functions"].append(function),
        "a longer sized struct": lambda new: grow(new, "MienRigDesc"),
        "a value more": lambda new: new["enums"][0]["values"].append({"name": "MIEN_ADDED", "value": 99}),
        "a parameter renamed": lambda new: new["functions"][-1]["parameters"][0].update(name="other"),
        "a version": lambda new: new["constants"][0].update(value=9),
    }
    refused = {
        "a function gone": lambda new: new["functions"].pop(),
        "a parameter less": lambda new: new["functions"][-1]["parameters"].pop(),
        "a parameter of another type": lambda new: new["functions"][-1]["parameters"][0].update(
            type={"kind": "scalar", "name": "double"}),
        "another result": lambda new: new["functions"][-1].update(returns={"kind": "void"}),
        "a number changed": lambda new: new["enums"][0]["values"][1].update(value=77),
        "a number gone": lambda new: new["enums"][-1]["values"].pop(),
        "fields in another order": swap,
        "a field gone": lambda new: struct(new, "MienRigDesc")["fields"].pop(1),
        "a longer struct without size": lambda new: grow(new, "MienFloatView"),
        "a struct gone": lambda new: new["structs"].pop(),
        "a handle gone": lambda new: new["handles"].pop(),
    }
    wrong = [f"{what}: {changed(change)}" for what, change in allowed.items() if changed(change)]
    wrong += [f"{what}: not noticed" for what, change in refused.items() if not changed(change)]
    print("\n".join(wrong) if wrong else f"{len(allowed)} changes allowed, {len(refused)} refused")
    return 1 if wrong else 0


def main():
    arguments = sys.argv[1:]
    if arguments == ["--self-test"]:
        return self_test()
    released = Path(arguments[0]) if arguments else RELEASED
    if not arguments and not released.exists():
        print("NOT TESTED: compatibility with the last release; there has been none")
        return 0
    problems = list(breaks(load(released), load(arguments[1] if arguments[1:] else CURRENT)))
    print("\n".join(problems) if problems else f"compatible with {released.name}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
