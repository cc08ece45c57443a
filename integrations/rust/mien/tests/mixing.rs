// SPDX-License-Identifier: MIT
//! Mixes, mixers, gazes and solvers: rows reach instances, what they refer to stays alive, wrong
//! calls are errors.

use mien::{
    AimSolver, BlendMode, Clip, ClipBinding, ClipEvent, ClipOptions, CopySolver, CustomGuard,
    CustomSolver, Deformer, Dna, Gaze, Generator, Guard, Kind, Landmark, LayerGroup, Mix, MixLayer,
    MixOptions, Mixer, PlayOptions, Preset, Reaction, Rig, Solver, SolverInput, SolverStackOptions,
    SolverState, SpaceSolver, SpringSolver, Status, Stroke, Transition, TwistSolver, NO_JOINT,
    TICKS_PER_SECOND,
};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

const FRAME: i64 = TICKS_PER_SECOND / 60;

struct Head {
    rig: Rig,
    deformer: Deformer,
}

impl Head {
    /// Made once for all tests.
    fn get() -> Arc<Self> {
        static MADE: Mutex<Option<Arc<Head>>> = Mutex::new(None);
        let mut made = MADE.lock().unwrap();
        let make = || {
            let dna = Dna::generate(Preset::HEAD).unwrap();
            let rig = Rig::new(&dna).unwrap();
            Arc::new(Self { deformer: Deformer::new(&dna, &rig).unwrap(), rig })
        };
        made.get_or_insert_with(make).clone()
    }
    fn curve(&self, name: &str) -> usize {
        self.rig.find(Kind::RAW_CONTROL, name).unwrap()
    }
    fn variable(&self) -> usize {
        self.rig.count(Kind::RAW_CONTROL)
    }
    fn speech(&self) -> (Arc<Clip>, Arc<ClipBinding>) {
        let rows: Vec<f32> = (0..61).flat_map(|i| [i as f32 / 128.0, 0.5]).collect();
        let events = [ClipEvent { tick: 10 * FRAME, name: "word".into(), value: 0.5 }];
        let names = ["jawOpen", "mouthPucker"];
        let clip = ClipOptions::new(&names).events(&events).build(&rows).unwrap();
        let binding = clip.bind(&self.rig, &[]).unwrap();
        (Arc::new(clip), Arc::new(binding))
    }
    fn options(&self) -> MixOptions {
        let squint = Stroke {
            pose: vec![(self.curve("eyeSquintLeft"), 1.0)],
            mode: BlendMode::SCREEN,
            attack: FRAME,
            release: FRAME,
            is_held: true,
            is_scaled: true,
            ..Default::default()
        };
        let lids = [(self.curve("eyeBlinkLeft"), 1.0), (self.curve("eyeBlinkRight"), 1.0)];
        MixOptions::new()
            .layer(MixLayer::clip(LayerGroup::SPEECH))
            .layer(MixLayer::poses(&[&[
                (self.curve("mouthSmileLeft"), 0.5),
                (self.variable(), 1.0),
            ]]))
            .layer(MixLayer::stream(LayerGroup::BASE, &[self.curve("browInnerUp")]))
            .layer(
                MixLayer::generator(Generator::BLINK, &lids, 4 * TICKS_PER_SECOND)
                    .mode(BlendMode::MAX),
            )
            .reaction(Reaction {
                strokes: vec![squint],
                level_on: 0.5,
                level_off: 0.25,
                ..Default::default()
            })
            .variables(1)
    }
    fn mixer(&self) -> Mixer {
        self.options().create(&self.rig).unwrap().mixer(1).unwrap()
    }
}

fn cut() -> PlayOptions {
    PlayOptions { transition: Transition::CUT, ..Default::default() }
}

#[test]
fn layers_reach_the_instance() {
    let head = Head::get();
    let (clip, binding) = head.speech();
    let mix = head.options().create(&head.rig).unwrap();
    assert_eq!((mix.info().layer_count, mix.info().variable_count), (4, 1));
    let mut mixer = mix.mixer_with_stages(3).unwrap();
    drop(mix);
    let mut face = head.rig.instance().unwrap();
    mixer.play(0, &clip, &binding, &cut()).unwrap();
    mixer.set_pose_weight(1, 0, 1.0, 0).unwrap();
    mixer.set_variable(0, 0.0).unwrap();
    mixer.step(10 * FRAME, Some(&mut face)).unwrap();
    let value = |mixer: &Mixer, name| mixer.row()[head.curve(name)];
    assert_eq!(face.raw_controls()[head.curve("jawOpen")], 10.0 / 128.0);
    assert_eq!(value(&mixer, "mouthPucker"), 0.5);
    assert_eq!(value(&mixer, "mouthSmileLeft"), 0.5);
    assert_eq!(
        (mixer.row()[head.variable()], mixer.stage(0).unwrap()[head.variable()]),
        (1.0, 0.0)
    );
    assert_eq!((mixer.info().tick, mixer.info().event_count), (10 * FRAME, 1));
    let event = mixer.event(0).unwrap();
    assert_eq!((event.layer, event.event.name.as_str()), (0, "word"));
    assert_eq!(mixer.event(1).unwrap_err().status(), Status::INDEX);

    mixer.trigger(0, 1.0, -1).unwrap();
    mixer.step(TICKS_PER_SECOND, None).unwrap();
    assert_eq!(value(&mixer, "eyeSquintLeft"), 1.0);
    mixer.release(0).unwrap();
    mixer.step(TICKS_PER_SECOND, None).unwrap();
    mixer.set_level(0, 0.5).unwrap();
    mixer.step(TICKS_PER_SECOND, None).unwrap();
    assert_eq!(value(&mixer, "eyeSquintLeft"), 0.5);
    mixer.set_level(0, 0.0).unwrap();
    mixer.set_weight(1, 0.0, FRAME).unwrap();
    mixer.stop(0, 0).unwrap();
    mixer.step(TICKS_PER_SECOND, None).unwrap();
    for name in ["eyeSquintLeft", "mouthSmileLeft", "jawOpen"] {
        assert_eq!(value(&mixer, name), 0.0);
    }
}

#[test]
fn clips_live_as_long_as_they_are_read() {
    let head = Head::get();
    let mut mixer = head.mixer();
    let mut weak = Vec::new();
    for _ in 0..6 {
        let (clip, binding) = head.speech();
        let crossfade = PlayOptions { transition: Transition::CROSSFADE, ..Default::default() };
        mixer.play(0, &clip, &binding, &crossfade).unwrap();
        weak.push(Arc::downgrade(&clip));
        drop((clip, binding));
        mixer.step(FRAME, None).unwrap();
    }
    let alive: Vec<_> = weak.iter().map(|clip| clip.upgrade().is_some()).collect();
    assert_eq!(alive, [false, false, false, false, true, true]);
    drop(mixer);
    assert!(weak[5].upgrade().is_none());
}

#[test]
fn snapshots_continue() {
    let head = Head::get();
    let (clip, binding) = head.speech();
    let mix = head.options().create(&head.rig).unwrap();
    let (mut one, mut other) = (mix.mixer(1).unwrap(), mix.mixer(2).unwrap());
    one.play(0, &clip, &binding, &PlayOptions { clip_id: 7, ..Default::default() }).unwrap();
    one.step(5 * FRAME, None).unwrap();
    let saved = one.snapshot().unwrap();
    assert_eq!(other.restore(&saved, &[]).unwrap_err().status(), Status::MISMATCH);
    assert_eq!(
        other.restore(&saved[1..], &[(7, &clip, &binding)]).unwrap_err().status(),
        Status::INVALID_ARGUMENT
    );
    other.restore(&saved, &[(7, &clip, &binding)]).unwrap();
    drop((clip, binding));
    for _ in 0..60 {
        one.step(FRAME, None).unwrap();
        other.step(FRAME, None).unwrap();
        assert_eq!(one.row(), other.row());
    }
}

#[test]
fn batches_are_single_steps() {
    let head = Head::get();
    let (clip, binding) = head.speech();
    let mix = head.options().create(&head.rig).unwrap();
    let mixers = || -> Vec<Mixer> { (0..3).map(|i| mix.mixer(i).unwrap()).collect() };
    let (mut together, mut alone) = (mixers(), mixers());
    let mut faces: Vec<_> = (0..3).map(|_| head.rig.instance().unwrap()).collect();
    for mixer in together.iter_mut().chain(&mut alone) {
        mixer.play(0, &clip, &binding, &PlayOptions::default()).unwrap();
    }
    Mixer::step_batch(together.iter_mut().zip(&mut faces), 9 * FRAME).unwrap();
    for (i, mixer) in alone.iter_mut().enumerate() {
        mixer.step(9 * FRAME, None).unwrap();
        assert_eq!(mixer.row(), together[i].row());
        assert_eq!(faces[i].raw_controls(), &mixer.row()[..faces[i].raw_controls().len()]);
    }
}

#[test]
fn streams_are_pushed_on_another_thread() {
    let head = Head::get();
    let mut mixer = head.mixer();
    assert!(mixer.push(2, 1, &[0.5]).unwrap());
    assert!(!mixer.push(2, 0, &[0.5]).unwrap());
    let mut sender = mixer.sender().unwrap();
    assert!(mixer.sender().is_none());
    assert_eq!(mixer.push(2, 2, &[0.5]).unwrap_err().status(), Status::INVALID_ARGUMENT);
    let producer = std::thread::spawn(move || {
        (1..300).map(|i| sender.push(2, i * FRAME, &[0.75]).unwrap()).filter(|taken| *taken).count()
    });
    for _ in 0..300 {
        mixer.step(FRAME, None).unwrap();
    }
    assert!(producer.join().unwrap() > 0);
    assert!(mixer.sender().is_some());
}

#[test]
fn guards_and_tables_measure_the_rig() {
    let head = Head::get();
    let jaw = head.curve("jawOpen");
    let curves = head.variable();
    let pairs = Mix::find_antagonists(&head.rig).unwrap();
    let blink = (head.curve("eyeBlinkLeft"), head.curve("eyeWideLeft"));
    assert!(pairs.iter().any(|pair| (pair.first, pair.second) == blink));
    let mirror = Mix::find_mirror(&head.deformer, curves).unwrap();
    assert_eq!(usize::from(mirror[head.curve("mouthSmileLeft")]), head.curve("mouthSmileRight"));
    let groups: Vec<_> = (0..head.rig.count(Kind::JOINT_GROUP)).collect();
    let mask = Mix::find_mask(&head.rig, &groups, 0.25, curves + 1).unwrap();
    assert_eq!(mask[curves], 0.25);
    assert_eq!(Mix::find_mask(&head.rig, &[99], 0.0, curves).unwrap_err().status(), Status::INDEX);

    let mix = MixOptions::new()
        .layer(MixLayer::clip(LayerGroup::SPEECH))
        .layer(MixLayer::poses(&[&[(jaw, 0.6), (head.curve("mouthSmileLeft"), 0.8)]]))
        .guards(Guard::LIPS, &head.deformer)
        .antagonists(&pairs)
        .mirror(&mirror)
        .limits(&vec![0.0; curves], &vec![1.0; curves])
        .create(&head.rig)
        .unwrap();
    assert!(mix.info().guard_count >= 3);
    let closed = ClipOptions::new(&["jawOpen", "mouthSmileLeft"]).build(&[0.0; 60]).unwrap();
    let binding = Arc::new(closed.bind(&head.rig, &[]).unwrap());
    let closed = Arc::new(closed);
    let mut mixer = mix.mixer(0).unwrap();
    mixer.play(0, &closed, &binding, &PlayOptions { mirrored: true, ..cut() }).unwrap();
    mixer.set_pose_weight(1, 0, 1.0, 0).unwrap();
    for _ in 0..30 {
        mixer.step(FRAME, None).unwrap();
    }
    assert!(mixer.row()[jaw] < 0.1 && mixer.row()[head.curve("mouthSmileLeft")] > 0.5);
    let lips = mixer.guard(0).unwrap();
    assert!(lips.name.starts_with("lips") && lips.kind == Guard::LIPS);
    assert!(lips.wanted > lips.limit && lips.distance < lips.limit + 0.01);
    assert!(lips.controls.iter().any(|&control| control as usize == jaw));
    assert!(mixer.guard(100).is_err());
    for guard in 0..mix.info().guard_count {
        mixer.set_guard(guard, 0.0).unwrap();
    }
    for _ in 0..30 {
        mixer.step(FRAME, None).unwrap();
    }
    assert!((mixer.row()[jaw] - 0.6).abs() < 1e-5);

    let gaze = Gaze::new(&head.deformer, None).unwrap();
    let [left, right] = gaze.eyes().unwrap();
    assert!(left[0] > 0.0 && left[0] + right[0] < 0.01);
    let mut row = vec![0.0; curves];
    gaze.look_at([100.0, 1700.0, 1000.0], &mut row).unwrap();
    assert!(row[head.curve("eyeLookOutLeft")] > 0.0);
    assert!(gaze.look_at([f32::NAN, 0.0, 1.0], &mut row).is_err());
    assert_eq!(
        Gaze::new(&head.deformer, Some(("nobody", "R_Eye"))).unwrap_err().status(),
        Status::NAME
    );
}

#[test]
fn guards_of_ones_own_tell_what_they_held() {
    let head = Head::get();
    let joint = |name: &str| head.rig.find(Kind::JOINT, name).unwrap() as u32;
    let jaw = head.curve("jawOpen");
    let teeth = CustomGuard {
        upper: Landmark { points: vec![joint("C_TeethUpper")], mesh: None },
        lower: Landmark { points: vec![joint("C_TeethLower")], mesh: None },
        closed_by: None,
        needs_speech: false,
        tolerance: 0.3,
        f_on: 4.0,
    };
    let none: [Vec<(usize, f32)>; 4] = Default::default();
    let [a, b, c, d] = none;
    let glare = Reaction::glare([vec![(head.curve("eyeBlinkLeft"), 1.0)], a, b, c, d]).unwrap();
    assert_eq!(glare.strokes[0].delay, TICKS_PER_SECOND / 1000 * 60);
    let options = MixOptions::new()
        .layer(MixLayer::poses(&[&[(jaw, 0.5)]]))
        .reaction(glare)
        .guards(Guard(0), &head.deformer);
    let mix = options.clone().custom_guard(teeth.clone()).create(&head.rig).unwrap();
    let guard = mix.guard(0).unwrap();
    assert_eq!(usize::from(guard.curves[0]), jaw);
    assert_eq!(mix.guard(1).unwrap_err().status(), Status::INDEX);
    let mut mixer = mix.mixer(0).unwrap();
    mixer.set_pose_weight(0, 0, 1.0, 0).unwrap();
    mixer.trigger(0, 1.0, 0).unwrap();
    mixer.step(TICKS_PER_SECOND / 100 * 13, None).unwrap();
    assert_eq!(mixer.row()[head.curve("eyeBlinkLeft")], 1.0);
    let step = mixer.guard(0).unwrap();
    assert_eq!((step.activation, step.name.as_str()), (1.0, "custom"));
    assert!(step.controls == guard.curves && step.wanted > step.limit);
    assert!((step.distance - step.limit).abs() < 1e-3);
    let wrong = CustomGuard { f_on: 0.0, ..teeth };
    let wrong = options.custom_guard(wrong).create(&head.rig).unwrap_err();
    assert_eq!(wrong.status(), Status::INVALID_ARGUMENT);
}

#[test]
fn gaze_layers_look_at_pose_variables() {
    let head = Head::get();
    let curves = head.variable();
    let gaze = Arc::new(Gaze::new(&head.deformer, None).unwrap());
    let layer = MixLayer::gaze([curves, curves + 1, curves + 2], None, [0.0; 2]);
    let options = MixOptions::new().layer(layer).variables(3);
    assert_eq!(options.create(&head.rig).unwrap_err().status(), Status::INVALID_ARGUMENT);
    let mut mixer = options.gaze(&gaze).create(&head.rig).unwrap().mixer(0).unwrap();
    let place = [200.0, 1700.0, 1000.0];
    for (variable, value) in place.iter().enumerate() {
        mixer.set_variable(variable, *value).unwrap();
    }
    mixer.step(FRAME, None).unwrap();
    let mut row = vec![0.0; curves];
    gaze.look_at(place, &mut row).unwrap();
    assert_eq!(mixer.row()[..curves], row);
}

#[test]
fn wrong_mixes_are_refused() {
    let head = Head::get();
    let fails = |options: MixOptions| options.create(&head.rig).unwrap_err().status();
    let invalid = Status::INVALID_ARGUMENT;
    assert_eq!(fails(MixOptions::new().layer(MixLayer::poses(&[&[(99999, 1.0)]]))), invalid);
    assert_eq!(
        fails(MixOptions::new().layer(MixLayer::clip(LayerGroup::BASE).weight(2.0))),
        invalid
    );
    assert_eq!(fails(MixOptions::new().mirror(&[0])), invalid);
    assert_eq!(fails(MixOptions::new().limits(&[0.0], &[1.0])), invalid);
    assert_eq!(
        fails(MixOptions::new().layer(MixLayer::clip(LayerGroup::BASE).after_guards())),
        invalid
    );
    let (clip, binding) = head.speech();
    let mut mixer = head.mixer();
    let status = |result: mien::Result<()>| result.unwrap_err().status();
    assert_eq!(status(mixer.play(1, &clip, &binding, &cut())), Status::INDEX);
    assert_eq!(status(mixer.play(9, &clip, &binding, &cut())), Status::INDEX);
    assert_eq!(status(mixer.set_weight(0, f32::NAN, 0)), invalid);
    assert_eq!(status(mixer.set_variable(1, 0.0)), Status::INDEX);
    assert_eq!(status(mixer.trigger(1, 1.0, 0)), Status::INDEX);
    assert_eq!(status(mixer.set_level(1, 1.0)), Status::INDEX);
    assert_eq!(status(mixer.set_level(0, 1.5)), invalid);
    assert_eq!(status(mixer.step(-1, None)), invalid);
    assert!(mixer.stage(0).is_err());
}

/// A state of a stack of one solver, and a joint for it.
fn solved(head: &Head, solver: Solver) -> SolverState {
    let options = SolverStackOptions::new().solver_at(solver, "hat", 0).curve_count(4);
    options.check_writes().create(&head.deformer).unwrap().state().unwrap()
}

#[test]
fn solvers_move_joints() {
    let head = Head::get();
    let joint = head.rig.count(Kind::JOINT) - 1;
    let calls = Arc::new(AtomicUsize::new(0));
    let counted = calls.clone();
    let custom = CustomSolver::new(&[joint], move |pose, ticks| {
        counted.fetch_add(1, Ordering::Relaxed);
        pose.state[0] += 1.0;
        pose.outputs[0] = pose.state[0];
        pose.locals[joint][0] += pose.row[3];
        assert_eq!((ticks, pose.previous.len(), pose.is_reset), (FRAME, 1, pose.state[0] == 1.0));
    });
    let custom = custom.reads(&[joint]).previous(&[joint]).state(1).outputs(1);
    let place = head.deformer.bind_matrices()[joint];
    let row = [place[12] + 30.0, place[13], place[14], 2.0];
    let input = SolverInput { row: &row, ..Default::default() };
    let spring = SpringSolver { joint, frequency: 2.0, damping: 0.5, ..Default::default() };
    let copy = CopySolver { source: 0, joint, weight: 1.0, ..Default::default() };
    let space = SpaceSolver { joint, spaces: vec![NO_JOINT, 0], curve: 3, ease_ticks: FRAME };
    let twist = TwistSolver { source: 0, axis: [1.0, 0.0, 0.0], joints: vec![(joint, 0.5)] };
    let aim = AimSolver { joint, ..Default::default() };
    for (solver, moves) in [
        (Solver::Custom(custom), true),
        (Solver::Spring(SpringSolver { rest_offset: [0.0, 1.0, 0.0], ..spring }), true),
        (Solver::Aim(aim), true),
        (Solver::Copy(copy), false),
        (Solver::Space(space), false),
        (Solver::Twist(twist), false),
    ] {
        let mut body = head.deformer.instance().unwrap();
        let mut state = solved(&head, solver.clone());
        for _ in 0..2 {
            body.update_from_values(&[], &[]).unwrap();
            state.step(&mut body, FRAME, &input).unwrap();
        }
        assert_eq!(state.undeclared().unwrap(), "");
        let moved = body.joint_matrices()[joint].iter().zip(&place);
        let moved = moved.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max) > 1e-3;
        assert_eq!(moved, moves, "{solver:?}");
        assert_eq!(state.transforms().len(), head.rig.count(Kind::JOINT));
        if let Solver::Custom(_) = solver {
            assert_eq!(state.outputs(0).unwrap(), [2.0]);
        }
        assert_eq!(state.outputs(1).unwrap_err().status(), Status::INDEX);
    }
    assert_eq!(calls.load(Ordering::Relaxed), 2);
}

#[test]
fn solver_batches_checks_and_panics() {
    let head = Head::get();
    let careless = CustomSolver::new(&[0], |pose, _| pose.locals[1][0] += 1.0);
    let mut state = solved(&head, Solver::Custom(careless));
    let mut body = head.deformer.instance().unwrap();
    let row = [0.0; 4];
    let input = SolverInput { row: &row, ..Default::default() };
    state.step(&mut body, FRAME, &input).unwrap();
    assert_eq!(state.undeclared().unwrap(), "hat");
    assert_eq!(
        state.step(&mut body, FRAME, &SolverInput::default()).unwrap_err().status(),
        Status::MISMATCH
    );
    assert_eq!(state.step(&mut body, -1, &input).unwrap_err().status(), Status::INVALID_ARGUMENT);

    let raise = CustomSolver::new(&[0], |pose, _| pose.locals[0][1] += 2.0);
    let stack = SolverStackOptions::new().solver(Solver::Custom(raise)).create(&head.deformer);
    let stack = stack.unwrap();
    assert_eq!(stack.info().solver_count, 1);
    let mut states: Vec<_> = (0..2).map(|_| stack.state().unwrap()).collect();
    drop(stack);
    let mut bodies: Vec<_> = (0..2).map(|_| head.deformer.instance().unwrap()).collect();
    let height = bodies[1].joint_matrices()[0][13];
    let steps = states.iter_mut().zip(&mut bodies);
    let steps = steps.map(|(state, body)| (state, body, SolverInput::default()));
    SolverState::step_batch(steps, FRAME).unwrap();
    assert_eq!(bodies[1].joint_matrices()[0][13], height + 2.0);

    let mut panics = solved(&head, Solver::Custom(CustomSolver::new(&[0], |_, _| panic!("no"))));
    let step = std::panic::AssertUnwindSafe(|| panics.step(&mut body, FRAME, &input));
    assert!(std::panic::catch_unwind(step).is_err());

    let fails = |solver: Solver| {
        SolverStackOptions::new().solver(solver).create(&head.deformer).unwrap_err().status()
    };
    let spring = SpringSolver { joint: 60000, frequency: 1.0, ..Default::default() };
    assert_eq!(fails(Solver::Spring(spring)), Status::INDEX);
    assert_eq!(fails(Solver::Spring(SpringSolver::default())), Status::INVALID_ARGUMENT);
    assert_eq!(fails(Solver::Aim(AimSolver::default())), Status::INDEX);
    assert_eq!(fails(Solver::Custom(CustomSolver::new(&[], |_, _| {}))), Status::INVALID_ARGUMENT);
}

#[test]
fn files_give_back_the_mix() {
    let head = Head::get();
    let mix = head.options().create(&head.rig).unwrap();
    let bytes = mix.to_bytes().unwrap();
    let same = Mix::from_bytes(&bytes, Some(&head.rig)).unwrap();
    assert_eq!(same.to_bytes().unwrap(), bytes);
    assert_eq!(same.info().layer_count, mix.info().layer_count);
    let path = std::env::temp_dir().join(format!("mien-mixing-{}.mix", std::process::id()));
    mix.save(&path).unwrap();
    let looked_into = Mix::open(&path, None).unwrap();
    std::fs::remove_file(&path).unwrap();
    assert_eq!(looked_into.to_text().unwrap(), mix.to_text().unwrap());
    assert_eq!(Mix::open(&path, None).unwrap_err().status(), Status::FILE_OPEN);
    let short = Mix::from_bytes(&bytes[1..], Some(&head.rig));
    assert_eq!(short.unwrap_err().status(), Status::MIX_SIGNATURE);
}
