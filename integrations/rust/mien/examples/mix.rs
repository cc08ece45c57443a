// SPDX-License-Identifier: MIT
//! mix: a head speaks, is glad, and closes its eyes when a flashlight hits them.
use mien::{
    BlendMode, ClipOptions, Deformer, Dna, Guard, Kind, LayerGroup, MixLayer, MixOptions,
    PlayOptions, Preset, Reaction, Rig, Stroke, TICKS_PER_SECOND,
};
use std::sync::Arc;

const MS: i64 = TICKS_PER_SECOND / 1000;
const FRAME: i64 = TICKS_PER_SECOND / 60;

fn main() -> mien::Result<()> {
    let dna = Dna::generate(Preset::HEAD)?;
    let rig = Rig::new(&dna)?;
    let deformer = Deformer::new(&dna, &rig)?;
    let mut face = rig.instance()?;
    let curve = |name: &str| rig.find(Kind::RAW_CONTROL, name);

    // Speech: the jaw at 60 frames a second, closed for every m of "mama mama".
    let phases = (0..180).map(|i| i % 30);
    let jaw = phases.map(|p| if p < 8 { 0.0 } else { ((p - 8) * (29 - p)) as f32 / 220.0 });
    let speech = Arc::new(ClipOptions::new(&["jawOpen"]).build(&jaw.collect::<Vec<_>>())?);
    let binding = Arc::new(speech.bind(&rig, &[])?);

    // Joy over it, held back where it would part the lips; the flashlight acts last.
    let (jaw, smile, lids, squint) = (
        curve("jawOpen")?,
        curve("mouthSmileLeft")?,
        curve("eyeBlinkLeft")?,
        curve("eyeSquintLeft")?,
    );
    let joy = [
        (jaw, 0.2),
        (smile, 0.9),
        (curve("mouthSmileRight")?, 0.9),
        (curve("cheekSquintLeft")?, 0.6),
        (curve("cheekSquintRight")?, 0.6),
    ];
    let close = Stroke {
        pose: vec![(lids, 1.0), (curve("eyeBlinkRight")?, 1.0)],
        mode: BlendMode::MAX,
        delay: 60 * MS,
        attack: 70 * MS,
        hold: 60 * MS,
        release: 220 * MS,
        ..Default::default()
    };
    let narrow = Stroke {
        pose: vec![(squint, 0.8), (curve("eyeSquintRight")?, 0.8)],
        mode: BlendMode::SCREEN,
        delay: 90 * MS,
        attack: 150 * MS,
        release: 400 * MS,
        is_held: true,
        ..Default::default()
    };
    let flashlight = Reaction {
        strokes: vec![close, narrow],
        cooldown: 250 * MS,
        adapted: 0.6,
        adapt_ticks: 1500 * MS,
        recover_ticks: 1500 * MS,
        ..Default::default()
    };
    let mix = MixOptions::new()
        .layer(MixLayer::clip(LayerGroup::SPEECH))
        .layer(MixLayer::poses(&[&joy]))
        .reaction(flashlight)
        .guards(Guard::LIPS, &deformer)
        .create(&rig)?;

    let mut mixer = mix.mixer(0)?;
    mixer.play(0, &speech, &binding, &PlayOptions { duration: 100 * MS, ..Default::default() })?;
    mixer.set_pose_weight(1, 0, 0.8, 500 * MS)?;
    for i in 1..=150 {
        if i == 90 {
            mixer.trigger(0, 1.0, 600 * MS)?;
        }
        mixer.step(FRAME, Some(&mut face))?; // writes the raw controls of the face
        face.evaluate(0)?;
        if i % 10 == 0 {
            let row = face.raw_controls();
            let most = face.joints().iter().copied().fold(0.0, f32::max);
            println!(
                "{i:3}  jaw {:.4}  smile {:.4}  lids {:.4}  squint {:.4}  joints up to {most:.3}",
                row[jaw], row[smile], row[lids], row[squint]
            );
        }
    }
    Ok(())
}
