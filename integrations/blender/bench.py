# SPDX-License-Identifier: MIT
"""Measures the live rig in Blender: what a frame costs, whether memory grows, and what handlers in place of drivers would do.

    blender --background --python bench.py -- RIG.dna [FRAMES]

Run with the add-on installed, as ./dev blender bench does. Prints lines that begin with MEASURED.
"""
import os
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "tests"))
from support import *  # noqa: E402,F403
from rig_test import animate, baked_cloth, hanging_cloth  # noqa: E402


def resident_kilobytes():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") // 1024


class Timer:
    """CPU time that the drivers take, between two looks at it. They may run in any thread of Blender's."""

    def __init__(self):
        self.seconds = {"mien_pose": 0.0, "mien_shapes": 0.0}

    def __enter__(self):
        for name in self.seconds:
            bpy.app.driver_namespace[name] = self._timed(name, getattr(live, name))
        self._compile()
        return self

    def __exit__(self, *_):
        live.register()
        self._compile()

    def _timed(self, name, function):
        def timed(*arguments):
            start = time.thread_time()
            result = function(*arguments)
            self.seconds[name] += time.thread_time() - start
            return result
        return timed

    def _compile(self):
        """Drivers look up names when they are compiled, so let them be compiled again."""
        for owner in (*bpy.data.objects, *bpy.data.shape_keys):
            for curve in owner.animation_data.drivers if owner.animation_data else ():
                if curve.driver.expression.startswith("mien_"):
                    curve.driver.expression = curve.driver.expression


def play(frames):
    """Seconds of CPU time and seconds for each frame, from a run over the frames."""
    scene = bpy.context.scene
    scene.frame_set(1)
    wall, cpu = time.perf_counter(), time.process_time()
    for frame in range(2, frames + 2):
        scene.frame_set(frame)
    return (time.process_time() - cpu) / frames, (time.perf_counter() - wall) / frames


def measure_frames(rig_object, frames):
    random = np.random.default_rng(3)
    for name in live.file_of(rig_object).controls:
        for frame in range(1, frames + 2, 30):
            rig_object[name] = float(random.random() * (random.random() < 0.15))
            rig_object.keyframe_insert(live.control_path(name), frame=frame)
    play(60)
    before = resident_kilobytes()
    with Timer() as timer:
        cpu, wall = play(frames)
    ours = {name: 1000 * seconds / frames for name, seconds in timer.seconds.items()}
    print(f"MEASURED {frames} frames live: {1000 * cpu:.1f} ms of CPU time a frame, {1000 * wall:.1f} ms; of that "
          f"mien_pose {ours['mien_pose']:.2f} ms, mien_shapes {ours['mien_shapes']:.2f} ms")
    grown = [resident_kilobytes() - before]
    play(frames)
    grown.append(resident_kilobytes() - before)
    print(f"MEASURED memory after {frames} and {2 * frames} frames more: {grown[0]:+d} KB, {grown[1]:+d} KB")
    bpy.ops.ed.undo_push(message="a")
    for turn in range(20):
        rig_object[live.file_of(rig_object).controls[0]] = float(random.random())
        bpy.ops.ed.undo_push(message="b")
        rig_object.update_tag()
        bpy.context.view_layer.update()
        bpy.ops.ed.undo()
        rig_object = next(o for o in bpy.data.objects if o.mien.path)
        if turn == 9:
            before = resident_kilobytes()
    print(f"MEASURED memory after 10 undos more: {resident_kilobytes() - before:+d} KB")
    return rig_object


def measure_baked(rig_object, frames):
    bpy.context.scene.frame_end = frames + 1
    start = time.perf_counter()
    bpy.ops.mien.bake_keys()
    print(f"MEASURED baking {frames + 1} frames to keys: {time.perf_counter() - start:.1f} s")
    play(20)
    cpu, wall = play(frames)
    print(f"MEASURED {frames} frames of baked keys, without the add-on: {1000 * cpu:.1f} ms of CPU time a frame, "
          f"{1000 * wall:.1f} ms")


def measure_handlers():
    """A cloth that hangs from the face, as the drivers, as baked keys, and as handlers would drive it."""
    empty_scene()
    rig_object = import_rig(generated("small"))
    animate(rig_object, frames=(1, 6, 12), share=1)
    bpy.context.scene.frame_end = 12
    cloth = hanging_cloth(rig_object)
    drivers = baked_cloth(cloth, 12)
    live_face = live.Character(rig_object, live.file_of(rig_object))
    live.disconnect(rig_object, live.keys_of(rig_object))

    def handler(*_):
        live_face.set_controls(rig_object, None)
        live_face.face.evaluate()
        live_face.bones.write(rig_object.pose.bones, live_face.face.joints)
        rig_object.update_tag()

    for name in ("frame_change_pre", "frame_change_post"):
        getattr(bpy.app.handlers, name).append(handler)
        handlers = baked_cloth(cloth, 12)
        getattr(bpy.app.handlers, name).remove(handler)
        print(f"MEASURED cloth with a handler of {name} in place of the drivers: off by "
              f"{1000 * np.abs(handlers - drivers).max():.1f} mm at most")
    live.connect(rig_object, live.file_of(rig_object), live.keys_of(rig_object))
    bpy.ops.mien.bake_keys()
    keys = baked_cloth(cloth, 12)
    print(f"MEASURED cloth with the drivers, against baked keys: off by {1000 * np.abs(drivers - keys).max():.4f} mm at most")


def main():
    arguments = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
    path = arguments[0] if arguments else generated("metahuman_head")
    frames = int(arguments[1]) if len(arguments) > 1 else 300
    empty_scene()
    start, cpu = time.perf_counter(), time.process_time()
    rig_object = import_rig(path)
    print(f"MEASURED import of {os.path.basename(path)}: {time.perf_counter() - start:.1f} s, "
          f"{time.process_time() - cpu:.1f} s of CPU time")
    rig_object = measure_frames(rig_object, frames)
    measure_baked(rig_object, frames)
    measure_handlers()


if __name__ == "__main__":
    main()
