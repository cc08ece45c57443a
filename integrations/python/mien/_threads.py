# SPDX-License-Identifier: MIT
"""Executors of Python as the threads that the library asks for."""
from __future__ import annotations

import ctypes
from concurrent.futures import Executor
from threading import Lock, current_thread, main_thread
from time import sleep
from typing import Any, Callable, List, Optional

from . import _api

_run_type: Any = dict(_api.MienParallelFor._fields_)["run"]


class _Tasks:
    """The tasks of one request. They use the stack of the C call that made it, so none may run or
    start after `finish()`."""

    def __init__(self, task: Any, context: Any, count: int) -> None:
        self.task, self.context = task, context
        self.left = list(range(count))
        self.lock = Lock()
        self.active = 0

    def work(self) -> None:
        """Runs tasks until none are left. Any number of threads may call it."""
        while True:
            with self.lock:
                if not self.left:
                    return
                i = self.left.pop()
                self.active += 1
            self.task(self.context, i)
            with self.lock:
                self.active -= 1

    def finish(self) -> None:
        self.work()
        while self.active:
            sleep(1e-5)


def call_with_threads(executor: Optional[Executor], call: Callable[[Any], None]) -> None:
    """call(parallel), where `parallel` is a MienParallelFor of the executor by reference, or None.

    On the main thread the call itself becomes a job of the executor: signals interrupt the main
    thread only, so Ctrl-C ends the waiting here and not a call of the library. On other threads,
    which may be the executor's own, the call runs at once: a job must not wait for another job of
    the same executor.
    """
    if executor is None:
        call(None)
        return
    threads, failures = executor, []  # type: Executor, List[BaseException]
    is_done = False

    def run(user: Any, count: int, task: Any, context: Any) -> None:
        tasks = _Tasks(task, context, count)
        try:
            for _ in range(min(count - 1, 64)):
                threads.submit(tasks.work)
        except BaseException as error:  # must not cross the library, which takes all tasks for done
            failures.append(error)
        tasks.finish()

    def job() -> None:
        nonlocal is_done
        is_done = True
        call(ctypes.byref(_api.MienParallelFor(None, _run_type(run))))
        if failures:
            raise failures[0]

    if current_thread() is main_thread():
        threads.submit(job).result()
        if not is_done:
            raise TypeError(f"{type(threads).__name__} did not run what was submitted")
    else:
        job()
