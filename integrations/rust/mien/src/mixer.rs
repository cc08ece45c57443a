// SPDX-License-Identifier: MIT

use crate::convert::{bytes, index, slice, utf8};
use crate::error::{check, checked};
use crate::{
    Allocator, Clip, ClipBinding, ClipEvent, Error, Guard, Instance, Interpolation, Looping, Mix,
    MixerInfo, Result, Status, Transition, TICKS_PER_SECOND,
};
use mien_sys as sys;
use std::os::raw::c_void;
use std::ptr::{null_mut, NonNull};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::Arc;

/// How to play a clip in a layer. Times are in ticks.
#[derive(Clone, Debug)]
pub struct PlayOptions {
    /// A number of yours, by which [`Mixer::restore`] finds the clip.
    pub clip_id: u64,
    /// Where in the clip.
    pub start: i64,
    /// How the layer changes from what it plays.
    pub transition: Transition,
    /// How long that takes.
    pub duration: i64,
    /// What comes after the last frame.
    pub looping: Looping,
    /// Between frames.
    pub interpolation: Interpolation,
    /// A fraction; negative is backward.
    pub speed: (i32, i32),
    /// Swaps the halves of the face; needs [`MixOptions::mirror`](crate::MixOptions::mirror).
    pub mirrored: bool,
}

impl Default for PlayOptions {
    /// Forward from the start, after a transition of a quarter of a second.
    fn default() -> Self {
        Self {
            clip_id: 0,
            start: 0,
            transition: Transition::INERTIAL,
            duration: TICKS_PER_SECOND / 4,
            looping: Looping::DEFAULT,
            interpolation: Interpolation::LINEAR,
            speed: (1, 1),
            mirrored: false,
        }
    }
}

/// What a guard did in the last step. Distances are in millimeters.
#[derive(Clone, Debug, PartialEq)]
pub struct GuardState<'a> {
    /// What it keeps closed, such as "lips center".
    pub name: String,
    /// One of the constants of [`Guard`].
    pub kind: Guard,
    /// Raw controls that it may hold back.
    pub controls: &'a [u16],
    /// How much it acted, 0 to 1.
    pub activation: f32,
    /// After the last layer of base and speech.
    pub protected_distance: f32,
    /// After the later layers and reactions that come before the guards.
    pub wanted: f32,
    /// That it lets pass when fully active.
    pub limit: f32,
    /// That the guards left.
    pub distance: f32,
}

/// An event of a clip that a step passed.
#[derive(Clone, Debug, PartialEq)]
pub struct MixEvent {
    /// Where the clip plays.
    pub layer: usize,
    /// What it is.
    pub event: ClipEvent,
}

/// The handle, with the mix whose allocator made it.
struct Handle {
    raw: NonNull<sys::MienMixer>,
    has_sender: AtomicBool,
    // Dropped after the handle is destroyed.
    mix: Mix,
}

// SAFETY: any thread may use and destroy it. Mixer calls by `&mut self`; what a StreamSender calls may
// run beside that, and there is one sender at a time.
unsafe impl Send for Handle {}
unsafe impl Sync for Handle {}

impl Drop for Handle {
    fn drop(&mut self) {
        // SAFETY: destroyed once.
        unsafe { sys::mien_mixer_destroy(self.raw.as_ptr()) }
    }
}

impl Handle {
    fn push(&self, layer: usize, tick: i64, values: &[f32]) -> Result<bool> {
        let mut accepted = 0;
        // SAFETY: a live handle, and values with their count.
        check(unsafe {
            sys::mien_mixer_push(
                self.raw.as_ptr(),
                index(layer),
                tick,
                values.as_ptr(),
                values.len(),
                &mut accepted,
            )
        })?;
        Ok(accepted != 0)
    }
}

type Playing = (Arc<Clip>, Arc<ClipBinding>);

/// One character in a mix: the clips, fades and reactions that run. It holds its [`Mix`] and the clips
/// that it plays. Steps allocate nothing. Times are in ticks of 1 / [`TICKS_PER_SECOND`].
pub struct Mixer {
    handle: Arc<Handle>,
    // What the library may read in a step, by layer: it plays two clips at most, the last two.
    playing: Vec<Vec<Playing>>,
    restored: Vec<Playing>,
}

impl std::fmt::Debug for Mixer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Mixer").field("mix", &self.handle.mix).finish_non_exhaustive()
    }
}

/// Pushes rows for the streams of a mixer, on a thread of its own. There is one at a time.
#[derive(Debug)]
pub struct StreamSender {
    handle: Arc<Handle>,
}

impl std::fmt::Debug for Handle {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Handle").finish_non_exhaustive()
    }
}

impl Drop for StreamSender {
    fn drop(&mut self) {
        self.handle.has_sender.store(false, Ordering::Release);
    }
}

impl StreamSender {
    /// Queues a row for a stream layer, for a time of the mixer: one value per channel. False for one
    /// that is dropped: it is not newer than the last one, or the queue is full. Locks nothing.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mixer_push)]
    pub fn push(&mut self, layer: usize, tick: i64, values: &[f32]) -> Result<bool> {
        self.handle.push(layer, tick, values)
    }
}

impl Mixer {
    pub(crate) fn new(mix: &Mix, seed: u64, stages: bool) -> Result<Self> {
        let mut handle = null_mut();
        Allocator::with(mix.allocator(), |allocator| {
            let desc =
                sys::MienMixerDesc { seed, stages: stages.into(), allocator, ..Default::default() };
            // SAFETY: a live handle and a sized struct.
            checked(|error| unsafe { sys::mien_mixer_create(mix.raw(), &desc, &mut handle, error) })
        })?;
        let raw = NonNull::new(handle).expect("a handle after success");
        let layers = mix.info().layer_count;
        let handle = Handle { raw, has_sender: AtomicBool::new(false), mix: mix.clone() };
        Ok(Self {
            handle: Arc::new(handle),
            playing: (0..layers).map(|_| Vec::new()).collect(),
            restored: Vec::new(),
        })
    }

    /// The mix that it is in.
    #[must_use]
    pub fn mix(&self) -> &Mix {
        &self.handle.mix
    }

    fn raw(&mut self) -> *mut sys::MienMixer {
        self.handle.raw.as_ptr()
    }

    fn raw_const(&self) -> *const sys::MienMixer {
        self.handle.raw.as_ptr()
    }

    /// Plays a clip in a layer, from the next step on. The mixer keeps clip and binding as long as it
    /// reads them.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mixer_play)]
    pub fn play(
        &mut self,
        layer: usize,
        clip: &Arc<Clip>,
        binding: &Arc<ClipBinding>,
        options: &PlayOptions,
    ) -> Result<()> {
        let desc = sys::MienPlayDesc {
            clip_id: options.clip_id,
            start_tick: options.start,
            transition_ticks: options.duration,
            transition: options.transition.0,
            looping: options.looping.0,
            interpolation: options.interpolation.0,
            speed_numerator: options.speed.0,
            speed_denominator: options.speed.1,
            mirrored: options.mirrored.into(),
            ..Default::default()
        };
        let mixer = self.raw();
        // SAFETY: live handles and a sized struct. Clip and binding are kept below.
        checked(|error| unsafe {
            sys::mien_mixer_play(mixer, index(layer), clip.raw(), binding.raw(), &desc, error)
        })?;
        self.playing[layer].push((clip.clone(), binding.clone()));
        Ok(())
    }

    /// Fades out the clip of a layer and ends it.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mixer_stop)]
    pub fn stop(&mut self, layer: usize, fade: i64) -> Result<()> {
        // SAFETY: a live handle; the same below.
        check(unsafe { sys::mien_mixer_stop(self.raw(), index(layer), fade) })
    }

    /// Fades the weight of a layer.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mixer_set_weight)]
    pub fn set_weight(&mut self, layer: usize, weight: f32, fade: i64) -> Result<()> {
        check(unsafe { sys::mien_mixer_set_weight(self.raw(), index(layer), weight, fade) })
    }

    /// Fades the weight of a pose, which counts from the first one of its layer.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mixer_set_pose_weight)]
    pub fn set_pose_weight(
        &mut self,
        layer: usize,
        pose: usize,
        weight: f32,
        fade: i64,
    ) -> Result<()> {
        let (layer, pose) = (index(layer), index(pose));
        check(unsafe { sys::mien_mixer_set_pose_weight(self.raw(), layer, pose, weight, fade) })
    }

    /// The value that a pose variable has at the start of each step.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mixer_set_variable)]
    pub fn set_variable(&mut self, variable: usize, value: f32) -> Result<()> {
        check(unsafe { sys::mien_mixer_set_variable(self.raw(), index(variable), value) })
    }

    /// How much a guard acts, 0 to 1; negative: as it finds by itself.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mixer_set_guard)]
    pub fn set_guard(&mut self, guard: usize, activation: f32) -> Result<()> {
        check(unsafe { sys::mien_mixer_set_guard(self.raw(), index(guard), activation) })
    }

    /// Starts a reaction to a stimulus that lasts `hold`; if negative, until
    /// [`release`](Self::release).
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mixer_trigger)]
    pub fn trigger(&mut self, reaction: usize, strength: f32, hold: i64) -> Result<()> {
        check(unsafe { sys::mien_mixer_trigger(self.raw(), index(reaction), strength, hold) })
    }

    /// Ends the stimulus of a reaction.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mixer_release)]
    pub fn release(&mut self, reaction: usize) -> Result<()> {
        check(unsafe { sys::mien_mixer_release(self.raw(), index(reaction)) })
    }

    /// Sets the level, 0 to 1, of what a reaction responds to: from
    /// [`Reaction::level_on`](crate::Reaction::level_on) on a stimulus, which ends when it was below
    /// `level_off` for 50 ms.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mixer_set_level)]
    pub fn set_level(&mut self, reaction: usize, level: f32) -> Result<()> {
        check(unsafe { sys::mien_mixer_set_level(self.raw(), index(reaction), level) })
    }

    /// Queues a row for a stream layer, as [`StreamSender::push`] does on another thread.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mixer_push)]
    ///
    /// [`Status::INVALID_ARGUMENT`] while there is a [`StreamSender`].
    pub fn push(&mut self, layer: usize, tick: i64, values: &[f32]) -> Result<bool> {
        if self.handle.has_sender.load(Ordering::Acquire) {
            return Err(Error::new(Status::INVALID_ARGUMENT, "rows are pushed by a StreamSender"));
        }
        self.handle.push(layer, tick, values)
    }

    /// For pushing rows on another thread; none if there is one already.
    pub fn sender(&mut self) -> Option<StreamSender> {
        let taken = self.handle.has_sender.swap(true, Ordering::AcqRel);
        (!taken).then(|| StreamSender { handle: self.handle.clone() })
    }

    /// Advances and mixes. Raw controls go to the instance, if there is one.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mixer_step)]
    pub fn step(&mut self, ticks: i64, instance: Option<&mut Instance>) -> Result<()> {
        let instance = instance.map_or(null_mut(), Instance::raw);
        // SAFETY: live handles, both borrowed mutably.
        check(unsafe { sys::mien_mixer_step(self.raw(), ticks, instance) })?;
        self.forget_old();
        Ok(())
    }

    /// Steps several mixers, each into an instance: the results of single calls. On failure no mixer has moved.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mixer_step_batch)]
    pub fn step_batch<'a>(
        pairs: impl IntoIterator<Item = (&'a mut Mixer, &'a mut Instance)>,
        ticks: i64,
    ) -> Result<()> {
        let (mut mixers, mut instances): (Vec<_>, Vec<_>) = pairs.into_iter().unzip();
        let handles: Vec<_> = mixers.iter_mut().map(|mixer| mixer.raw()).collect();
        let faces: Vec<_> = instances.iter_mut().map(|face| face.raw()).collect();
        // SAFETY: live handles, different ones as they are borrowed mutably, and as many as told.
        check(unsafe {
            sys::mien_mixer_step_batch(handles.as_ptr(), faces.as_ptr(), handles.len(), ticks)
        })?;
        mixers.into_iter().for_each(Mixer::forget_old);
        Ok(())
    }

    /// Clips that no player reads any more; events of the last step are of those that stay.
    fn forget_old(&mut self) {
        for layer in &mut self.playing {
            let old = layer.len().saturating_sub(2);
            layer.drain(..old);
        }
    }

    /// What the last step gave: raw controls, then pose variables.
    #[must_use]
    pub fn row(&self) -> &[f32] {
        let mut view = sys::MienFloatView::default();
        // SAFETY: a live handle. What changes the row takes `&mut self`; the same below.
        unsafe {
            if sys::mien_mixer_row(self.raw_const(), &mut view) != sys::MIEN_OK {
                return &[];
            }
            slice(view.data, view.count)
        }
    }

    /// The row after a stage of the last step: the layers, reactions, guards, antagonists, limits.
    /// Needs [`Mix::mixer_with_stages`].
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mixer_stage)]
    pub fn stage(&self, stage: usize) -> Result<&[f32]> {
        let mut view = sys::MienFloatView::default();
        unsafe {
            check(sys::mien_mixer_stage(self.raw_const(), index(stage), &mut view))?;
            Ok(slice(view.data, view.count))
        }
    }

    /// What a guard did in the last step. Guards are numbered as in [`Mixer::set_guard`].
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mixer_guard)]
    pub fn guard(&self, guard: usize) -> Result<GuardState<'_>> {
        let mut out = sys::MienGuardState::default();
        // SAFETY: a live handle and a sized struct; the views are of the mix, which the mixer keeps.
        unsafe {
            check(sys::mien_mixer_guard(self.raw_const(), index(guard), &mut out))?;
            Ok(GuardState {
                name: utf8(bytes(out.name)).into_owned(),
                kind: Guard(out.kind),
                controls: slice(out.controls.data, out.controls.count),
                activation: out.activation,
                protected_distance: out.protected_distance,
                wanted: out.wanted,
                limit: out.limit,
                distance: out.distance,
            })
        }
    }

    /// Where it stands.
    ///
    /// # Panics
    ///
    /// If the library is older than this crate.
    #[must_use]
    pub fn info(&self) -> MixerInfo {
        let mut out = sys::MienMixerInfo::default();
        // SAFETY: a live handle and a sized struct.
        let status = unsafe { sys::mien_mixer_info(self.raw_const(), &mut out) };
        assert_eq!(status, sys::MIEN_OK, "an older library");
        out.into()
    }

    /// An event of clips that the last step passed, by its number; there are
    /// [`MixerInfo::event_count`].
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mixer_event)]
    pub fn event(&self, event: usize) -> Result<MixEvent> {
        let mut out = sys::MienClipEvent::default();
        let mut layer = 0;
        // SAFETY: a live handle and places for the results. The name is of a clip that played in the
        // last step, which is kept until the next one.
        unsafe {
            check(sys::mien_mixer_event(self.raw_const(), index(event), &mut out, &mut layer))?;
            Ok(MixEvent { layer: layer as usize, event: ClipEvent::of(&out) })
        }
    }

    /// All that later steps depend on, except queued rows of streams.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mixer_snapshot)]
    pub fn snapshot(&mut self) -> Result<Vec<u8>> {
        let mut bytes = vec![0u8; self.handle.mix.info().snapshot_bytes as usize];
        let (mixer, buffer) = (self.raw(), bytes.as_mut_ptr().cast::<c_void>());
        let mut size = 0;
        // SAFETY: a live handle, and room for as many bytes as are told.
        checked(|error| unsafe {
            sys::mien_mixer_snapshot(mixer, buffer, bytes.len(), &mut size, error)
        })?;
        bytes.truncate(size);
        Ok(bytes)
    }

    /// Goes on from a snapshot of a mixer of the same mix, to the bit. The bytes may come from
    /// anywhere. `clips` are those that may be playing, by [`PlayOptions::clip_id`].
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mixer_restore)]
    pub fn restore(
        &mut self,
        bytes: &[u8],
        clips: &[(u64, &Arc<Clip>, &Arc<ClipBinding>)],
    ) -> Result<()> {
        let given: Vec<_> = clips
            .iter()
            .map(|(clip_id, clip, binding)| sys::MienMixerClip {
                clip_id: *clip_id,
                clip: clip.raw(),
                clip_binding: binding.raw(),
            })
            .collect();
        let mixer = self.raw();
        // SAFETY: live handles, and arrays with their lengths. Clips and bindings are kept below.
        checked(|error| unsafe {
            sys::mien_mixer_restore(
                mixer,
                bytes.as_ptr().cast(),
                bytes.len(),
                given.as_ptr(),
                given.len(),
                error,
            )
        })?;
        self.playing.iter_mut().for_each(Vec::clear);
        self.restored =
            clips.iter().map(|(_, clip, binding)| ((*clip).clone(), (*binding).clone())).collect();
        Ok(())
    }
}
