// SPDX-License-Identifier: MIT

package mien

// #include "handles.h"
import "C"

import (
	"fmt"
	"unsafe"
)

// Rig is the behavior of a DNA, packed for evaluation. It never changes: any number of instances and goroutines use it.
type Rig struct{ *object }

func (r *Rig) c() *C.MienRig { return (*C.MienRig)(r.pointer) }

func takeRig(rig *C.MienRig, kept ...*object) *Rig {
	return &Rig{newObject(unsafe.Pointer(rig), func(p unsafe.Pointer) { C.mien_rig_destroy((*C.MienRig)(p)) }, kept...)}
}

// NewRig compiles a rig. options may be nil. The DNA may be closed afterwards.
func NewRig(dna *Dna, options *RigDesc) (*Rig, error) {
	if !dna.use() {
		return nil, ErrClosed
	}
	defer dna.done()
	var desc RigDesc
	if options != nil {
		desc = *options
	}
	desc.structSize = uint64(unsafe.Sizeof(desc))
	var rig *C.MienRig
	e := newError()
	status := C.mien_rig_create((*C.MienDna)(dna.pointer), (*C.MienRigDesc)(unsafe.Pointer(&desc)), &rig, e)
	if err := detail(status, e, "cannot create the rig"); err != nil {
		return nil, err
	}
	return takeRig(rig), nil
}

// Close releases the rig once its instances are closed, too; they cannot be evaluated any more.
func (r *Rig) Close() { r.close() }

// Info returns the properties of the rig.
func (r *Rig) Info() (info RigInfo, err error) {
	if !r.use() {
		return info, ErrClosed
	}
	defer r.done()
	info.structSize = uint64(unsafe.Sizeof(info))
	return info, check(C.mien_rig_info(r.c(), (*C.MienRigInfo)(unsafe.Pointer(&info))), "info")
}

// Count returns how many there are of a kind; 0 if the rig is closed.
func (r *Rig) Count(kind Kind) int {
	if !r.use() {
		return 0
	}
	defer r.done()
	var count C.uint32_t
	C.mien_rig_count(r.c(), C.uint32_t(kind), &count) // 0 if it fails
	return int(count)
}

// Name returns the name of a control, joint and so on.
func (r *Rig) Name(kind Kind, index int) (string, error) {
	if !r.use() {
		return "", ErrClosed
	}
	defer r.done()
	var view C.MienStringView
	err := check(C.mien_rig_name(r.c(), C.uint32_t(kind), C.uint32_t(index), &view), fmt.Sprint("no such index: ", index))
	if err != nil {
		return "", err
	}
	return text(view), nil
}

// Find returns the index of a name.
func (r *Rig) Find(kind Kind, name string) (int, error) {
	if !r.use() {
		return 0, ErrClosed
	}
	defer r.done()
	var s scratch
	defer s.free()
	view := s.text(name)
	var index C.uint32_t
	if err := check(C.mien_rig_find_n(r.c(), C.uint32_t(kind), view.data, view.count, &index), name); err != nil {
		return 0, err
	}
	return int(index), nil
}

// ControlShare is a raw control and how much a name drives it.
type ControlShare struct {
	Control uint32
	Weight  float32
}

// Match returns the raw controls that a name of ARKit, VRM, FACS and others stands for, and how it was found.
func (r *Rig) Match(name string) ([]ControlShare, NameMatch, error) {
	if !r.use() {
		return nil, 0, ErrClosed
	}
	defer r.done()
	var s scratch
	defer s.free()
	view := s.text(name)
	shares := make([]ControlShare, MostShares)
	var count C.size_t
	var match C.uint32_t
	status := C.mien_rig_match(r.c(), view.data, view.count, (*C.MienControlShare)(first(shares)), MostShares, &count, &match)
	if err := check(status, name); err != nil {
		return nil, 0, err
	}
	return shares[:int(count)], NameMatch(match), nil
}

// JointParents returns the parent of each joint; a root is its own parent.
func (r *Rig) JointParents() ([]uint16, error) {
	if !r.use() {
		return nil, ErrClosed
	}
	defer r.done()
	var view C.MienIndex16View
	if err := check(C.mien_rig_joint_parents(r.c(), &view), "parents"); err != nil {
		return nil, err
	}
	return append([]uint16(nil), indices(view)...), nil
}

// NeutralJointValues returns translation, rotation and scale of each joint in the neutral pose: 9 or 10 numbers, as of
// Instance.Joints.
func (r *Rig) NeutralJointValues() ([]float32, error) {
	if !r.use() {
		return nil, ErrClosed
	}
	defer r.done()
	var view C.MienFloatView
	if err := check(C.mien_rig_neutral_joint_values(r.c(), &view), "neutral joint values"); err != nil {
		return nil, err
	}
	return append([]float32(nil), floats(view.data, view.count)...), nil
}

// LodIndices returns the indices of a kind that a LOD computes.
func (r *Rig) LodIndices(kind Kind, lod int) ([]uint16, error) {
	if !r.use() {
		return nil, ErrClosed
	}
	defer r.done()
	var view C.MienIndex16View
	if err := check(C.mien_rig_lod_indices(r.c(), C.uint32_t(kind), C.uint32_t(lod), &view), "no such kind or LOD"); err != nil {
		return nil, err
	}
	return append([]uint16(nil), indices(view)...), nil
}

// Bake writes the rig, and its deformer unless it is nil, to a file that is used as it is.
func (r *Rig) Bake(path string, deformer *Deformer) error {
	var s scratch
	defer s.free()
	e := newError()
	return r.withDeformer(deformer, func(d *C.MienDeformer) error {
		return detail(C.mien_bake_file(r.c(), d, s.path(path), e), e, path)
	})
}

// BakeBytes returns the bytes of such a file.
func (r *Rig) BakeBytes(deformer *Deformer) (bytes []byte, err error) {
	err = r.withDeformer(deformer, func(d *C.MienDeformer) (err error) {
		bytes, err = bytesOf(func(buffer unsafe.Pointer, capacity C.size_t, size *C.size_t, e *C.MienError) C.MienStatus {
			return C.mien_bake_memory(r.c(), d, buffer, capacity, size, e)
		})
		return err
	})
	return bytes, err
}

func (r *Rig) withDeformer(deformer *Deformer, call func(*C.MienDeformer) error) error {
	if !r.use() {
		return ErrClosed
	}
	defer r.done()
	if deformer == nil {
		return call(nil)
	}
	if !deformer.use() {
		return ErrClosed
	}
	defer deformer.done()
	return call(deformer.c())
}

// Baked is a baked file. It never changes.
type Baked struct{ *object }

func takeBaked(baked *C.MienBaked, kept ...*object) *Baked {
	return &Baked{newObject(unsafe.Pointer(baked), func(p unsafe.Pointer) { C.mien_baked_close((*C.MienBaked)(p)) }, kept...)}
}

func bakedDesc(options *BakedDesc) *C.MienBakedDesc {
	var desc BakedDesc
	if options != nil {
		desc = *options
	}
	desc.structSize = uint64(unsafe.Sizeof(desc))
	return (*C.MienBakedDesc)(unsafe.Pointer(&desc))
}

// OpenBaked opens a file, which must not change while it is used: it is mapped. options may be nil.
func OpenBaked(path string, options *BakedDesc) (*Baked, error) {
	var s scratch
	defer s.free()
	var baked *C.MienBaked
	e := newError()
	if err := detail(C.mien_baked_open_file(s.path(path), bakedDesc(options), &baked, e), e, path); err != nil {
		return nil, err
	}
	return takeBaked(baked), nil
}

// OpenBakedBytes opens the bytes of a file, of which it makes a copy. options may be nil.
func OpenBakedBytes(bytes []byte, options *BakedDesc) (*Baked, error) {
	memory := copied(bytes)
	defer memory.close()
	var baked *C.MienBaked
	e := newError()
	status := C.mien_baked_open_memory(memory.pointer, C.size_t(len(bytes)), bakedDesc(options), &baked, e)
	if err := detail(status, e, "cannot open the bytes"); err != nil {
		return nil, err
	}
	return takeBaked(baked, memory), nil
}

// Close releases the file once its rig and deformer are closed, too.
func (b *Baked) Close() { b.close() }

// Info returns the properties of the file.
func (b *Baked) Info() (info BakedInfo, err error) {
	if !b.use() {
		return info, ErrClosed
	}
	defer b.done()
	info.structSize = uint64(unsafe.Sizeof(info))
	return info, check(C.mien_baked_info((*C.MienBaked)(b.pointer), (*C.MienBakedInfo)(unsafe.Pointer(&info))), "info")
}

// Rig creates the rig in the file. options may be nil.
func (b *Baked) Rig(options *BakedRigDesc) (*Rig, error) {
	if !b.use() {
		return nil, ErrClosed
	}
	defer b.done()
	var desc BakedRigDesc
	if options != nil {
		desc = *options
	}
	desc.structSize = uint64(unsafe.Sizeof(desc))
	var rig *C.MienRig
	e := newError()
	status := C.mien_rig_from_baked((*C.MienBaked)(b.pointer), (*C.MienBakedRigDesc)(unsafe.Pointer(&desc)), &rig, e)
	if err := detail(status, e, "cannot create the rig"); err != nil {
		return nil, err
	}
	return takeRig(rig, b.object), nil
}

// Deformer creates the deformer in the file, for its rig. options may be nil.
func (b *Baked) Deformer(rig *Rig, options *BakedDeformerDesc) (*Deformer, error) {
	if rig == nil || !useBoth(b.object, rig.object) {
		return nil, ErrClosed
	}
	defer b.done()
	defer rig.done()
	var desc BakedDeformerDesc
	if options != nil {
		desc = *options
	}
	desc.structSize = uint64(unsafe.Sizeof(desc))
	var deformer *C.MienDeformer
	e := newError()
	status := C.mien_deformer_from_baked((*C.MienBaked)(b.pointer), rig.c(),
		(*C.MienBakedDeformerDesc)(unsafe.Pointer(&desc)), &deformer, e)
	if err := detail(status, e, "cannot create the deformer"); err != nil {
		return nil, err
	}
	return takeDeformer(deformer, b.object, rig.object), nil
}
