# SPDX-License-Identifier: MIT
"""python -m mien.bench [FILE.dna] [--count N] [--lod N]: what Python adds to the time of C.

C is a loop of a few lines that is compiled on the spot, if a compiler is there, and run in this
process on the very characters that Python evaluates. Rounds of C and Python alternate, and the
best of each counts, so that a machine that is busy with other things disturbs neither.
"""
from __future__ import annotations

import argparse
import ctypes
import shutil
import subprocess
import tempfile
from pathlib import Path
from time import perf_counter_ns
from typing import Any, Callable, List, Optional, Tuple

import mien
from mien._library import lib

LOOPS = r"""
#include <stddef.h>
#include <stdint.h>
#include <time.h>

typedef int32_t One(const void* rig, void* instance, uint32_t lod);
typedef int32_t Many(const void* rig, void* batch, void* const* instances, const uint32_t* lods,
                     uint32_t count, uint32_t stages, const void* parallel);

static double now(void) {
  struct timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return time.tv_sec * 1e9 + time.tv_nsec;
}

double one(One* evaluate, const void* rig, void* instance, uint32_t lod, uint32_t turns) {
  const double start = now();
  for (uint32_t i = 0; i < turns; ++i) evaluate(rig, instance, lod);
  return now() - start;
}

double many(Many* evaluate, const void* rig, void* batch, void* const* instances,
            const uint32_t* lods, uint32_t count, uint32_t stages, uint32_t turns) {
  const double start = now();
  for (uint32_t i = 0; i < turns; ++i)
    evaluate(rig, batch, instances, lods, count, stages, NULL);
  return now() - start;
}
"""


def compile_loops(directory: str) -> Optional[ctypes.CDLL]:
    """The loops in C; None without a compiler."""
    compiler = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    if not compiler:
        return None
    source, library = Path(directory, "loops.c"), Path(directory, "loops.so")
    source.write_text(LOOPS, encoding="utf-8")
    subprocess.run([compiler, "-O2", "-shared", "-fPIC", source, "-o", library], check=True)
    loops = ctypes.CDLL(str(library))
    for function in (loops.one, loops.many):
        function.restype = ctypes.c_double
    return loops


def alternate(c: Callable[[int], float], python: Callable[[int], float], turns: int,
              rounds: int) -> Tuple[float, float, float]:
    """Nanoseconds of one turn in C, in Python, and what Python adds."""
    pairs = [(c(turns) / turns, python(turns) / turns) for _ in range(rounds)]
    in_c, in_python = (min(times) for times in zip(*pairs))
    return in_c, in_python, in_python - in_c


def timed(work: Callable[[], Any]) -> Callable[[int], float]:
    def loop(turns: int) -> float:
        start = perf_counter_ns()
        for _ in range(turns):
            work()
        return float(perf_counter_ns() - start)
    return loop


def measure(rig: mien.Rig, count: int, lod: int, loops: ctypes.CDLL) -> List[Tuple[str, Any]]:
    """(what, (C, Python, difference) in nanoseconds)"""
    address = ctypes.c_void_p
    face, batch = rig.instance(), rig.batch(count)
    for i, character in enumerate((face, *batch)):
        controls = character.raw_controls
        for j in range(len(controls)):
            controls[j] = ((i + j * 7) % 11) / 10 if (i * 5 + j) % 4 == 0 else 0.0
        character.evaluate(lod)
    rig_address, face_address = address(rig._open().value), address(face._open().value)
    # Rounds short enough to be left alone now and then, long enough for the clock.
    single = timed(lambda: face.evaluate(lod))
    turns = max(1, int(2e5 / (single(100) / 100)))
    evaluate = ctypes.cast(lib.mien_rig_evaluate, address)
    found = [("face.evaluate()", alternate(
        lambda n: loops.one(evaluate, rig_address, face_address, lod, n), single, turns, 1001))]

    together = timed(lambda: batch.evaluate(lod))
    turns = max(1, int(2e5 / (together(10) / 10)))
    pointers, lods = batch._pointers, (ctypes.c_uint32 * count)(*[lod] * count)

    evaluate_batch = ctypes.cast(lib.mien_rig_evaluate_batch, address)
    batch_address = address(batch._batch.value)

    def in_c(n: int) -> float:
        return float(loops.many(evaluate_batch, rig_address, batch_address, pointers, lods, count,
                                int(mien.Stage.ALL), n))

    found.append((f"batch.evaluate(), {count} characters", alternate(in_c, together, turns, 401)))
    return found


def show(title: str, rows: List[Tuple[str, Any]]) -> None:
    print(f"{title:<36}{'C':>12}{'Python':>12}{'adds':>12}")
    for what, (c, python, difference) in rows:
        print(f"  {what:<34}{c / 1e3:>9.2f} us{python / 1e3:>9.2f} us{difference / 1e3:>9.2f} us"
              f"{difference / c * 100:>8.1f} %")


def main(arguments: Optional[List[str]] = None) -> None:
    parser = argparse.ArgumentParser(prog="python -m mien.bench")
    parser.add_argument("file", nargs="?", help="a DNA file; default: generated heads")
    parser.add_argument("--count", type=int, default=64, help="characters of the batch")
    parser.add_argument("--lod", type=int, default=0)
    args = parser.parse_args(arguments)
    print(f"mien {mien.version()}, {mien.library_path}")
    with tempfile.TemporaryDirectory() as directory:
        loops = compile_loops(directory)
        if loops is None:
            raise SystemExit("no C compiler (cc, gcc, clang) here to compare with")
        reuse = mien.Reuse.NOTHING  # else evaluating the same again would cost next to nothing
        if args.file:
            rigs = [(args.file, mien.Rig(mien.Dna.open(args.file), reuse=reuse))]
        else:
            rigs = [(f"generated, {preset.name.lower()}",
                     mien.Rig(mien.Dna.generate(preset), reuse=reuse))
                    for preset in (mien.Preset.TINY, mien.Preset.LARGE)]
        for title, rig in rigs:
            show(f"{title} ({mien.isa_name(rig.info.isa)})",
                 measure(rig, args.count, args.lod, loops))


if __name__ == "__main__":
    main()
