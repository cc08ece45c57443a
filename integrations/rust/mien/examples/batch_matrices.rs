// SPDX-License-Identifier: MIT
//! batch_matrices [FILE.dna [FACES]]: many characters, evaluated together; their skin matrices as one array of bytes, as
//! a storage buffer of wgpu or of Bevy takes it.
//!
//! In a renderer, `queue.write_buffer(&buffer, 0, &bytes)` uploads them once a frame. In WGSL:
//!
//! ```wgsl
//! @group(1) @binding(0) var<storage, read> skin: array<mat4x4<f32>>;
//! // joints of character i begin at i * joint_count
//! ```
use mien::{Batch, Deformer, DeformerInstance, Dna, Instance, Preset, Rig};

const FRAMES: usize = 4;

/// Characters that are shown together, with what a frame needs: nothing is allocated after `new`.
struct Faces {
    batch: Batch,
    faces: Vec<Instance>,
    poses: Vec<DeformerInstance>,
    matrices: Vec<[f32; 16]>, // [character][joint], by columns
}

impl Faces {
    fn new(rig: &Rig, deformer: &Deformer, count: usize) -> mien::Result<Self> {
        let faces = (0..count).map(|_| rig.instance()).collect::<mien::Result<Vec<_>>>()?;
        let poses = (0..count).map(|_| deformer.instance()).collect::<mien::Result<Vec<_>>>()?;
        let joints = poses.first().map_or(0, |pose| pose.skin_matrices().len());
        let matrices = vec![[0.0; 16]; count * joints];
        Ok(Self { batch: Batch::new(rig, count)?, faces, poses, matrices })
    }

    /// After the controls of the faces were set.
    fn update(&mut self, lod: usize) -> mien::Result<()> {
        self.batch.evaluate(self.faces.iter_mut(), lod)?;
        let joints = self.matrices.len() / self.faces.len().max(1);
        for (i, pose) in self.poses.iter_mut().enumerate() {
            pose.update(&self.faces[i])?;
            self.matrices[i * joints..(i + 1) * joints].copy_from_slice(pose.skin_matrices());
        }
        Ok(())
    }

    /// What is uploaded. Crates such as bytemuck do the same.
    fn bytes(&self, out: &mut Vec<u8>) {
        out.clear();
        out.extend(self.matrices.iter().flatten().flat_map(|number| number.to_le_bytes()));
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let dna = match arguments.next() {
        Some(file) => Dna::open(file)?,
        None => Dna::generate(Preset::SMALL)?,
    };
    let count: usize = arguments.next().map_or(Ok(16), |number| number.parse())?;
    let rig = Rig::new(&dna)?;
    let deformer = Deformer::new(&dna, &rig)?;
    let mut all = Faces::new(&rig, &deformer, count)?;
    let mut bytes = Vec::with_capacity(all.matrices.len() * 64);
    for frame in 0..FRAMES {
        for (i, face) in all.faces.iter_mut().enumerate() {
            for (c, value) in face.raw_controls_mut().iter_mut().enumerate() {
                *value = ((c * 7 + i * 3 + frame) % 11) as f32 / 10.0;
            }
        }
        all.update(0)?;
        all.bytes(&mut bytes);
    }

    // The last character alone has the same bits.
    let mut alone = rig.instance()?;
    let mut pose = deformer.instance()?;
    if let Some(last) = all.faces.last() {
        alone.raw_controls_mut().copy_from_slice(last.raw_controls());
        alone.evaluate(0)?;
        pose.update(&alone)?;
        let joints = pose.skin_matrices();
        assert_eq!(joints, &all.matrices[all.matrices.len() - joints.len()..]);
    }
    println!(
        "{count} characters x {} joints: {} bytes",
        all.matrices.len() / count.max(1),
        bytes.len()
    );
    Ok(())
}
