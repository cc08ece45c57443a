// SPDX-License-Identifier: MIT

use crate::convert::{bytes, empty_string, index, path_string, slice, utf8};
use crate::error::{check, checked};
use crate::stream::with_stream;
use crate::{
    Allocator, ClipInfo, ClipPlayer, Deformer, Error, Interpolation, Looping, Result, Rig, Status,
};
use mien_sys as sys;
use std::borrow::Cow;
use std::io::{Read, Seek};
use std::os::raw::c_void;
use std::path::Path;
use std::ptr::{null_mut, NonNull};

/// The unit of all times of clips.
pub const TICKS_PER_SECOND: i64 = sys::MIEN_TICKS_PER_SECOND as i64;

/// Control curves at a constant rate, compressed.
///
/// ```
/// use mien::{Clip, ClipOptions, Dna, Kind, Preset, Rig, TICKS_PER_SECOND};
/// let rig = Rig::new(&Dna::generate(Preset::HEAD)?)?;
/// let rows = [0.0, 0.2, 0.5, 0.2, 1.0, 0.0]; // two values per frame
/// let clip = ClipOptions::new(&["jawOpen", "mouthPucker"]).build(&rows)?;
///
/// let binding = clip.bind(&rig, &[])?;
/// let mut player = clip.player()?;
/// let mut face = rig.instance()?;
/// player.advance(TICKS_PER_SECOND / 60)?;
/// binding.apply(player.sample(), face.raw_controls_mut())?;
/// assert_eq!(face.raw_controls()[rig.find(Kind::RAW_CONTROL, "jawOpen")?], 0.5);
/// # Ok::<(), mien::Error>(())
/// ```
pub struct Clip {
    handle: NonNull<sys::MienClip>,
    info: ClipInfo,
    allocator: Option<Allocator>,
}

// SAFETY: the handle is const for every call but closing; const handles may be used by any number
// of threads at the same time, and any thread may close it. Allocators are Send + Sync.
unsafe impl Send for Clip {}
unsafe impl Sync for Clip {}

impl Drop for Clip {
    fn drop(&mut self) {
        // SAFETY: a live handle, which is not used afterwards.
        unsafe { sys::mien_clip_close(self.handle.as_ptr()) }
    }
}

impl std::fmt::Debug for Clip {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Clip").field("info", &self.info).finish_non_exhaustive()
    }
}

/// A named moment of a clip: a phoneme, a footstep.
#[derive(Clone, Debug, PartialEq)]
pub struct ClipEvent {
    /// When it is.
    pub tick: i64,
    /// What it is called.
    pub name: String,
    /// A number that goes with it.
    pub value: f32,
}

impl ClipEvent {
    /// # Safety
    ///
    /// The name is readable.
    pub(crate) unsafe fn of(event: &sys::MienClipEvent) -> Self {
        // SAFETY: promised by the caller.
        let name = utf8(unsafe { bytes(event.name) }).into_owned();
        Self { tick: event.tick, name, value: event.value }
    }
}

/// A channel of a clip, and how its curve was stored. Numbers that are not in a file are 0 in a clip
/// that was opened: blocks, bits and error.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ClipChannel<'a> {
    /// Its name.
    pub name: Cow<'a, str>,
    /// Value of a channel that does not change; else 0.
    pub rest: f32,
    /// It has a curve.
    pub is_changing: bool,
    /// Blocks of 64 frames of zeros only, of one value, of fractions of a grid, of other floats.
    pub blocks: [u32; 4],
    /// Bits of all its blocks.
    pub bits: u64,
    /// Of rounding to [`ClipOptions::snap`].
    pub max_error: f32,
}

/// What clips are built of, beside rows of values.
#[derive(Clone, Debug)]
pub struct ClipOptions<'a> {
    names: &'a [&'a str],
    rate: (u32, u32),
    snaps: &'a [f32],
    snap: f32,
    looping: Looping,
    is_delta: bool,
    events: &'a [ClipEvent],
    allocator: Option<Allocator>,
}

impl<'a> ClipOptions<'a> {
    /// A clip with these channels, at 60 frames a second, every bit kept.
    #[must_use]
    pub fn new(names: &'a [&'a str]) -> Self {
        Self {
            names,
            rate: (60, 1),
            snaps: &[],
            snap: 0.0,
            looping: Looping::DEFAULT,
            is_delta: false,
            events: &[],
            allocator: None,
        }
    }

    /// Frames per second, as a fraction.
    #[must_use]
    pub fn rate(mut self, numerator: u32, denominator: u32) -> Self {
        self.rate = (numerator, denominator);
        self
    }

    /// Rounds values to this step: 2^-9, 2^-10 ... 2^-16; 0 keeps every bit.
    #[must_use]
    pub fn snap(mut self, step: f32) -> Self {
        self.snap = step;
        self
    }

    /// The same with a step for each channel.
    #[must_use]
    pub fn snaps(mut self, steps: &'a [f32]) -> Self {
        self.snaps = steps;
        self
    }

    /// What comes after the last frame.
    #[must_use]
    pub fn looping(mut self, looping: Looping) -> Self {
        self.looping = looping;
        self
    }

    /// Values are differences, to be added to something.
    #[must_use]
    pub fn is_delta(mut self, is_delta: bool) -> Self {
        self.is_delta = is_delta;
        self
    }

    /// Named moments, in any order.
    #[must_use]
    pub fn events(mut self, events: &'a [ClipEvent]) -> Self {
        self.events = events;
        self
    }

    /// Memory of your own, for the clip, its players and bindings.
    #[must_use]
    pub fn allocator(mut self, allocator: &Allocator) -> Self {
        self.allocator = Some(allocator.clone());
        self
    }

    /// Builds a clip of rows of values, one after the other: one value per channel, one row per
    /// frame.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_clip_build)]
    ///
    /// [`Status::INVALID_ARGUMENT`] for values that are no
    /// whole rows.
    pub fn build(&self, values: &[f32]) -> Result<Clip> {
        let channels = self.names.len();
        let wrong = |what| Err(Error::new(Status::INVALID_ARGUMENT, what));
        if channels == 0 || values.len() % channels != 0 {
            return wrong("values are rows of one value per name");
        }
        if !self.snaps.is_empty() && self.snaps.len() != channels {
            return wrong("snaps: not one for each channel");
        }
        if self.rate.0 == 0 || self.rate.1 == 0 {
            return wrong("a rate is not 0");
        }
        let names: Vec<_> = self.names.iter().map(|name| view(name)).collect();
        let events: Vec<_> = self
            .events
            .iter()
            .map(|event| sys::MienClipEvent {
                tick: event.tick,
                name: view(&event.name),
                value: event.value,
                reserved: 0,
            })
            .collect();
        let mut handle = null_mut();
        Allocator::with(self.allocator.as_ref(), |allocator| {
            let desc = sys::MienClipDesc {
                rate_numerator: self.rate.0,
                rate_denominator: self.rate.1,
                frame_count: index(values.len() / channels),
                channel_count: index(channels),
                names: names.as_ptr(),
                values: values.as_ptr(),
                snaps: if self.snaps.is_empty() { std::ptr::null() } else { self.snaps.as_ptr() },
                snap: self.snap,
                looping: self.looping.0,
                is_delta: self.is_delta.into(),
                event_count: index(events.len()),
                events: events.as_ptr(),
                allocator,
                ..Default::default()
            };
            // SAFETY: a sized struct with as many names, values and events as it says.
            checked(|error| unsafe { sys::mien_clip_build(&desc, &mut handle, error) })
        })?;
        Clip::adopt(handle, self.allocator.clone())
    }
}

/// For [`Clip::bind`]: entries (expression, raw control, weight) that bind clips with the names of
/// ARKit to rigs that name their controls in the other usual way, `eyeBlinkL` for `eyeBlinkLeft`.
#[must_use]
pub fn arkit_matrix() -> Vec<(&'static str, &'static str, f32)> {
    let mut count = 0;
    // SAFETY: no room is told, and none is used.
    let mut status = unsafe { sys::mien_arkit_matrix(null_mut(), 0, &mut count) };
    let mut entries = vec![sys::MienMatrixEntry::default(); count];
    if status == 0 {
        // SAFETY: room for as many entries as are told.
        status = unsafe { sys::mien_arkit_matrix(entries.as_mut_ptr(), count, &mut count) };
    }
    assert_eq!(status, 0, "mien_arkit_matrix() fails with wrong arguments only");
    // SAFETY: names are static.
    let text = |name| std::str::from_utf8(unsafe { bytes(name) }).unwrap_or_default();
    entries.iter().map(|e| (text(e.channel), text(e.control), e.weight)).collect()
}

/// Text as C takes it; valid as long as `text`.
pub(crate) fn view(text: &str) -> sys::MienStringView {
    sys::MienStringView { data: text.as_ptr().cast(), count: text.len() }
}

impl Clip {
    /// Reads a file.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_clip_open_file)]
    pub fn open(path: impl AsRef<Path>) -> Result<Self> {
        Self::open_file(path.as_ref(), sys::MIEN_FILE_READ)
    }

    /// Maps a file: its pages are read when they are needed.
    ///
    /// # Safety
    ///
    /// The file must not be truncated or rewritten in place while the clip or a player of it is
    /// there. Replacing it by renaming is safe.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_clip_open_file)]
    pub unsafe fn map(path: impl AsRef<Path>) -> Result<Self> {
        Self::open_file(path.as_ref(), sys::MIEN_FILE_MAP)
    }

    fn open_file(path: &Path, access: u32) -> Result<Self> {
        let path = path_string(path)?;
        let desc = sys::MienClipOpenDesc { file_access: access, ..Default::default() };
        let mut handle = null_mut();
        // SAFETY: a terminated path and a sized struct.
        checked(|error| unsafe {
            sys::mien_clip_open_file(path.as_ptr(), &desc, &mut handle, error)
        })?;
        Self::adopt(handle, None)
    }

    /// A clip in memory, such as one of `include_bytes!`, which is used where it lies.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_clip_open_memory)]
    pub fn from_static(bytes: &'static [u8]) -> Result<Self> {
        let mut handle = null_mut();
        let desc = sys::MienClipOpenDesc::default();
        // SAFETY: the bytes are static, so they outlive everything unchanged.
        checked(|error| unsafe {
            sys::mien_clip_open_memory(
                bytes.as_ptr().cast(),
                bytes.len(),
                &desc,
                &mut handle,
                error,
            )
        })?;
        Self::adopt(handle, None)
    }

    /// Reads all of `reader`.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_clip_open_stream)]
    ///
    /// An error of the reader is [`Status::FILE_READ`].
    pub fn from_reader(reader: &mut (impl Read + Seek)) -> Result<Self> {
        let mut handle = null_mut();
        let desc = sys::MienClipOpenDesc::default();
        with_stream(reader, |stream| {
            // SAFETY: a stream that is valid for the call, and a sized struct.
            checked(|error| unsafe {
                sys::mien_clip_open_stream(stream, &desc, &mut handle, error)
            })
        })?;
        Self::adopt(handle, None)
    }

    fn adopt(handle: *mut sys::MienClip, allocator: Option<Allocator>) -> Result<Self> {
        let handle = NonNull::new(handle).expect("a handle after success");
        let mut info = sys::MienClipInfo::default();
        // SAFETY: a live handle and a sized struct.
        let status = unsafe { sys::mien_clip_info(handle.as_ptr(), &mut info) };
        let clip = Self { handle, info: info.into(), allocator };
        check(status).map(|()| clip)
    }

    /// Rate, counts, sizes.
    #[must_use]
    pub fn info(&self) -> &ClipInfo {
        &self.info
    }

    /// A channel, by its number.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_clip_channel)]
    pub fn channel(&self, channel: usize) -> Result<ClipChannel<'_>> {
        let mut out = sys::MienClipChannel::default();
        // SAFETY: a live handle and a sized struct.
        check(unsafe { sys::mien_clip_channel(self.raw(), index(channel), &mut out) })?;
        Ok(ClipChannel {
            // SAFETY: views live as long as the clip.
            name: utf8(unsafe { bytes(out.name) }),
            rest: out.rest,
            is_changing: out.is_changing != 0,
            blocks: [out.zero_blocks, out.constant_blocks, out.grid_blocks, out.float_blocks],
            bits: out.bits,
            max_error: out.max_error,
        })
    }

    /// Number of the channel of a name.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_clip_find_channel_n)]
    pub fn find(&self, name: &str) -> Result<usize> {
        let mut out = 0;
        // SAFETY: a live handle, and text with its length.
        check(unsafe {
            sys::mien_clip_find_channel_n(self.raw(), name.as_ptr().cast(), name.len(), &mut out)
        })?;
        Ok(out as usize)
    }

    /// An event, by its number in order of ticks.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_clip_event)]
    pub fn event(&self, event: usize) -> Result<ClipEvent> {
        let mut out = sys::MienClipEvent { name: empty_string(), ..Default::default() };
        // SAFETY: a live handle, and a place for an event, whose name lives as long as the clip.
        unsafe {
            check(sys::mien_clip_event(self.raw(), index(event), &mut out))?;
            Ok(ClipEvent::of(&out))
        }
    }

    /// Whether the bytes are those that were written.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_clip_verify)]
    pub fn verify(&self) -> Result<()> {
        // SAFETY: a live handle.
        checked(|error| unsafe { sys::mien_clip_verify(self.raw(), error) })
    }

    /// Frames, one row of all channels after the other.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_clip_read)]
    pub fn read(&self, first_frame: usize, frame_count: usize) -> Result<Vec<f32>> {
        let frames = self.info.frame_count;
        if first_frame > frames || frame_count > frames - first_frame {
            return Err(Error::new(Status::INDEX, "the clip has fewer frames"));
        }
        let mut values = vec![0.0; frame_count * self.info.channel_count];
        // SAFETY: a live handle, and room for the frames.
        checked(|error| unsafe {
            sys::mien_clip_read(
                self.raw(),
                index(first_frame),
                index(frame_count),
                values.as_mut_ptr(),
                0,
                error,
            )
        })?;
        Ok(values)
    }

    /// Writes the file. A failure leaves `path` as it was.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_clip_write_file)]
    pub fn save(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path_string(path.as_ref())?;
        // SAFETY: a live handle and a terminated path.
        checked(|error| unsafe { sys::mien_clip_write_file(self.raw(), path.as_ptr(), error) })
    }

    /// The bytes of the file.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_clip_write_memory)]
    pub fn to_bytes(&self) -> Result<Vec<u8>> {
        let mut bytes = vec![0u8; self.info.file_bytes as usize];
        let mut size = 0;
        let buffer = bytes.as_mut_ptr().cast::<c_void>();
        // SAFETY: a live handle, and room for as many bytes as are told.
        checked(|error| unsafe {
            sys::mien_clip_write_memory(self.raw(), buffer, bytes.len(), &mut size, error)
        })?;
        Ok(bytes)
    }

    /// A player that goes forward and interpolates linearly; see [`Clip::player_with`].
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_clip_player_create)]
    pub fn player(&self) -> Result<ClipPlayer> {
        self.player_with(Looping::DEFAULT, Interpolation::LINEAR, false)
    }

    /// A player. `reverse`: with memory for playing backward as fast as forward.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_clip_player_create)]
    pub fn player_with(
        &self,
        looping: Looping,
        interpolation: Interpolation,
        reverse: bool,
    ) -> Result<ClipPlayer> {
        let mut handle = null_mut();
        Allocator::with(self.allocator.as_ref(), |allocator| {
            let desc = sys::MienClipPlayerDesc {
                looping: looping.0,
                interpolation: interpolation.0,
                reverse: reverse.into(),
                allocator,
                ..Default::default()
            };
            // SAFETY: a live handle and a sized struct.
            checked(|error| unsafe {
                sys::mien_clip_player_create(self.raw(), &desc, &mut handle, error)
            })
        })?;
        let handle = NonNull::new(handle).expect("a handle after success");
        Ok(ClipPlayer { handle, _allocator: self.allocator.clone() })
    }

    /// Which channel drives which raw control of a rig, by name; `matrix` has entries (channel,
    /// control, weight) for channels with other names.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_clip_binding_create)]
    pub fn bind(&self, rig: &Rig, matrix: &[(&str, &str, f32)]) -> Result<ClipBinding> {
        let entries: Vec<_> = matrix
            .iter()
            .map(|(channel, control, weight)| sys::MienMatrixEntry {
                channel: view(channel),
                control: view(control),
                weight: *weight,
                reserved: 0,
            })
            .collect();
        let mut handle = null_mut();
        Allocator::with(self.allocator.as_ref(), |allocator| {
            let desc = sys::MienClipBindingDesc {
                matrix: entries.as_ptr(),
                matrix_count: entries.len(),
                allocator,
                ..Default::default()
            };
            // SAFETY: live handles, and a sized struct with as many entries as it says.
            checked(|error| unsafe {
                sys::mien_clip_binding_create(self.raw(), rig.raw(), &desc, &mut handle, error)
            })
        })?;
        let handle = NonNull::new(handle).expect("a handle after success");
        let mut info = sys::MienClipBindingInfo::default();
        // SAFETY: a live handle and a sized struct.
        let status = unsafe { sys::mien_clip_binding_info(handle.as_ptr(), &mut info) };
        let binding = ClipBinding { handle, info, _allocator: self.allocator.clone() };
        check(status).map(|()| binding)
    }

    pub(crate) fn raw(&self) -> *const sys::MienClip {
        self.handle.as_ptr()
    }
}

/// Which channel of a clip drives which raw control of a rig. Needs neither afterwards.
pub struct ClipBinding {
    handle: NonNull<sys::MienClipBinding>,
    info: sys::MienClipBindingInfo,
    // Dropped after the handle is destroyed.
    _allocator: Option<Allocator>,
}

// SAFETY: immutable, so any number of threads may use it at the same time.
unsafe impl Send for ClipBinding {}
unsafe impl Sync for ClipBinding {}

impl Drop for ClipBinding {
    fn drop(&mut self) {
        // SAFETY: a live handle, which is not used afterwards.
        unsafe { sys::mien_clip_binding_destroy(self.handle.as_ptr()) }
    }
}

impl std::fmt::Debug for ClipBinding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ClipBinding").field("controls", &self.controls()).finish_non_exhaustive()
    }
}

impl ClipBinding {
    pub(crate) fn raw(&self) -> *const sys::MienClipBinding {
        self.handle.as_ptr()
    }

    /// Raw controls that are driven, ascending.
    #[must_use]
    pub fn controls(&self) -> &[u16] {
        // SAFETY: views live as long as the binding; the same below.
        unsafe { slice(self.info.controls.data, self.info.controls.count) }
    }

    /// Raw controls that nothing drives, ascending.
    #[must_use]
    pub fn extra_controls(&self) -> &[u16] {
        unsafe { slice(self.info.extra_controls.data, self.info.extra_controls.count) }
    }

    /// Channels that drive nothing, ascending.
    #[must_use]
    pub fn missing_channels(&self) -> &[u16] {
        unsafe { slice(self.info.missing_channels.data, self.info.missing_channels.count) }
    }

    /// Entries of the matrix with a channel or a control that is not there.
    #[must_use]
    pub fn missing_entry_count(&self) -> usize {
        self.info.missing_entry_count as usize
    }

    /// Per channel the coarsest step, for [`ClipOptions::snaps`], of which half moves no vertex by more
    /// than `tolerance` millimeters.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_clip_binding_snaps)]
    pub fn find_snaps(&self, deformer: &Deformer, tolerance: f32) -> Result<Vec<f32>> {
        let mut steps = vec![0.0; self.info.channel_count as usize];
        // SAFETY: live handles, and an array with its length.
        checked(|error| unsafe {
            sys::mien_clip_binding_snaps(
                self.handle.as_ptr(),
                deformer.raw(),
                tolerance,
                steps.as_mut_ptr(),
                steps.len(),
                error,
            )
        })?;
        Ok(steps)
    }

    /// Writes the raw controls that are driven, and no others. `values` are one per channel, as from
    /// [`ClipPlayer::sample`].
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_clip_binding_apply)]
    pub fn apply(&self, values: &[f32], raw_controls: &mut [f32]) -> Result<()> {
        // SAFETY: a live handle, and arrays with their lengths.
        check(unsafe {
            sys::mien_clip_binding_apply(
                self.handle.as_ptr(),
                values.as_ptr(),
                values.len(),
                raw_controls.as_mut_ptr(),
                raw_controls.len(),
            )
        })
    }
}
