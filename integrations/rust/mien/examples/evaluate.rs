// SPDX-License-Identifier: MIT
//! evaluate [FILE.dna [CONTROL]]: raises a control and prints the joint that moves or turns most.
use mien::{Dna, Kind, Preset, Rig};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let dna = match arguments.next() {
        Some(file) => Dna::open(file)?,
        None => Dna::generate(Preset::LARGE)?,
    };
    let control = arguments.next().unwrap_or_else(|| "CTRL_expressions.jawOpen".into());

    let rig = Rig::new(&dna)?;
    let mut face = rig.instance()?;
    let control = match rig.find(Kind::RAW_CONTROL, &control) {
        Ok(_) => control,
        Err(_) => control.rsplit('.').next().unwrap_or("").into(), // some rigs leave the prefix out
    };
    face.raw_controls_mut()[rig.find(Kind::RAW_CONTROL, &control)?] = 1.0; // written in place
    face.evaluate(0)?;

    // Per joint tx ty tz rx ry rz sx sy sz, from neutral; of equals the first.
    let reach = |joint: &[f32]| joint[..6].iter().fold(0.0, |most, t| t.abs().max(most));
    let joints = face.joints().chunks_exact(9).enumerate();
    let (most, d) =
        joints.reduce(|a, b| if reach(b.1) > reach(a.1) { b } else { a }).ok_or("no joints")?;
    println!(
        "{control} moves {} most: by {:.3} {:.3} {:.3}, turning it by {:.3} {:.3} {:.3}",
        rig.name(Kind::JOINT, most)?,
        d[0],
        d[1],
        d[2],
        d[3],
        d[4],
        d[5]
    );
    Ok(())
}
