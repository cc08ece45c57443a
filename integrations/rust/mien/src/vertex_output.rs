// SPDX-License-Identifier: MIT

use crate::convert::index;
use crate::error::check;
use crate::threads::{with_runner, Work};
use crate::{DeformerInstance, Normals, Result, Status, VertexFormat};
use mien_sys as sys;
use std::ptr::{null, null_mut};

/// One attribute of the vertices in a buffer: vertex i starts at `offset + i * stride`.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct VertexAttribute {
    /// How it is stored.
    pub format: VertexFormat,
    /// Bytes before the first vertex; a multiple of 4.
    pub offset: usize,
    /// Bytes from a vertex to the next; a multiple of 4.
    pub stride: usize,
}

/// Where the vertices of a mesh go in a buffer. Attributes may be interleaved or stand one after the
/// other; `None` is not written. `mien.h` defines the tangents.
///
/// ```
/// # use mien::{DeformerOptions, Dna, Normals, Preset, Rig, VertexAttribute, VertexFormat, VertexLayout};
/// # let dna = Dna::generate(Preset::TINY)?;
/// # let rig = Rig::new(&dna)?;
/// let deformer = DeformerOptions::new().with_tangents(true).create(&dna, &rig)?;
/// let layout = VertexLayout::interleaved(
///     Some(VertexFormat::FLOAT32X3),
///     Some(VertexFormat::SNORM10_10_10_2),
///     Some(VertexFormat::SNORM16X4),
/// );
/// assert_eq!(layout.tangents.unwrap(), VertexAttribute {
///     format: VertexFormat::SNORM16X4,
///     offset: 16,
///     stride: 24,
/// });
/// let mut buffer = vec![0u32; deformer.mesh(0)?.normals.len() * 24 / 4];
/// let bytes = bytes_of(&mut buffer); // such as bytemuck::cast_slice_mut()
/// deformer.instance()?.write_vertices(0, Normals::RECOMPUTED, bytes, &layout)?;
/// # fn bytes_of(words: &mut [u32]) -> &mut [u8] {
/// #     let count = std::mem::size_of_val(words);
/// #     unsafe { std::slice::from_raw_parts_mut(words.as_mut_ptr().cast(), count) }
/// # }
/// # Ok::<(), mien::Error>(())
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct VertexLayout {
    /// Floats.
    pub positions: Option<VertexAttribute>,
    /// Any format.
    pub normals: Option<VertexAttribute>,
    /// Any format with a w; needs a deformer with tangents.
    pub tangents: Option<VertexAttribute>,
}

impl VertexFormat {
    /// Bytes of one vertex; 0 for numbers without a name here.
    #[must_use]
    pub const fn size(self) -> usize {
        match self {
            Self::FLOAT32X3 => 12,
            Self::FLOAT32X4 => 16,
            Self::SNORM16X4 => 8,
            Self::SNORM10_10_10_2 => 4,
            _ => 0,
        }
    }
}

impl VertexLayout {
    /// Position, normal and tangent of a vertex one after the other, without gaps.
    #[must_use]
    pub fn interleaved(
        positions: Option<VertexFormat>,
        normals: Option<VertexFormat>,
        tangents: Option<VertexFormat>,
    ) -> Self {
        let size = |format: Option<VertexFormat>| format.map_or(0, VertexFormat::size);
        let stride = size(positions) + size(normals) + size(tangents);
        let at = |offset| move |format| VertexAttribute { format, offset, stride };
        Self {
            positions: positions.map(at(0)),
            normals: normals.map(at(size(positions))),
            tangents: tangents.map(at(size(positions) + size(normals))),
        }
    }

    /// As the library takes it, with a capacity that keeps it within the buffer.
    fn output(&self, buffer: &mut [u8]) -> sys::MienVertexOutput {
        let mut capacity = usize::MAX;
        let mut stream = |attribute: Option<VertexAttribute>| {
            let VertexAttribute { format, offset, stride } = match attribute {
                Some(attribute) => attribute,
                None => return sys::MienVertexStream { data: null_mut(), stride: 0, format: 0 },
            };
            let room = buffer.len().saturating_sub(offset);
            let count = match (room.checked_sub(format.size()), stride) {
                (None, _) | (_, 0) => 0,
                (Some(room), stride) => room / stride + 1,
            };
            capacity = capacity.min(count);
            let data = buffer.as_mut_ptr().wrapping_add(offset.min(buffer.len()));
            sys::MienVertexStream { data: data.cast(), stride: index(stride), format: format.0 }
        };
        let (positions, normals, tangents) =
            (stream(self.positions), stream(self.normals), stream(self.tangents));
        sys::MienVertexOutput {
            positions,
            normals,
            tangents,
            vertex_capacity: capacity,
            ..Default::default()
        }
    }
}

impl DeformerInstance {
    /// Deforms a mesh as [`deform`](Self::deform) does, then writes its vertices to a buffer, such as
    /// mapped memory of a GPU: each byte once, and none is read.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_deformer_instance_write_vertices)]
    pub fn write_vertices(
        &mut self,
        mesh: usize,
        normals: Normals,
        buffer: &mut [u8],
        layout: &VertexLayout,
    ) -> Result<()> {
        let output = layout.output(buffer);
        let (instance, mesh) = (self.raw(), index(mesh));
        // SAFETY: a live handle, and streams that end within the buffer.
        check(unsafe {
            sys::mien_deformer_instance_write_vertices(instance, mesh, normals.0, &output, null())
        })
    }

    /// The same for a mesh of several instances of one deformer, by threads of yours as in
    /// [`deform_on`](Self::deform_on): instance i to buffer i.
    ///
    /// # Errors
    ///
    #[doc = errors!(mien_deformer_instance_write_vertices_batch)]
    /// - [`Status::INVALID_ARGUMENT`] if there are not as many buffers as instances
    pub fn write_vertices_batch_on<'outputs>(
        instances: impl IntoIterator<Item = &'outputs mut DeformerInstance>,
        mesh: usize,
        normals: Normals,
        outputs: impl IntoIterator<Item = (&'outputs mut [u8], VertexLayout)>,
        run: impl FnMut(usize, Work<'_>),
    ) -> Result<()> {
        let instances: Vec<_> = instances.into_iter().map(DeformerInstance::raw).collect();
        let outputs: Vec<_> =
            outputs.into_iter().map(|(buffer, layout)| layout.output(buffer)).collect();
        if outputs.len() != instances.len() {
            return check(Status::INVALID_ARGUMENT.0);
        }
        let mesh = index(mesh);
        // SAFETY: live handles and buffers, different ones as they are borrowed mutably, streams that
        // end within them, and a runner that keeps its promises.
        with_runner(run, |parallel| unsafe {
            sys::mien_deformer_instance_write_vertices_batch(
                instances.as_ptr(),
                instances.len(),
                mesh,
                normals.0,
                outputs.as_ptr(),
                parallel,
            )
        })
    }
}
