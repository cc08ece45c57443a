// SPDX-License-Identifier: MIT
//! The library starts no threads: those of the caller do its tasks.

use crate::error::check;
use crate::Result;
use mien_sys as sys;
use std::any::Any;
use std::os::raw::c_void;
use std::panic::{catch_unwind, resume_unwind, AssertUnwindSafe};
use std::sync::atomic::{AtomicU32, Ordering};

/// A share of the work, for threads of yours. Call it on any of them, any number of times: each
/// call takes pieces until there are none left.
pub type Work<'a> = &'a (dyn Fn() + Sync);

/// What C asks for: each task once, all of them done on return. Users are not asked for as much:
/// whatever they do with the work, a counter gives out each task once, and the rest is done here.
struct Runner<R> {
    run: R,
    panic: Option<Box<dyn Any + Send>>,
}

/// A task of C may be called on any thread.
#[derive(Clone, Copy)]
struct Task {
    call: unsafe extern "C" fn(*mut c_void, u32),
    context: *mut c_void,
}

// SAFETY: as mien.h says of MienParallelFor.
unsafe impl Sync for Task {}

impl Task {
    fn call(&self, i: u32) {
        // SAFETY: called while C waits in `run`, once for each index below the count.
        unsafe { (self.call)(self.context, i) }
    }
}

unsafe extern "C" fn run<R: FnMut(usize, Work<'_>)>(
    user: *mut c_void,
    count: u32,
    task: Option<unsafe extern "C" fn(*mut c_void, u32)>,
    context: *mut c_void,
) {
    // SAFETY: `user` is the runner of the call that is under way, and of no other.
    let runner = unsafe { &mut *(user as *mut Runner<R>) };
    let task = match task {
        Some(call) => Task { call, context },
        None => return,
    };
    let next = AtomicU32::new(0);
    let work = take_all(&task, &next, count);
    if runner.panic.is_none() {
        // No panic may leave through C; it goes on when C has returned.
        runner.panic = catch_unwind(AssertUnwindSafe(|| (runner.run)(count as usize, &work))).err();
    }
    work();
}

/// The work: takes tasks until there are none left. A count cannot run over: a thread that finds none
/// left stops adding.
fn take_all<'a>(task: &'a Task, next: &'a AtomicU32, count: u32) -> impl Fn() + Sync + 'a {
    move || loop {
        let taken = next
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, |i| (i < count).then_some(i + 1));
        match taken {
            Ok(i) => task.call(i),
            Err(_) => break,
        }
    }
}

/// Calls `call` with a runner that does its tasks by `run_by`.
pub(crate) fn with_runner<R: FnMut(usize, Work<'_>)>(
    run_by: R,
    call: impl FnOnce(*const sys::MienParallelFor) -> sys::MienStatus,
) -> Result<()> {
    let mut runner = Runner { run: run_by, panic: None };
    let user = &mut runner as *mut Runner<R> as *mut c_void;
    let status = call(&sys::MienParallelFor { user, run: Some(run::<R>) });
    if let Some(panic) = runner.panic {
        resume_unwind(panic);
    }
    check(status)
}
