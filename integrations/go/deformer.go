// SPDX-License-Identifier: MIT

package mien

// #include "handles.h"
import "C"

import "unsafe"

// Deformer has the meshes of a rig. It never changes.
type Deformer struct{ *object }

func (d *Deformer) c() *C.MienDeformer { return (*C.MienDeformer)(d.pointer) }

func takeDeformer(deformer *C.MienDeformer, kept ...*object) *Deformer {
	return &Deformer{newObject(unsafe.Pointer(deformer),
		func(p unsafe.Pointer) { C.mien_deformer_destroy((*C.MienDeformer)(p)) }, kept...)}
}

// NewDeformer takes the meshes of a DNA, for a rig made from it. options may be nil. The DNA may be closed afterwards.
func NewDeformer(dna *Dna, rig *Rig, options *DeformerDesc) (*Deformer, error) {
	if !useBoth(dna.object, rig.object) {
		return nil, ErrClosed
	}
	defer dna.done()
	defer rig.done()
	var desc DeformerDesc
	if options != nil {
		desc = *options
	}
	desc.structSize = uint64(unsafe.Sizeof(desc))
	var deformer *C.MienDeformer
	e := newError()
	status := C.mien_deformer_create((*C.MienDna)(dna.pointer), rig.c(), (*C.MienDeformerDesc)(unsafe.Pointer(&desc)),
		&deformer, e)
	if err := detail(status, e, "cannot create the deformer"); err != nil {
		return nil, err
	}
	return takeDeformer(deformer, rig.object), nil
}

// Close releases the deformer once its instances are closed, too.
func (d *Deformer) Close() { d.close() }

// Info returns the properties of the deformer.
func (d *Deformer) Info() (info DeformerInfo, err error) {
	if !d.use() {
		return info, ErrClosed
	}
	defer d.done()
	info.structSize = uint64(unsafe.Sizeof(info))
	return info, check(C.mien_deformer_info(d.c(), (*C.MienDeformerInfo)(unsafe.Pointer(&info))), "info")
}

// Mesh is a neutral mesh. The slices are memory of the deformer, valid until it is closed.
type Mesh struct {
	PositionCount, VertexCount, TargetCount int
	MaxInfluences                           int    // of one position
	Lods                                    uint64 // bit l: LOD l shows this mesh
	Positions                               []float32
	Normals                                 []float32 // x y z per vertex
	Tangents                                []float32 // x y z w per vertex; empty without DeformerDesc.WithTangents
	TextureCoordinates                      []float32 // u v per vertex; empty with 16-bit storage: Deformer.TextureCoordinates
	VertexPositionIndices                   []uint32
	Triangles                               []uint32 // three vertices each; empty with 16-bit storage: Deformer.Triangles
	TargetChannels                          []uint16 // the blend shape channel of each target
}

// Mesh returns a neutral mesh.
func (d *Deformer) Mesh(mesh int) (result Mesh, err error) {
	if !d.use() {
		return result, ErrClosed
	}
	defer d.done()
	found := C.MienMesh{struct_size: C.size_t(unsafe.Sizeof(C.MienMesh{}))}
	if err = check(C.mien_deformer_mesh(d.c(), C.uint32_t(mesh), &found), "no such mesh"); err != nil {
		return result, err
	}
	longs := func(view C.MienIndex32View) []uint32 { return unsafe.Slice((*uint32)(view.data), int(view.count)) }
	return Mesh{
		PositionCount: int(found.position_count), VertexCount: int(found.vertex_count),
		TargetCount: int(found.target_count), MaxInfluences: int(found.max_influences), Lods: uint64(found.lods),
		Positions:             floats(found.positions.data, found.positions.count),
		Normals:               floats(found.normals.data, found.normals.count),
		Tangents:              floats(found.tangents.data, found.tangents.count),
		TextureCoordinates:    floats(found.texture_coordinates.data, found.texture_coordinates.count),
		VertexPositionIndices: longs(found.vertex_position_indices),
		Triangles:             longs(found.triangles),
		TargetChannels:        indices(found.target_channels),
	}, nil
}

// Triangles returns the triangles of a mesh, three vertices each, with any storage.
func (d *Deformer) Triangles(mesh int) ([]uint32, error) {
	if !d.use() {
		return nil, ErrClosed
	}
	defer d.done()
	found := C.MienMesh{struct_size: C.size_t(unsafe.Sizeof(C.MienMesh{}))}
	if err := check(C.mien_deformer_mesh(d.c(), C.uint32_t(mesh), &found), "no such mesh"); err != nil {
		return nil, err
	}
	result := make([]uint32, 3*int(found.triangle_count))
	return result, check(C.mien_deformer_triangles(d.c(), C.uint32_t(mesh), (*C.uint32_t)(first(result)),
		C.size_t(len(result))), "triangles")
}

// TextureCoordinates returns u v per vertex of a mesh, with any storage.
func (d *Deformer) TextureCoordinates(mesh int) ([]float32, error) {
	if !d.use() {
		return nil, ErrClosed
	}
	defer d.done()
	found := C.MienMesh{struct_size: C.size_t(unsafe.Sizeof(C.MienMesh{}))}
	if err := check(C.mien_deformer_mesh(d.c(), C.uint32_t(mesh), &found), "no such mesh"); err != nil {
		return nil, err
	}
	result := make([]float32, 2*int(found.vertex_count))
	return result, check(C.mien_deformer_texture_coordinates(d.c(), C.uint32_t(mesh), (*C.float)(first(result)),
		C.size_t(len(result))), "texture coordinates")
}

// Mirror returns the counterpart of each curve in the other half of the face, for MixDesc.Mirror: raw controls, then
// variables. Measures the rig, which takes time.
func (d *Deformer) Mirror(curveCount int) ([]uint16, error) {
	if curveCount < 0 {
		return nil, invalid("%d curves", curveCount)
	}
	if !d.use() {
		return nil, ErrClosed
	}
	defer d.done()
	curves := make([]uint16, curveCount)
	e := newError()
	return curves, detail(C.mien_mix_mirror(d.c(), (*C.uint16_t)(first(curves)), C.size_t(curveCount), e), e,
		"cannot find counterparts")
}

// DeformerInstance has the deformed meshes of one character. For one goroutine at a time. The slices are its own memory,
// valid until Close.
type DeformerInstance struct {
	*object

	JointMatrices []float32 // model matrices, 16 numbers per joint, column by column
	SkinMatrices  []float32 // for skinning on a GPU, in the same layout
}

func (d *DeformerInstance) c() *C.MienDeformerInstance { return (*C.MienDeformerInstance)(d.pointer) }

// NewInstance creates a character in the neutral pose. options may be nil.
func (d *Deformer) NewInstance(options *DeformerInstanceDesc) (*DeformerInstance, error) {
	if !d.use() {
		return nil, ErrClosed
	}
	defer d.done()
	var desc DeformerInstanceDesc
	if options != nil {
		desc = *options
	}
	desc.structSize = uint64(unsafe.Sizeof(desc))
	var instance *C.MienDeformerInstance
	e := newError()
	status := C.mien_deformer_instance_create(d.c(), (*C.MienDeformerInstanceDesc)(unsafe.Pointer(&desc)), &instance, e)
	if err := detail(status, e, "cannot create a deformer instance"); err != nil {
		return nil, err
	}
	result := &DeformerInstance{object: newObject(unsafe.Pointer(instance),
		func(p unsafe.Pointer) { C.mien_deformer_instance_destroy((*C.MienDeformerInstance)(p)) }, d.object)}
	var view C.MienFloatView // these cannot fail for a handle that is valid
	C.mien_deformer_instance_joint_matrices(instance, &view)
	result.JointMatrices = floats(view.data, view.count)
	C.mien_deformer_instance_skin_matrices(instance, &view)
	result.SkinMatrices = floats(view.data, view.count)
	return result, nil
}

// Close releases the memory; the fields become nil.
func (d *DeformerInstance) Close() {
	d.JointMatrices, d.SkinMatrices = nil, nil
	d.close()
}

// Update takes over the last evaluation of an instance and computes all matrices; then Deform deforms meshes. Allocates
// nothing.
func (d *DeformerInstance) Update(face *Instance) error {
	if !useBoth(d.object, face.object) {
		return ErrClosed
	}
	defer d.done()
	defer face.done()
	return check(C.mien_deformer_instance_update(d.c(), face.c()), "the instance is of another rig")
}

// UpdateFromValues does the same from values like those of Instance.Joints and Instance.BlendShapes; nil: no deltas.
func (d *DeformerInstance) UpdateFromValues(joints, blendShapes []float32) error {
	if !d.use() {
		return ErrClosed
	}
	defer d.done()
	return check(C.mien_deformer_instance_update_from_values(d.c(), (*C.float)(first(joints)), C.size_t(len(joints)),
		(*C.float)(first(blendShapes)), C.size_t(len(blendShapes))), "the rig has another number of values")
}

// Deform computes positions and normals of a mesh. Allocates nothing.
func (d *DeformerInstance) Deform(mesh int, normals Normals) error {
	if !d.use() {
		return ErrClosed
	}
	defer d.done()
	return check(C.mien_deformer_instance_deform(d.c(), C.uint32_t(mesh), C.uint32_t(normals), nil),
		"no such mesh, or none of the LODs that this instance has")
}

// Positions returns x y z per position, of the last Deform of this mesh: memory of the instance, valid until Close.
func (d *DeformerInstance) Positions(mesh int) ([]float32, error) {
	if !d.use() {
		return nil, ErrClosed
	}
	defer d.done()
	var view C.MienFloatView
	err := check(C.mien_deformer_instance_positions(d.c(), C.uint32_t(mesh), &view), "no such mesh, or not in the LODs")
	return floats(view.data, view.count), err
}

// Normals returns x y z per vertex, of the last Deform of this mesh that computed normals, in the same way.
func (d *DeformerInstance) Normals(mesh int) ([]float32, error) {
	if !d.use() {
		return nil, ErrClosed
	}
	defer d.done()
	var view C.MienFloatView
	err := check(C.mien_deformer_instance_normals(d.c(), C.uint32_t(mesh), &view), "no such mesh, or not in the LODs")
	return floats(view.data, view.count), err
}

// VerticesTo deforms a mesh and writes its vertices to C memory, such as a mapped vertex buffer: x y z as floats at
// `positions`, and unless nil `normals`, each `stride` bytes after the last; `capacity` vertices fit. Go memory does not
// do: the struct that the library gets would point to it.
func (d *DeformerInstance) VerticesTo(mesh int, positions, normals unsafe.Pointer, stride, capacity int) error {
	if !d.use() {
		return ErrClosed
	}
	defer d.done()
	var s scratch
	defer s.free()
	output := (*C.MienVertexOutput)(s.bytes(unsafe.Sizeof(C.MienVertexOutput{})))
	output.struct_size = C.size_t(unsafe.Sizeof(*output))
	output.vertex_capacity = C.size_t(capacity)
	output.positions = C.MienVertexStream{data: positions, stride: C.uint32_t(stride)}
	output.normals = C.MienVertexStream{data: normals, stride: C.uint32_t(stride)}
	return check(C.mien_deformer_instance_write_vertices(d.c(), C.uint32_t(mesh), 0, output, nil),
		"no such mesh, or the memory is too small or has a wrong stride")
}

// Gaze knows how raw controls turn the eyes of a rig. It never changes.
type Gaze struct{ *object }

// NewGaze measures the eyes, which are joints; "": found by their names.
func (d *Deformer) NewGaze(leftEye, rightEye string) (*Gaze, error) {
	if !d.use() {
		return nil, ErrClosed
	}
	defer d.done()
	var s scratch
	defer s.free()
	desc := (*C.MienGazeDesc)(s.bytes(unsafe.Sizeof(C.MienGazeDesc{})))
	desc.struct_size = C.size_t(unsafe.Sizeof(*desc))
	if leftEye != "" {
		desc.left_eye = s.path(leftEye)
	}
	if rightEye != "" {
		desc.right_eye = s.path(rightEye)
	}
	var gaze *C.MienGaze
	e := newError()
	if err := detail(C.mien_gaze_create(d.c(), desc, &gaze, e), e, "cannot create a gaze"); err != nil {
		return nil, err
	}
	return &Gaze{newObject(unsafe.Pointer(gaze), func(p unsafe.Pointer) { C.mien_gaze_destroy((*C.MienGaze)(p)) })}, nil
}

// Close releases the memory.
func (g *Gaze) Close() { g.close() }

// GazeInfo is what was measured. Points are millimeters to the left, up and to the front, in the model space of the rig.
type GazeInfo struct {
	LeftEye, RightEye [3]float32
	FitError          float32 // as in MienGazeInfo
}

// Info returns where the eyes are.
func (g *Gaze) Info() (result GazeInfo, err error) {
	if !g.use() {
		return result, ErrClosed
	}
	defer g.done()
	info := C.MienGazeInfo{struct_size: C.size_t(unsafe.Sizeof(C.MienGazeInfo{}))}
	if err = check(C.mien_gaze_info((*C.MienGaze)(g.pointer), &info), "info"); err != nil {
		return result, err
	}
	point := func(p C.MienGazeTarget) [3]float32 {
		return [3]float32{float32(p.left), float32(p.up), float32(p.front)}
	}
	return GazeInfo{point(info.left_eye), point(info.right_eye), float32(info.fit_error)}, nil
}

// LookAt sets the raw controls of a character so that both eyes look at a point: millimeters to the left, up and to the
// front, in the model space of the rig with its head in the neutral pose. It returns what the eyes cannot reach, for the
// head to turn: tangents of the angles to the left and up.
func (g *Gaze) LookAt(left, up, front float32, face *Instance) (restLeft, restUp float32, err error) {
	if !useBoth(g.object, face.object) {
		return 0, 0, ErrClosed
	}
	defer g.done()
	defer face.done()
	target := C.MienGazeTarget{C.float(left), C.float(up), C.float(front)}
	var rest C.MienGazeRest
	err = check(C.mien_gaze_look_at((*C.MienGaze)(g.pointer), &target, (*C.float)(first(face.RawControls)),
		C.size_t(len(face.RawControls)), &rest), "the target is not finite, or the instance is of another rig")
	return float32(rest.left), float32(rest.up), err
}
