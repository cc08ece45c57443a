// SPDX-License-Identifier: MIT

use crate::convert::slice;
use crate::error::check;
use crate::{Allocator, ClipEvent, ClipPlayerInfo, Result};
use mien_sys as sys;
use std::ptr::NonNull;

/// One character's playing of one [`Clip`](crate::Clip), whose memory stays alive with it. Times are
/// in ticks of 1 / [`TICKS_PER_SECOND`](crate::TICKS_PER_SECOND).
pub struct ClipPlayer {
    pub(crate) handle: NonNull<sys::MienClipPlayer>,
    // Dropped after the handle is destroyed.
    pub(crate) _allocator: Option<Allocator>,
}

// SAFETY: a player may be used by any thread, by one at a time if it is changed, which takes
// `&mut self` here.
unsafe impl Send for ClipPlayer {}
unsafe impl Sync for ClipPlayer {}

impl Drop for ClipPlayer {
    fn drop(&mut self) {
        // SAFETY: a live handle, which is not used afterwards.
        unsafe { sys::mien_clip_player_destroy(self.handle.as_ptr()) }
    }
}

impl std::fmt::Debug for ClipPlayer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ClipPlayer").field("info", &self.info()).finish()
    }
}

impl ClipPlayer {
    /// Where it stands.
    ///
    /// # Panics
    ///
    /// If the library is older than this crate.
    #[must_use]
    pub fn info(&self) -> ClipPlayerInfo {
        let mut out = sys::MienClipPlayerInfo::default();
        // SAFETY: a live handle and a sized struct.
        let status = unsafe { sys::mien_clip_player_info(self.handle.as_ptr(), &mut out) };
        assert_eq!(status, sys::MIEN_OK, "an older library");
        out.into()
    }

    /// Moves to a tick, without passing events.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_clip_player_seek)]
    pub fn seek(&mut self, tick: i64) -> Result<()> {
        // SAFETY: a live handle; the same below.
        check(unsafe { sys::mien_clip_player_seek(self.handle.as_ptr(), tick) })
    }

    /// Another speed from here on; negative is backward.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_clip_player_set_speed)]
    pub fn set_speed(&mut self, numerator: i32, denominator: i32) -> Result<()> {
        check(unsafe {
            sys::mien_clip_player_set_speed(self.handle.as_ptr(), numerator, denominator)
        })
    }

    /// Moves by ticks times the speed.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_clip_player_advance)]
    pub fn advance(&mut self, ticks: i64) -> Result<()> {
        check(unsafe { sys::mien_clip_player_advance(self.handle.as_ptr(), ticks) })
    }

    /// The next event that the last advance passed.
    pub fn next_event(&mut self) -> Option<ClipEvent> {
        let mut event = sys::MienClipEvent::default();
        let mut found = 0;
        // SAFETY: a live handle, and places for the results; the name lives as long as the clip.
        unsafe {
            let status =
                sys::mien_clip_player_next_event(self.handle.as_ptr(), &mut event, &mut found);
            (status == sys::MIEN_OK && found != 0).then(|| ClipEvent::of(&event))
        }
    }

    /// Values of all channels here: at a frame its bits.
    #[must_use]
    pub fn sample(&mut self) -> &[f32] {
        let mut view = sys::MienFloatView::default();
        // SAFETY: a live handle. The view is overwritten by calls that take `&mut self`.
        unsafe {
            if sys::mien_clip_player_sample(self.handle.as_ptr(), &mut view) != sys::MIEN_OK {
                return &[];
            }
            slice(view.data, view.count)
        }
    }
}
