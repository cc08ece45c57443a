# SPDX-License-Identifier: MIT
"""Functions and objects of the caller that the library calls, and that fill its memory: each with one that
gives too much, too little, the wrong type, and that raises."""
import io
import unittest
from concurrent.futures import Executor, Future, ThreadPoolExecutor

import mien
from support import dna_of, needs_numpy, numpy, rig_of

FRAME = mien.TICKS_PER_SECOND // 60


class File(io.BytesIO):
    """A file object that does as `change` says with what its methods return."""

    def __init__(self, data, method, change):
        super().__init__(data)
        self._method, self._change = method, change

    def read(self, size=-1):
        data = super().read(size)
        return self._change(data) if self._method == "read" else data

    def seek(self, offset, whence=io.SEEK_SET):
        at = super().seek(offset, whence)
        return self._change(at) if self._method == "seek" else at

    def tell(self):
        at = super().tell()
        return self._change(at) if self._method == "tell" else at


class LongerThanItSays(bytes):
    """Bytes of which len() is less than what is in them."""

    def __len__(self):
        return 1

    def __bytes__(self):
        return b"\xff" * (1 << 20)


def fail(_):
    raise RuntimeError("the network is down")


class Streams(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        clip = mien.Clip.build(["jawOpen"], [i / 20 for i in range(20)], 30)
        cls.opens = ((mien.Dna.from_stream, dna_of().to_bytes()), (mien.Baked.from_stream, rig_of().to_bytes()),
                     (mien.Clip.from_stream, clip.to_bytes()))

    def each(self, error, method, change, says=""):
        for use, data in self.opens:
            with self.subTest(use), self.assertRaisesRegex(error, says):
                use(File(data, method, change))

    def test_more_than_was_asked_for(self):
        for more in (1, 8, 4096, 1 << 22):
            self.each(mien.ArgumentError, "read", lambda data: data + b"\xff" * more, "returned")
        # Of which a part fits.
        self.each(mien.ArgumentError, "read", lambda data: data[:1] + data, "returned")
        self.each(mien.ArgumentError, "read", lambda _: b"\xff" * (1 << 24), "returned")

    def test_less_than_was_asked_for(self):
        self.each(mien.FileError, "read", lambda _: b"")
        for use, data in self.opens:
            use(File(data, "read", lambda part: part)).close()
            pieces = File(data, "", None)
            pieces.read = lambda size: io.BytesIO.read(pieces, min(size, 7))
            use(pieces).close()  # as raw files do
            self.assertRaises(mien.FileError, use, File(data, "read", lambda part: part if len(part) < 30 else b""))

    def test_other_types(self):
        for wrong in (5, 1 << 40, "text", None, [1, 2, 3], 1.5, object()):
            self.each(TypeError, "read", lambda _, wrong=wrong: wrong)
            if not isinstance(wrong, int):
                self.each(TypeError, "seek", lambda _, wrong=wrong: wrong)
                self.each(TypeError, "tell", lambda _, wrong=wrong: wrong)

    def test_buffers_of_other_types_are_bytes(self):
        for kind in (bytearray, memoryview, LongerThanItSays):
            for use, data in self.opens:
                use(File(data, "read", kind)).close()

    @needs_numpy
    def test_arrays_count_by_their_bytes(self):
        for use, data in self.opens:
            use(File(data, "read", lambda part: numpy.frombuffer(part, "u1"))).close()
        self.each(mien.ArgumentError, "read", lambda part: numpy.zeros(len(part), "u8"), "returned")

    def test_what_they_raise_comes_out(self):
        for method in ("read", "seek", "tell"):
            self.each(RuntimeError, method, fail, "network")
        for error in (KeyboardInterrupt, SystemExit, MemoryError):
            def interrupt(_, error=error):
                raise error
            self.each(error, "read", interrupt)

    def test_sizes_that_no_file_has(self):
        for size in (-1, -1 << 63, 1 << 63, 1 << 64, (1 << 64) + 100):
            self.each(mien.ArgumentError, "seek", lambda _, size=size: size, "bytes after that")
        for use, data in self.opens[1:]:  # which read the whole file
            self.assertRaises(mien.Error, use, File(data, "seek", lambda _: (1 << 63) - 1))
        self.each(mien.ArgumentError, "tell", lambda at: at + 10**9, "bytes after that")

    def test_a_file_that_shrinks(self):
        for use, data in self.opens:
            file = File(data, "", None)
            whole = file.read

            def read(size, file=file, whole=whole):
                file.truncate(10)
                return whole(size)
            file.read = read
            self.assertRaises(mien.Error, use, file)


class Solvers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.rig = rig_of()
        cls.deformer = mien.Deformer(dna_of(), cls.rig)

    def step(self, solve, **fields):
        stack = mien.SolverStack(self.deformer, [mien.CustomSolver(solve, [0], **fields)])
        state, body = stack.state(), self.deformer.instance()
        body.update_from_values()
        state.step(body, FRAME)
        return state

    @needs_numpy
    def test_arrays_take_what_fits_alone(self):
        for name in ("locals", "outputs", "state"):
            def much(poses, _ticks, name=name):
                getattr(poses[0], name)[:] = numpy.zeros(10**6)

            def beyond(poses, _ticks, name=name):
                values = getattr(poses[0], name)
                values[len(values)] = 1

            def text(poses, _ticks, name=name):
                getattr(poses[0], name)[0] = "text"

            for solve, error in ((much, ValueError), (beyond, IndexError), (text, ValueError)):
                with self.subTest(name), self.assertRaises(error):
                    self.step(solve, output_count=2, state_floats=3)

    def test_inputs_are_read_only(self):
        for name in ("models", "previous"):
            def write(poses, _ticks, name=name):
                getattr(poses[0], name)[0] = 1
            with self.subTest(name), self.assertRaises((TypeError, ValueError)):
                self.step(write, previous_joints=[0])

    def test_the_lists_of_the_description_may_change(self):
        """They were read when the stack was made: a longer one would look past the memory."""
        joints, sizes = [0], []
        stack = mien.SolverStack(self.deformer, [mien.CustomSolver(
            lambda poses, _: sizes.append(len(poses[0].previous)), [0], previous_joints=joints)])
        joints.extend([0] * 10**6)
        state, body = stack.state(), self.deformer.instance()
        body.update_from_values()
        state.step(body, FRAME)
        self.assertEqual(sizes, [1 if numpy is not None else 16])

    def test_a_function_that_closes_what_is_stepped(self):
        stack = mien.SolverStack(self.deformer, [mien.CustomSolver(lambda poses, _: close(poses), [0])])
        state, body = stack.state(), self.deformer.instance()
        body.update_from_values()
        kept = []

        def close(poses):
            state.close()
            body.close()
            stack.close()
            kept.append(poses[0].locals)

        state.step(body, FRAME)
        self.assertTrue(kept[0].shape)
        self.assertRaises(mien.ClosedError, state.step, body, FRAME)

    def test_a_function_that_steps_its_own_state(self):
        stack = mien.SolverStack(self.deformer, [mien.CustomSolver(lambda *_: state.step(body, FRAME), [0])])
        state, body = stack.state(), self.deformer.instance()
        body.update_from_values()
        self.assertRaises(mien.BusyError, state.step, body, FRAME)

    def test_what_they_raise_comes_out(self):
        for error in (RuntimeError, KeyboardInterrupt, SystemExit):
            def raise_it(*_, error=error):
                raise error
            self.assertRaises(error, self.step, raise_it)
        self.assertRaises(TypeError, self.step, lambda: None)
        self.assertRaises(TypeError, self.step, None)

    def test_counts_that_are_none(self):
        for wrong in (-1, 1 << 30, 1 << 62):
            self.assertRaises(mien.Error, self.step, print, state_floats=wrong)
        for wrong in (-1, 1 << 32):
            self.assertRaises(mien.Error, self.step, print, output_count=wrong)
        for wrong in (0.5, "1", None):
            self.assertRaises(TypeError, self.step, print, state_floats=wrong)
            self.assertRaises(TypeError, self.step, print, output_count=wrong)


class Wrong(Executor):
    """An executor that does `what` instead."""

    def __init__(self, what):
        self.what = what

    def submit(self, fn, *args, **kwargs):
        return self.what(lambda: fn(*args, **kwargs))


def done(value=None):
    future = Future()
    future.set_result(value)
    return future


class Threads(unittest.TestCase):
    @needs_numpy
    def test_executors(self):
        """Too few runs, too many, and none: all tasks are done, or an exception says that they are not."""
        wanted = rig_of().batch(64)
        wanted.raw_controls = 0.5
        wanted.evaluate()
        calls = []

        def only_the_first(run):
            calls.append(run)
            if len(calls) > 1:
                raise OSError("no more threads")
            return done(run())

        for what, error in ((lambda run: done(run()), None), (lambda run: (run(), done(run()))[1], None),
                            (lambda run: done(), TypeError), (only_the_first, OSError), (fail, RuntimeError),
                            (lambda run: run(), AttributeError)):
            batch = rig_of().batch(64, tasks=4)
            batch.raw_controls = 0.5
            if error:
                with self.assertRaises(error):
                    batch.evaluate(threads=Wrong(what))
            else:
                batch.evaluate(threads=Wrong(what))
            if error in (None, OSError):
                self.assertTrue((batch.joints == wanted.joints).all())

    @needs_numpy
    def test_tasks_that_start_after_the_call_do_nothing(self):
        late = []

        def now_and_later(run):
            late.append(run)
            return done(run())

        batch = rig_of().batch(64, tasks=4)
        batch.evaluate(threads=Wrong(now_and_later))
        self.assertGreater(len(late), 1)
        for run in late[1:]:
            run()

    def test_an_executor_that_is_shut_down(self):
        pool = ThreadPoolExecutor(1)
        pool.shutdown()
        self.assertRaises(RuntimeError, rig_of().batch(8).evaluate, threads=pool)


if __name__ == "__main__":
    unittest.main()
