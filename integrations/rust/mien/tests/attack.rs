// SPDX-License-Identifier: MIT
//! Safe code that tries to break memory: objects dropped in every order, callbacks that panic or call back,
//! readers that lie, sizes of all kinds, shared objects on many threads. check.sh runs it with sanitizers.

use mien::{
    Baked, Batch, Clip, ClipOptions, CustomSolver, Deformer, Dna, Error, Instance, Kind,
    LayerGroup, Mix, MixLayer, MixOptions, Normals, OpenOptions, PlayOptions, Preset, Rig,
    RigOptions, Solver, SolverInput, SolverStackOptions, Stages, TICKS_PER_SECOND,
};
use std::any::Any;
use std::io::{self, Cursor, Read, Seek, SeekFrom};
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::{Arc, Mutex};

const FRAME: i64 = TICKS_PER_SECOND / 60;

fn made() -> (Dna<'static>, Rig, Deformer) {
    let dna = Dna::generate(Preset::SMALL).unwrap();
    let rig = Rig::new(&dna).unwrap();
    let deformer = Deformer::new(&dna, &rig).unwrap();
    (dna, rig, deformer)
}

fn clip_of(rig: &Rig) -> Clip {
    ClipOptions::new(&[&rig.name(Kind::RAW_CONTROL, 0).unwrap()]).build(&[0.0, 0.5, 1.0]).unwrap()
}

fn panics(call: impl FnOnce()) -> bool {
    catch_unwind(AssertUnwindSafe(call)).is_err()
}

#[test]
fn any_order_of_drops() {
    for seed in 0..20u64 {
        let (dna, rig, deformer) = made();
        let face = rig.instance().unwrap();
        let body = deformer.instance().unwrap();
        let batch = Batch::with_tasks(&rig, 2, 1).unwrap();
        let clip = Arc::new(clip_of(&rig));
        let binding = Arc::new(clip.bind(&rig, &[]).unwrap());
        let player = clip.player().unwrap();
        let mix: Mix =
            MixOptions::new().layer(MixLayer::clip(LayerGroup::BASE)).create(&rig).unwrap();
        let mut mixer = mix.mixer(1).unwrap();
        mixer.play(0, &clip, &binding, &PlayOptions::default()).unwrap();
        let written = rig.to_baked_bytes(Some(&deformer)).unwrap();
        let baked = Baked::from_reader(&mut Cursor::new(written)).unwrap();
        let (baked_rig, baked_deformer) = {
            let opened = baked.rig().unwrap();
            let meshes = baked.deformer(&opened).unwrap();
            (opened, meshes)
        };
        let solver = CustomSolver::new(&[0], |pose, _| pose.locals[0][0] += 1.0);
        let stack =
            SolverStackOptions::new().solver(Solver::Custom(solver)).create(&deformer).unwrap();
        let mut state = stack.state().unwrap();
        // All but what is used at the end, in an order of its own each time.
        let mut all: Vec<Box<dyn Any + '_>> = vec![
            Box::new(dna),
            Box::new(rig),
            Box::new(deformer),
            Box::new(batch),
            Box::new(clip),
            Box::new(binding),
            Box::new(mix),
            Box::new(stack),
            Box::new(baked),
            Box::new(baked_rig),
        ];
        let mut number = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        while !all.is_empty() {
            number = number.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            drop(all.swap_remove((number >> 33) as usize % all.len()));
        }
        let (mut face, mut body, mut player) = (face, body, player);
        mixer.step(FRAME, Some(&mut face)).unwrap();
        face.evaluate(0).unwrap();
        body.update(&face).unwrap();
        state.step(&mut body, FRAME, &SolverInput::default()).unwrap();
        body.deform(0, Normals::RECOMPUTED).unwrap();
        player.advance(FRAME).unwrap();
        assert!(player.sample()[0].is_finite());
        baked_deformer.instance().unwrap().deform(0, Normals::DEFAULT).unwrap();
    }
}

/// What is thrown by its own drop again.
struct Bomb;
impl Drop for Bomb {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            panic!("dropped");
        }
    }
}

#[test]
fn callbacks_panic_and_objects_live_on() {
    let (_dna, rig, deformer) = made();
    let bomb = || CustomSolver::new(&[0], |_, _| std::panic::panic_any(Bomb));
    let fine = CustomSolver::new(&[0], |pose, _| pose.locals[0][0] += 1.0);
    let options =
        SolverStackOptions::new().solver(Solver::Custom(bomb())).solver(Solver::Custom(fine));
    let stack = options.solver(Solver::Custom(bomb())).create(&deformer).unwrap();
    let (mut state, mut body) = (stack.state().unwrap(), deformer.instance().unwrap());
    for _ in 0..3 {
        body.update_from_values(&[], &[]).unwrap();
        let step = AssertUnwindSafe(|| state.step(&mut body, FRAME, &SolverInput::default()));
        let payload = catch_unwind(step).unwrap_err();
        assert!(payload.is::<Bomb>());
        std::mem::forget(payload);
    }
    body.deform(0, Normals::DEFAULT).unwrap();

    let mut faces: Vec<_> = (0..8).map(|_| rig.instance().unwrap()).collect();
    let mut batch = Batch::with_tasks(&rig, 8, 4).unwrap();
    assert!(panics(|| {
        let pairs = faces.iter_mut().map(|face| (face, 0));
        batch.evaluate_each_on(pairs, Stages::ALL, |_, _| panic!("no threads")).unwrap();
    }));
    // The iterator panics when some instances are borrowed already.
    assert!(panics(|| {
        let pairs = faces.iter_mut().enumerate();
        let pairs = pairs.map(|(i, face)| if i == 5 { panic!("no more") } else { face });
        batch.evaluate(pairs, 0).unwrap();
    }));
    batch.evaluate(&mut faces, 0).unwrap();
}

#[test]
fn callbacks_call_back() {
    let (_dna, rig, deformer) = made();
    let stepped = Arc::new(Mutex::new(0));
    let counted = stepped.clone();
    let inner = CustomSolver::new(&[0], move |_, _| *counted.lock().unwrap() += 1);
    let inner = SolverStackOptions::new().solver(Solver::Custom(inner)).create(&deformer).unwrap();
    let own = Mutex::new((inner.state().unwrap(), deformer.instance().unwrap()));
    drop(inner);
    let outer = CustomSolver::new(&[0], move |_, _| {
        let (state, body) = &mut *own.lock().unwrap();
        state.step(body, FRAME, &SolverInput::default()).unwrap();
    });
    let outer = SolverStackOptions::new().solver(Solver::Custom(outer)).create(&deformer).unwrap();
    let (mut state, mut body) = (outer.state().unwrap(), deformer.instance().unwrap());
    state.step(&mut body, FRAME, &SolverInput::default()).unwrap();
    assert_eq!(*stepped.lock().unwrap(), 1);

    // Work that works, batches in batches, work done too often and by too many threads.
    let mut faces: Vec<_> = (0..8).map(|_| rig.instance().unwrap()).collect();
    let mut batch = Batch::with_tasks(&rig, 8, 4).unwrap();
    let (mut other, mut face) = (Batch::with_tasks(&rig, 1, 1).unwrap(), rig.instance().unwrap());
    let pairs = faces.iter_mut().map(|face| (face, 0));
    let run = |_, work: mien::Work<'_>| {
        other.evaluate([&mut face], 0).unwrap();
        std::thread::scope(|scope| {
            for _ in 0..6 {
                scope.spawn(|| (work(), work()));
            }
        });
        work();
    };
    batch.evaluate_each_on(pairs, Stages::ALL, run).unwrap();
    for other in &faces {
        assert_eq!(other.joints(), face.joints());
    }
}

/// A file that says that it has read more than it was given room for, or has another size each time.
struct Liar {
    file: Cursor<Vec<u8>>,
    more: usize,
    size: Option<u64>,
}

impl Read for Liar {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        Ok(self.file.read(buffer)?.wrapping_add(self.more))
    }
}

impl Seek for Liar {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let at = self.file.seek(to)?;
        Ok(self.size.unwrap_or(at))
    }
}

#[test]
fn readers_lie() {
    let (dna, rig, _deformer) = made();
    let clip = clip_of(&rig);
    type Open = fn(&mut Liar) -> Result<(), Error>;
    let opens: [(Vec<u8>, Open); 3] = [
        (dna.to_bytes().unwrap(), |liar| OpenOptions::new().open_reader(liar).map(drop)),
        (rig.to_baked_bytes(None).unwrap(), |liar| Baked::from_reader(liar).map(drop)),
        (clip.to_bytes().unwrap(), |liar| Clip::from_reader(liar).map(drop)),
    ];
    for (bytes, open) in &opens {
        let liar = |more, size| Liar { file: Cursor::new(bytes.clone()), more, size };
        open(&mut liar(0, None)).unwrap();
        for more in [1, 4096, usize::MAX / 2, usize::MAX] {
            // read_exact() of the standard library panics, or the file ends too early.
            let lied = catch_unwind(AssertUnwindSafe(|| open(&mut liar(more, None))));
            assert!(!matches!(lied, Ok(Ok(()))));
        }
        for size in [0, 1, bytes.len() as u64 / 2] {
            assert!(open(&mut liar(0, Some(size))).is_err());
        }
        let huge = [u64::MAX, u64::MAX - 1, 1 << 63, i64::MAX as u64];
        for size in huge {
            let _ = open(&mut liar(0, Some(size))); // a DNA file may have bytes that nobody reads
        }
    }
}

#[test]
fn sizes_and_indices_of_all_kinds() {
    let (_dna, rig, deformer) = made();
    let mut face = rig.instance().unwrap();
    let mut body = deformer.instance().unwrap();
    let clip = clip_of(&rig);
    for wrong in [100, 0xffff, 0x1_0000, u32::MAX as usize, 1 << 32, usize::MAX / 4, usize::MAX] {
        assert!(rig.name(Kind::RAW_CONTROL, wrong).is_err());
        assert!(face.evaluate(wrong).is_err());
        assert!(body.deform(wrong, Normals::DEFAULT).is_err());
        assert!(deformer.mesh(wrong).is_err());
        assert!(clip.read(wrong, 1).is_err() && clip.read(0, wrong).is_err());
        assert!(clip.read(wrong, usize::MAX).is_err() && clip.read(1, usize::MAX).is_err());
        assert!(Batch::with_tasks(&rig, wrong, wrong).is_err() || wrong < 1 << 17);
        let solver = CustomSolver::new(&[0], |pose, _| pose.state.fill(1.0));
        for solver in
            [solver.clone().state(wrong), solver.clone().outputs(wrong), solver.previous(&[wrong])]
        {
            let stack = SolverStackOptions::new().solver(Solver::Custom(solver)).create(&deformer);
            let state = stack.and_then(|stack| stack.state());
            if let Ok(mut state) = state {
                state.step(&mut body, FRAME, &SolverInput::default()).unwrap();
            }
        }
    }
    for count in [1, 7, 100_000] {
        assert!(body.update_from_values(&vec![0.0; count], &[]).is_err());
        assert!(body.update_from_values(&[], &vec![0.0; count]).is_err());
    }
}

#[test]
fn shared_objects_on_many_threads() {
    let (dna, rig, deformer) = made();
    let clip = Arc::new(clip_of(&rig));
    let binding = Arc::new(clip.bind(&rig, &[]).unwrap());
    let mix = MixOptions::new().layer(MixLayer::clip(LayerGroup::BASE)).create(&rig).unwrap();
    let solver = CustomSolver::new(&[0], |pose, _| pose.state[0] += 1.0).state(1);
    let stack = SolverStackOptions::new().solver(Solver::Custom(solver)).create(&deformer).unwrap();
    let shared: Instance = rig.instance().unwrap();
    std::thread::scope(|scope| {
        for _ in 0..6 {
            scope.spawn(|| {
                for _ in 0..5 {
                    let mut face = rig.instance().unwrap();
                    let mut body = deformer.instance().unwrap();
                    let mut mixer = mix.mixer(1).unwrap();
                    let mut state = stack.state().unwrap();
                    mixer.play(0, &clip, &binding, &PlayOptions::default()).unwrap();
                    mixer.step(FRAME, Some(&mut face)).unwrap();
                    face.evaluate(0).unwrap();
                    body.update(&face).unwrap();
                    state.step(&mut body, FRAME, &SolverInput::default()).unwrap();
                    body.deform(0, Normals::RECOMPUTED).unwrap();
                    assert_eq!(shared.joints().len(), face.joints().len());
                    assert!(rig.find(Kind::JOINT, "nobody").is_err());
                    assert_eq!(clip.player().unwrap().sample().len(), 1);
                    let copy = RigOptions::new().create(&dna).unwrap();
                    assert_eq!(copy.count(Kind::JOINT), rig.count(Kind::JOINT));
                }
            });
        }
    });
}
