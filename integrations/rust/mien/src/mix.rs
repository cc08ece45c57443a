// SPDX-License-Identifier: MIT

use crate::convert::{index, path_string, slice, terminated};
use crate::error::{check, checked};
use crate::{
    Allocator, BlendMode, Deformer, Error, Generator, Guard, LayerGroup, LayerSource, MixInfo,
    Mixer, Result, Retrigger, Rig, Status,
};
use mien_sys as sys;
use std::ffi::c_void;
use std::path::Path;
use std::ptr::{null, null_mut, NonNull};
use std::sync::Arc;

/// A layer of a mix: a source of rows, and how they change what the layers before it made.
///
/// Curves are raw controls, then pose variables. Times are in ticks of
/// 1 / [`TICKS_PER_SECOND`](crate::TICKS_PER_SECOND).
#[derive(Clone, Debug)]
pub struct MixLayer {
    source: LayerSource,
    group: LayerGroup,
    mode: BlendMode,
    weight: f32,
    after_guards: bool,
    mask: Option<Vec<f32>>,
    poses: Vec<(Vec<u16>, Vec<f32>)>,
    curves: Vec<u16>,
    amounts: Vec<f32>,
    generator: Generator,
    period: i64,
    delay: i64,
    stream_frames: u32,
}

/// What a call writes that is first asked for the size.
fn written(write: impl Fn(*mut c_void, usize, &mut usize) -> Result<()>) -> Result<Vec<u8>> {
    let mut size = 0;
    write(null_mut(), 0, &mut size)?;
    let mut bytes = vec![0u8; size];
    write(bytes.as_mut_ptr().cast(), size, &mut size)?;
    Ok(bytes)
}

fn split(pose: &[(usize, f32)]) -> (Vec<u16>, Vec<f32>) {
    // A curve that does not fit is past the end of everything.
    let curve = |curve: usize| u16::try_from(curve).unwrap_or(u16::MAX);
    pose.iter().map(|(number, value)| (curve(*number), *value)).unzip()
}

impl MixLayer {
    fn new(source: LayerSource, group: LayerGroup, mode: BlendMode) -> Self {
        Self {
            source,
            group,
            mode,
            weight: 1.0,
            after_guards: false,
            mask: None,
            poses: Vec::new(),
            curves: Vec::new(),
            amounts: Vec::new(),
            generator: Generator::BLINK,
            period: 0,
            delay: 0,
            stream_frames: 0,
        }
    }

    /// Plays clips ([`Mixer::play`]), which override.
    #[must_use]
    pub fn clip(group: LayerGroup) -> Self {
        Self::new(LayerSource::CLIP, group, BlendMode::OVERRIDE)
    }

    /// A weighted sum of poses ([`Mixer::set_pose_weight`]) in the group emotion, screened. A pose is
    /// a list of curves and values.
    #[must_use]
    pub fn poses(poses: &[&[(usize, f32)]]) -> Self {
        let mut layer = Self::new(LayerSource::POSES, LayerGroup::EMOTION, BlendMode::SCREEN);
        layer.poses = poses.iter().map(|pose| split(pose)).collect();
        layer
    }

    /// Rows that arrive from outside, one value for each of these curves: [`Mixer::push`].
    #[must_use]
    pub fn stream(group: LayerGroup, curves: &[usize]) -> Self {
        let mut layer = Self::new(LayerSource::STREAM, group, BlendMode::OVERRIDE);
        layer.curves = split(&curves.iter().map(|curve| (*curve, 0.0)).collect::<Vec<_>>()).0;
        layer
    }

    /// Blinks, breath or noise for curves with amounts, in the group life, added.
    #[must_use]
    pub fn generator(generator: Generator, curves: &[(usize, f32)], period: i64) -> Self {
        let mut layer = Self::new(LayerSource::GENERATOR, LayerGroup::LIFE, BlendMode::ADD);
        let (curves, amounts) = split(curves);
        layer.curves = curves;
        layer.amounts = amounts;
        layer.generator = generator;
        layer.period = period;
        layer
    }

    /// Turns the eyes to a place, by [`MixOptions::gaze`], in the group life. `target` are curves,
    /// usually pose variables: millimeters to the left, up and to the front. Two curves of `head` with
    /// factors get what is left for the head. `jitter`: degrees of fixation across and up.
    #[must_use]
    pub fn gaze(target: [usize; 3], head: Option<[(usize, f32); 2]>, jitter: [f32; 2]) -> Self {
        let [across, up] = jitter;
        let mut curves = vec![(target[0], across), (target[1], up), (target[2], 0.0)];
        curves.extend(head.iter().flatten());
        Self::generator(Generator::GAZE, &curves, crate::TICKS_PER_SECOND / 4)
            .mode(BlendMode::OVERRIDE)
    }

    /// What it is for.
    #[must_use]
    pub fn group(mut self, group: LayerGroup) -> Self {
        self.group = group;
        self
    }

    /// How it changes curves.
    #[must_use]
    pub fn mode(mut self, mode: BlendMode) -> Self {
        self.mode = mode;
        self
    }

    /// Initial weight, 0 to 1; with [`BlendMode::ADD`] from -1 on.
    #[must_use]
    pub fn weight(mut self, weight: f32) -> Self {
        self.weight = weight;
        self
    }

    /// Weight per curve, 0 to 1; those left out at the end are 0.
    #[must_use]
    pub fn mask(mut self, mask: &[f32]) -> Self {
        self.mask = Some(mask.to_vec());
        self
    }

    /// Acts after the guards; not for base and speech.
    #[must_use]
    pub fn after_guards(mut self) -> Self {
        self.after_guards = true;
        self
    }

    /// Ticks by which rows of a stream are played later than their times, which hides jitter.
    #[must_use]
    pub fn delay(mut self, delay: i64) -> Self {
        self.delay = delay;
        self
    }

    /// Most rows of a stream that can be queued; 0 means 64.
    #[must_use]
    pub fn stream_frames(mut self, frames: usize) -> Self {
        self.stream_frames = index(frames);
        self
    }

    fn raw(&self, first_pose: usize) -> sys::MienMixLayer {
        let mask = self.mask.as_deref();
        sys::MienMixLayer {
            period: self.period,
            delay: self.delay,
            mask: mask.map_or(null(), <[f32]>::as_ptr),
            curves: self.curves.as_ptr(),
            amounts: if self.amounts.is_empty() { null() } else { self.amounts.as_ptr() },
            mask_count: index(mask.map_or(0, <[f32]>::len)),
            curve_count: index(self.curves.len()),
            group: self.group.0,
            mode: self.mode.0,
            source: self.source.0,
            after_guards: self.after_guards.into(),
            weight: self.weight,
            first_pose: index(first_pose),
            pose_count: index(self.poses.len()),
            generator: self.generator.0,
            stream_frames: self.stream_frames,
            reserved: 0,
        }
    }
}

/// A part of a reaction: moves curves to a pose and back. Times are in ticks.
#[derive(Clone, Debug, Default)]
pub struct Stroke {
    /// Curves and values.
    pub pose: Vec<(usize, f32)>,
    /// How it changes curves.
    pub mode: BlendMode,
    /// After the trigger.
    pub delay: i64,
    /// To strength times pose.
    pub attack: i64,
    /// After the attack; ignored if `is_held`.
    pub hold: i64,
    /// Back to 0.
    pub release: i64,
    /// Holds as long as the stimulus lasts.
    pub is_held: bool,
    /// Moves exponentially; attack and release are time constants.
    pub is_lag: bool,
    /// Scaled by the level of the reaction, which is 1 if it was triggered.
    pub is_scaled: bool,
}

/// What a face does in response to a stimulus: [`Mixer::trigger`].
#[derive(Clone, Debug)]
pub struct Reaction {
    /// At most 8.
    pub strokes: Vec<Stroke>,
    /// What a trigger does while it runs.
    pub retrigger: Retrigger,
    /// Shortest time between two starts of strokes that are not held.
    pub cooldown: i64,
    /// Share of the strength that remains while the stimulus lasts.
    pub adapted: f32,
    /// Time constant of adaptation.
    pub adapt_ticks: i64,
    /// Time constant of recovery.
    pub recover_ticks: i64,
    /// A level of this or more is a stimulus: [`Mixer::set_level`]. 0: none is.
    pub level_on: f32,
    /// It ends below this, which is at most `level_on`.
    pub level_off: f32,
    /// Guards leave it alone.
    pub after_guards: bool,
}

impl Default for Reaction {
    fn default() -> Self {
        Self {
            strokes: Vec::new(),
            retrigger: Retrigger::EXTEND,
            cooldown: 0,
            adapted: 1.0,
            adapt_ticks: 0,
            recover_ticks: 0,
            level_on: 0.0,
            level_off: 0.0,
            after_guards: false,
        }
    }
}

impl Reaction {
    /// A response to a light in the eyes. Its poses: lids closed; squint and lowered brows; gaze turned
    /// away; narrow pupils; head turned away. An empty one leaves its part out.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mix_glare)]
    pub fn glare(poses: [Vec<(usize, f32)>; 5]) -> Result<Self> {
        let mut strokes = [sys::MienMixStroke::default(); 5];
        let mut reaction = sys::MienMixReaction::default();
        // SAFETY: room for as many strokes as are told.
        check(unsafe {
            sys::mien_mix_glare(0, strokes.as_mut_ptr(), strokes.len(), &mut reaction)
        })?;
        let stroke = |(stroke, pose): (&sys::MienMixStroke, Vec<(usize, f32)>)| Stroke {
            pose,
            mode: BlendMode(stroke.mode),
            delay: stroke.delay,
            attack: stroke.attack,
            hold: stroke.hold,
            release: stroke.release,
            is_held: stroke.is_held != 0,
            is_lag: stroke.is_lag != 0,
            is_scaled: stroke.is_scaled != 0,
        };
        Ok(Self {
            strokes: strokes.iter().zip(poses).map(stroke).collect(),
            retrigger: Retrigger(reaction.retrigger),
            cooldown: reaction.cooldown,
            adapted: reaction.adapted,
            adapt_ticks: reaction.adapt_ticks,
            recover_ticks: reaction.recover_ticks,
            level_on: reaction.level_on,
            level_off: reaction.level_off,
            after_guards: reaction.after_guards != 0,
        })
    }
}

/// A place of a face: the middle of some positions of a mesh that LOD 0 shows, or of some joints.
#[derive(Clone, Debug, Default)]
pub struct Landmark {
    /// Positions of the mesh, or joints.
    pub points: Vec<u32>,
    /// Whose positions they are; none: they are joints.
    pub mesh: Option<usize>,
}

impl Landmark {
    fn raw(&self) -> sys::MienLandmark {
        sys::MienLandmark {
            points: self.points.as_ptr(),
            point_count: index(self.points.len()),
            mesh: self.mesh.map_or(sys::MIEN_NO_MESH as u32, index),
        }
    }
}

/// A guard for landmarks of yours: the distance of `upper` above `lower` must not be opened.
#[derive(Clone, Debug)]
pub struct CustomGuard {
    /// One side.
    pub upper: Landmark,
    /// The other.
    pub lower: Landmark,
    /// Raw control that makes both touch at 1; none: they do at rest.
    pub closed_by: Option<usize>,
    /// Acts no more than the largest weight of a speech layer.
    pub needs_speech: bool,
    /// Millimeters by which later layers may open.
    pub tolerance: f32,
    /// Acts where base and speech open by less millimeters.
    pub f_on: f32,
}

/// A guard of a mix, as it was measured: millimeters = rest + sum of gain * curve + pairs of curves.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct GuardInfo<'a> {
    /// Raw controls that change it, by falling gain.
    pub curves: &'a [u16],
    /// Beside these: millimeters at value 1.
    pub gains: &'a [f32],
    /// Pairs of curves that share a corrective.
    pub pair_count: usize,
    /// Distance of a row of zeros.
    pub rest: f32,
    /// As in [`CustomGuard`].
    pub needs_speech: bool,
    /// As in [`CustomGuard`].
    pub tolerance: f32,
    /// As in [`CustomGuard`].
    pub f_on: f32,
    /// Millimeters, root mean square over rows that were tried.
    pub fit_error: f32,
}

/// Two curves that move the face in opposite directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Antagonists {
    /// One.
    pub first: usize,
    /// The other.
    pub second: usize,
    /// 0 to 1: with 1 one of them becomes 0.
    pub stiffness: f32,
}

/// What mixes are made of.
#[derive(Clone, Debug, Default)]
pub struct MixOptions {
    layers: Vec<MixLayer>,
    reactions: Vec<Reaction>,
    antagonists: Vec<Antagonists>,
    mirror: Option<Vec<u16>>,
    limits: Option<(Vec<f32>, Vec<f32>)>,
    guards: Option<(Guard, Deformer)>,
    custom_guards: Vec<CustomGuard>,
    gaze: Option<Arc<Gaze>>,
    variables: usize,
    players: usize,
    max_channels: usize,
    max_changing_channels: usize,
    max_events: usize,
    reverse: bool,
    allocator: Option<Allocator>,
}

impl MixOptions {
    /// No layers, no reactions.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// One more layer, over those before it; at most 16.
    #[must_use]
    pub fn layer(mut self, layer: MixLayer) -> Self {
        self.layers.push(layer);
        self
    }

    /// One more reaction; at most 16.
    #[must_use]
    pub fn reaction(mut self, reaction: Reaction) -> Self {
        self.reactions.push(reaction);
        self
    }

    /// Such as those of [`Mix::find_antagonists`].
    #[must_use]
    pub fn antagonists(mut self, antagonists: &[Antagonists]) -> Self {
        self.antagonists = antagonists.to_vec();
        self
    }

    /// Per curve its counterpart, such as that of [`Mix::find_mirror`]; without it, nothing can be
    /// played mirrored.
    #[must_use]
    pub fn mirror(mut self, mirror: &[u16]) -> Self {
        self.mirror = Some(mirror.to_vec());
        self
    }

    /// The lowest and the highest value of each curve.
    #[must_use]
    pub fn limits(mut self, lower: &[f32], upper: &[f32]) -> Self {
        self.limits = Some((lower.to_vec(), upper.to_vec()));
        self
    }

    /// Guards, measured on the deformer, which takes time.
    #[must_use]
    pub fn guards(mut self, guards: Guard, deformer: &Deformer) -> Self {
        self.guards = Some((guards, deformer.clone()));
        self
    }

    /// More guards, for landmarks of yours; [`guards`](Self::guards) names the deformer.
    #[must_use]
    pub fn custom_guard(mut self, guard: CustomGuard) -> Self {
        self.custom_guards.push(guard);
        self
    }

    /// For a layer of [`MixLayer::gaze`].
    #[must_use]
    pub fn gaze(mut self, gaze: &Arc<Gaze>) -> Self {
        self.gaze = Some(gaze.clone());
        self
    }

    /// Pose variables: curves behind the raw controls.
    #[must_use]
    pub fn variables(mut self, count: usize) -> Self {
        self.variables = count;
        self
    }

    /// Clips that play at a time; 0 means two for each layer of clips.
    #[must_use]
    pub fn players(mut self, count: usize) -> Self {
        self.players = count;
        self
    }

    /// Channels, and channels that change, of any clip; 0 means as many as the rig has raw controls.
    #[must_use]
    pub fn max_channels(mut self, channels: usize, changing: usize) -> Self {
        self.max_channels = channels;
        self.max_changing_channels = changing;
        self
    }

    /// Events that a step can report; 0 means 64.
    #[must_use]
    pub fn max_events(mut self, events: usize) -> Self {
        self.max_events = events;
        self
    }

    /// Memory for playing backward as fast as forward.
    #[must_use]
    pub fn reverse(mut self) -> Self {
        self.reverse = true;
        self
    }

    /// Memory of your own, for the mix and its mixers.
    #[must_use]
    pub fn allocator(mut self, allocator: &Allocator) -> Self {
        self.allocator = Some(allocator.clone());
        self
    }

    /// Makes the mix.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mix_create)]
    pub fn create(&self, rig: &Rig) -> Result<Mix> {
        let curves = rig.count(crate::Kind::RAW_CONTROL) + self.variables;
        let wrong = |what| Err(Error::new(Status::INVALID_ARGUMENT, what));
        if self.mirror.as_ref().map_or(false, |mirror| mirror.len() != curves) {
            return wrong("mirror: not one curve for each");
        }
        let off =
            |(lower, upper): &(Vec<f32>, Vec<f32>)| lower.len() != curves || upper.len() != curves;
        if self.limits.as_ref().map_or(false, off) {
            return wrong("limits: not one for each curve");
        }
        let strokes: Vec<_> = self.reactions.iter().flat_map(|r| &r.strokes).collect();
        let stroke_poses: Vec<_> = strokes.iter().map(|stroke| split(&stroke.pose)).collect();
        let layer_poses = self.layers.iter().flat_map(|layer| &layer.poses);
        let poses: Vec<_> = layer_poses
            .chain(&stroke_poses)
            .map(|(curves, values)| sys::MienMixPose {
                curves: curves.as_ptr(),
                values: values.as_ptr(),
                count: curves.len(),
            })
            .collect();
        let mut first_pose = 0;
        let mut layers = Vec::new();
        for layer in &self.layers {
            layers.push(layer.raw(first_pose));
            first_pose += layer.poses.len();
        }
        let strokes: Vec<_> = strokes
            .iter()
            .enumerate()
            .map(|(i, stroke)| sys::MienMixStroke {
                delay: stroke.delay,
                attack: stroke.attack,
                hold: stroke.hold,
                release: stroke.release,
                pose: index(first_pose + i),
                mode: stroke.mode.0,
                is_held: stroke.is_held.into(),
                is_lag: stroke.is_lag.into(),
                is_scaled: stroke.is_scaled.into(),
                reserved: 0,
            })
            .collect();
        let mut first_stroke = 0;
        let mut reactions = Vec::new();
        for reaction in &self.reactions {
            let own = &strokes[first_stroke..first_stroke + reaction.strokes.len()];
            first_stroke += own.len();
            reactions.push(sys::MienMixReaction {
                cooldown: reaction.cooldown,
                adapt_ticks: reaction.adapt_ticks,
                recover_ticks: reaction.recover_ticks,
                strokes: own.as_ptr(),
                stroke_count: own.len(),
                retrigger: reaction.retrigger.0,
                after_guards: reaction.after_guards.into(),
                adapted: reaction.adapted,
                level_on: reaction.level_on,
                level_off: reaction.level_off,
                reserved: 0,
            });
        }
        let curve = |curve: usize| u16::try_from(curve).unwrap_or(u16::MAX);
        let antagonists: Vec<_> = self
            .antagonists
            .iter()
            .map(|pair| sys::MienMixAntagonists {
                first: curve(pair.first),
                second: curve(pair.second),
                stiffness: pair.stiffness,
            })
            .collect();
        let custom_guards: Vec<_> = self
            .custom_guards
            .iter()
            .map(|guard| sys::MienMixGuard {
                upper: guard.upper.raw(),
                lower: guard.lower.raw(),
                closed_by: guard.closed_by.map_or(sys::MIEN_NO_CONTROL as u32, index),
                needs_speech: guard.needs_speech.into(),
                tolerance: guard.tolerance,
                f_on: guard.f_on,
            })
            .collect();
        let limit = |limit: fn(&(Vec<f32>, Vec<f32>)) -> *const f32| {
            self.limits.as_ref().map_or(null(), limit)
        };
        let mut handle = null_mut();
        Allocator::with(self.allocator.as_ref(), |allocator| {
            let desc = sys::MienMixDesc {
                layers: layers.as_ptr(),
                layer_count: layers.len(),
                poses: poses.as_ptr(),
                pose_count: poses.len(),
                reactions: reactions.as_ptr(),
                reaction_count: reactions.len(),
                antagonists: antagonists.as_ptr(),
                antagonist_count: antagonists.len(),
                mirror: self.mirror.as_ref().map_or(null(), |mirror| mirror.as_ptr()),
                lower: limit(|(lower, _)| lower.as_ptr()),
                upper: limit(|(_, upper)| upper.as_ptr()),
                custom_guards: custom_guards.as_ptr(),
                custom_guard_count: custom_guards.len(),
                gaze: self.gaze.as_ref().map_or(null(), |gaze| gaze.handle.as_ptr()),
                deformer: self.guards.as_ref().map_or(null(), |(_, deformer)| deformer.raw()),
                guards: self.guards.as_ref().map_or(0, |(guards, _)| guards.0),
                variable_count: index(self.variables),
                player_count: index(self.players),
                max_channels: index(self.max_channels),
                max_changing_channels: index(self.max_changing_channels),
                max_events: index(self.max_events),
                reverse: self.reverse.into(),
                allocator,
                ..Default::default()
            };
            // SAFETY: live handles, and a sized struct with as many elements as it says.
            checked(|error| unsafe { sys::mien_mix_create(rig.raw(), &desc, &mut handle, error) })
        })?;
        Mix::adopt(handle, self.allocator.clone())
    }
}

/// What is mixed for one rig, and how. It never changes.
///
/// Like a [`Rig`], a counted reference: clones are the same mix, and each [`Mixer`] holds one.
///
/// ```
/// use mien::{Dna, Kind, LayerGroup, MixLayer, MixOptions, Preset, Rig, TICKS_PER_SECOND};
/// let rig = Rig::new(&Dna::generate(Preset::HEAD)?)?;
/// let smile = rig.find(Kind::RAW_CONTROL, "mouthSmileLeft")?;
/// let mix = MixOptions::new()
///     .layer(MixLayer::clip(LayerGroup::SPEECH))
///     .layer(MixLayer::poses(&[&[(smile, 0.9)]]))
///     .create(&rig)?;
///
/// let mut mixer = mix.mixer(0)?; // one character
/// let mut face = rig.instance()?;
/// mixer.set_pose_weight(1, 0, 0.5, TICKS_PER_SECOND / 2)?;
/// mixer.step(TICKS_PER_SECOND, Some(&mut face))?; // then face.evaluate()
/// assert_eq!(face.raw_controls()[smile], 0.45);
/// # Ok::<(), mien::Error>(())
/// ```
#[derive(Clone)]
pub struct Mix {
    shared: Arc<Shared>,
}

struct Shared {
    handle: NonNull<sys::MienMix>,
    info: MixInfo,
    // Released after the handle.
    allocator: Option<Allocator>,
}

// SAFETY: the handle is const for every call but destroying; const handles may be used by any
// number of threads at the same time, and any thread may destroy it. Allocators are Send + Sync.
unsafe impl Send for Shared {}
unsafe impl Sync for Shared {}

impl Drop for Shared {
    fn drop(&mut self) {
        // SAFETY: destroyed once; mixers go on.
        unsafe { sys::mien_mix_destroy(self.handle.as_ptr()) }
    }
}

impl std::fmt::Debug for Mix {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Mix").field("info", &self.shared.info).finish_non_exhaustive()
    }
}

impl Mix {
    fn adopt(handle: *mut sys::MienMix, allocator: Option<Allocator>) -> Result<Self> {
        let handle = NonNull::new(handle).expect("a handle after success");
        let mut info = sys::MienMixInfo::default();
        // SAFETY: a live handle and a sized struct.
        let status = unsafe { sys::mien_mix_info(handle.as_ptr(), &mut info) };
        let shared = Shared { handle, info: info.into(), allocator };
        let mix = Mix { shared: Arc::new(shared) };
        check(status).map(|()| mix)
    }

    /// Opens a file for a rig that has the controls of the mix; without a rig, to look into it with
    /// [`Mix::to_text`].
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mix_open_file)]
    pub fn open(path: impl AsRef<Path>, rig: Option<&Rig>) -> Result<Self> {
        let path = path_string(path.as_ref())?;
        let rig = rig.map_or(null(), Rig::raw);
        let mut handle = null_mut();
        // SAFETY: a terminated path, and a live rig or none.
        checked(|error| unsafe {
            sys::mien_mix_open_file(path.as_ptr(), rig, null(), &mut handle, error)
        })?;
        Self::adopt(handle, None)
    }

    /// The same from memory, which is not needed afterwards.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mix_open_memory)]
    pub fn from_bytes(bytes: &[u8], rig: Option<&Rig>) -> Result<Self> {
        let rig = rig.map_or(null(), Rig::raw);
        let mut handle = null_mut();
        // SAFETY: as many bytes as are told, and a live rig or none.
        checked(|error| unsafe {
            sys::mien_mix_open_memory(
                bytes.as_ptr().cast(),
                bytes.len(),
                rig,
                null(),
                &mut handle,
                error,
            )
        })?;
        Self::adopt(handle, None)
    }

    /// Writes the file. A failure leaves `path` as it was.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mix_write_file)]
    pub fn save(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path_string(path.as_ref())?;
        // SAFETY: a live handle and a terminated path.
        checked(|error| unsafe { sys::mien_mix_write_file(self.raw(), path.as_ptr(), error) })
    }

    /// The bytes of the file.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mix_write_memory)]
    pub fn to_bytes(&self) -> Result<Vec<u8>> {
        written(|buffer, capacity, size| {
            // SAFETY: a live handle and room for `capacity` bytes.
            checked(|error| unsafe {
                sys::mien_mix_write_memory(self.raw(), buffer, capacity, size, error)
            })
        })
    }

    /// The same as text: a line for each number, for people and version control.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mix_write_text)]
    pub fn to_text(&self) -> Result<String> {
        let text = written(|buffer, capacity, size| {
            // SAFETY: a live handle and room for `capacity` bytes.
            checked(|error| unsafe {
                sys::mien_mix_write_text(self.raw(), buffer, capacity, size, error)
            })
        })?;
        Ok(String::from_utf8_lossy(&text).into_owned())
    }

    /// Counts and sizes.
    #[must_use]
    pub fn info(&self) -> &MixInfo {
        &self.shared.info
    }

    /// A new character; `seed` is of the generators.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mixer_create)]
    pub fn mixer(&self, seed: u64) -> Result<Mixer> {
        Mixer::new(self, seed, false)
    }

    /// The same, which keeps the row after each stage, for [`Mixer::stage`].
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mixer_create)]
    pub fn mixer_with_stages(&self, seed: u64) -> Result<Mixer> {
        Mixer::new(self, seed, true)
    }

    /// A guard, by its number.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mix_guard)]
    pub fn guard(&self, guard: usize) -> Result<GuardInfo<'_>> {
        let mut out = sys::MienMixGuardInfo::default();
        // SAFETY: a live handle and a sized struct.
        check(unsafe { sys::mien_mix_guard(self.raw(), index(guard), &mut out) })?;
        // SAFETY: views live as long as the mix.
        let (curves, gains) = unsafe {
            (slice(out.curves.data, out.curves.count), slice(out.gains.data, out.gains.count))
        };
        Ok(GuardInfo {
            curves,
            gains,
            pair_count: out.pair_count as usize,
            rest: out.rest,
            needs_speech: out.needs_speech != 0,
            tolerance: out.tolerance,
            f_on: out.f_on,
            fit_error: out.fit_error,
        })
    }

    pub(crate) fn raw(&self) -> *const sys::MienMix {
        self.shared.handle.as_ptr()
    }

    pub(crate) fn allocator(&self) -> Option<&Allocator> {
        self.shared.allocator.as_ref()
    }

    /// Pairs of raw controls that the two halves of one GUI control drive.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mix_antagonists)]
    pub fn find_antagonists(rig: &Rig) -> Result<Vec<Antagonists>> {
        let mut count = 0;
        // SAFETY: a live handle; no room is asked for.
        check(unsafe { sys::mien_mix_antagonists(rig.raw(), null_mut(), 0, &mut count) })?;
        let mut pairs = vec![sys::MienMixAntagonists::default(); count];
        // SAFETY: a live handle, and room for as many pairs as are told.
        check(unsafe {
            sys::mien_mix_antagonists(rig.raw(), pairs.as_mut_ptr(), pairs.len(), &mut count)
        })?;
        let pair = |pair: &sys::MienMixAntagonists| Antagonists {
            first: pair.first.into(),
            second: pair.second.into(),
            stiffness: pair.stiffness,
        };
        Ok(pairs.iter().map(pair).collect())
    }

    /// For each curve its counterpart in the other half of the face, or itself.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mix_mirror)]
    pub fn find_mirror(deformer: &Deformer, curve_count: usize) -> Result<Vec<u16>> {
        let mut curves = vec![0; curve_count];
        // SAFETY: a live handle, and room for as many curves as are told.
        checked(|error| unsafe {
            sys::mien_mix_mirror(deformer.raw(), curves.as_mut_ptr(), curves.len(), error)
        })?;
        Ok(curves)
    }

    /// For each raw control the share of its joint motion that is of some joint groups; `otherwise`
    /// for those that move no joint, and for pose variables.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_mix_mask)]
    pub fn find_mask(
        rig: &Rig,
        groups: &[usize],
        otherwise: f32,
        curve_count: usize,
    ) -> Result<Vec<f32>> {
        let groups: Vec<_> = groups.iter().map(|group| index(*group)).collect();
        let mut mask = vec![0.0; curve_count];
        // SAFETY: a live handle, and arrays with their lengths.
        checked(|error| unsafe {
            sys::mien_mix_mask(
                rig.raw(),
                groups.as_ptr(),
                groups.len(),
                otherwise,
                mask.as_mut_ptr(),
                mask.len(),
                error,
            )
        })?;
        Ok(mask)
    }
}

/// Which raw controls turn the eyes of a rig, and how far. It never changes.
pub struct Gaze {
    handle: NonNull<sys::MienGaze>,
}

// SAFETY: immutable, so any number of threads may use it at the same time.
unsafe impl Send for Gaze {}
unsafe impl Sync for Gaze {}

impl Drop for Gaze {
    fn drop(&mut self) {
        // SAFETY: destroyed once.
        unsafe { sys::mien_gaze_destroy(self.handle.as_ptr()) }
    }
}

impl std::fmt::Debug for Gaze {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Gaze").finish_non_exhaustive()
    }
}

impl Gaze {
    /// Measures how controls turn the eyes; `eyes` are the names of the joints of the left and the
    /// right one, else those that heads usually have.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_gaze_create)]
    pub fn new(deformer: &Deformer, eyes: Option<(&str, &str)>) -> Result<Self> {
        let names = match eyes {
            Some((left, right)) => Some((terminated(left)?, terminated(right)?)),
            None => None,
        };
        let desc = sys::MienGazeDesc {
            left_eye: names.as_ref().map_or(null(), |(left, _)| left.as_ptr()),
            right_eye: names.as_ref().map_or(null(), |(_, right)| right.as_ptr()),
            ..Default::default()
        };
        let mut handle = null_mut();
        // SAFETY: a live handle, and a sized struct with terminated names.
        checked(|error| unsafe {
            sys::mien_gaze_create(deformer.raw(), &desc, &mut handle, error)
        })?;
        Ok(Self { handle: NonNull::new(handle).expect("a handle after success") })
    }

    /// The middles of the left and the right eye, given like places of [`Gaze::look_at`].
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_gaze_info)]
    pub fn eyes(&self) -> Result<[[f32; 3]; 2]> {
        let mut info = sys::MienGazeInfo::default();
        // SAFETY: a live handle and a sized struct.
        check(unsafe { sys::mien_gaze_info(self.handle.as_ptr(), &mut info) })?;
        Ok([info.left_eye, info.right_eye].map(|eye| [eye.left, eye.up, eye.front]))
    }

    /// Sets the raw controls of a row so that both eyes look at a place: millimeters to the left, up
    /// and to the front, in the model space of the rig before its head moves. Returns what is beyond
    /// the reach of the eyes, for the head to turn: tangents of angles to the left and up.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_gaze_look_at)]
    pub fn look_at(&self, place: [f32; 3], row: &mut [f32]) -> Result<[f32; 2]> {
        let target = sys::MienGazeTarget { left: place[0], up: place[1], front: place[2] };
        let mut rest = sys::MienGazeRest::default();
        // SAFETY: a live handle, and a row with its length.
        check(unsafe {
            sys::mien_gaze_look_at(
                self.handle.as_ptr(),
                &target,
                row.as_mut_ptr(),
                row.len(),
                &mut rest,
            )
        })?;
        Ok([rest.left, rest.up])
    }
}
