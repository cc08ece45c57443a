// SPDX-License-Identifier: MIT
//! solve: poses a head, takes some of its vertices as a scanner would, and finds the controls again.
use mien::{Deformer, Dna, FitFrame, FitOptions, FitPoint, Kind, Normals, Preset, Rig};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let dna = Dna::generate(Preset::HEAD)?;
    let rig = Rig::new(&dna)?;
    let deformer = Deformer::new(&dna, &rig)?;
    let mut face = rig.instance()?;
    let mut skin = deformer.instance()?;

    for (name, value) in [("jawOpen", 0.4), ("mouthSmileLeft", 0.7), ("browInnerUp", 0.5)] {
        face.raw_controls_mut()[rig.find(Kind::RAW_CONTROL, name)?] = value;
    }
    face.evaluate(0)?;
    skin.update(&face)?;
    skin.deform(0, Normals::NONE)?;

    // Every tenth vertex of the first mesh. Targets of NaN would be missing.
    let positions = skin.positions(0)?;
    let points: Vec<_> = (0..positions.len()).step_by(10).map(FitPoint::from).collect();
    let targets: Vec<_> = positions.iter().step_by(10).copied().collect();
    // All raw controls may move, from 0 to 1.
    let options = FitOptions { deformer: Some(&deformer), points: &points, ..Default::default() };
    let mut fit = options.create(&rig)?;

    // The next frame would begin with `start`: the controls found here.
    let frame = FitFrame {
        points: Some(&targets),
        sparse_weight: 1e-4, // what the vertices do not determine stays at 0
        ..Default::default()
    };
    let mut found = vec![0.0; face.raw_controls().len()];
    let result = fit.solve(&frame, &mut found)?;

    println!(
        "{} points are off by {:.3}, after {} iterations",
        points.len(),
        result.point_residual,
        result.iterations
    );
    for (control, value) in found.iter().enumerate().filter(|(_, value)| **value >= 0.005) {
        println!("{} {value:.2}", rig.name(Kind::RAW_CONTROL, control)?);
    }
    Ok(())
}
