# SPDX-License-Identifier: MIT
"""Run by run.py in a Blender with a window, such as one of Xvfb: what needs an event loop. Import, undo by the user's key, the
auto-rig that runs while Blender stays usable, its end and its cancellation. Takes a screenshot, $MIEN_SCREENSHOT."""
import os
import sys
import traceback

sys.path.insert(0, os.path.dirname(__file__))
from support import *  # noqa: E402,F403
from tools_test import egg  # noqa: E402


def view():
    """Arguments of temp_override for the 3D view."""
    window = bpy.context.window_manager.windows[0]
    area = next(a for a in window.screen.areas if a.type == "VIEW_3D")
    return {"window": window, "screen": window.screen, "area": area,
            "region": next(r for r in area.regions if r.type == "WINDOW")}


def character():
    return next((o for o in bpy.data.objects if o.mien.path), None)


def steps():
    """Each yield lets Blender handle events for so many seconds."""
    with bpy.context.temp_override(**view()):
        bpy.ops.mien.import_rig("EXEC_DEFAULT", True, filepath=generated("small"))
    yield 0.5
    reference = Reference(generated("small"))
    controls = np.random.default_rng(1).random(len(reference.face.raw_controls)).astype(np.float32)
    set_controls(character(), controls)
    with bpy.context.temp_override(**view()):
        bpy.ops.ed.undo_push(message="pose")
    yield 0.5
    assert largest_error(character(), reference, controls) < 1e-5
    with bpy.context.temp_override(**view()):
        bpy.ops.ed.undo()
    yield 0.5
    assert largest_error(character(), reference, reference.rig.initial_raw_controls) < 1e-5
    if os.environ.get("MIEN_SCREENSHOT"):
        with bpy.context.temp_override(**view()):
            bpy.ops.screen.screenshot(filepath=os.environ["MIEN_SCREENSHOT"])

    for cancel in (False, True):
        for thing in list(bpy.data.objects):
            bpy.data.objects.remove(thing)
        egg()
        path = os.path.join(FOLDER, f"window_{cancel}.dna")
        with bpy.context.temp_override(**view(), object=bpy.data.objects["egg"], active_object=bpy.data.objects["egg"]):
            assert bpy.ops.mien.auto_rig("EXEC_DEFAULT", filepath=path, joints=40, lods=2) == {"RUNNING_MODAL"}
            job = module("auto_rig").running[0]
        if cancel:
            job.canceled.set()  # as Esc does
        for _ in range(600):
            if not module("auto_rig").running:
                break
            yield 0.1
        assert not module("auto_rig").running, "the auto-rig did not end"
        assert os.path.exists(path) != cancel
        assert (character() is None) == cancel
    print("WINDOW OK", flush=True)


def run(iterator):
    try:
        return next(iterator)
    except StopIteration:
        bpy.ops.wm.quit_blender()
    except BaseException:
        traceback.print_exc()
        sys.stdout.flush()
        os._exit(1)
    return None


iterator = steps()
bpy.app.timers.register(lambda: run(iterator), first_interval=1)
