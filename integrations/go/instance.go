// SPDX-License-Identifier: MIT

package mien

// #include "handles.h"
import "C"

import "unsafe"

// Instance is one character: its controls, and the results of its last evaluation. For one goroutine at a time. The slices
// are its own memory, valid until Close.
type Instance struct {
	*object
	rig *Rig

	// Written by you.
	GuiControls, RawControls, MlMasks []float32

	Controls     []float32 // of the last evaluation: raw controls, then those that it computes
	Joints       []float32 // per joint tx ty tz rx ry rz sx sy sz, or tx ty tz qx qy qz qw sx sy sz: deltas from neutral
	BlendShapes  []float32 // a weight per channel
	AnimatedMaps []float32 // a weight per map
}

func (i *Instance) c() *C.MienInstance { return (*C.MienInstance)(i.pointer) }

// NewInstance creates a character in its initial state.
func (r *Rig) NewInstance() (*Instance, error) {
	if !r.use() {
		return nil, ErrClosed
	}
	defer r.done()
	var instance *C.MienInstance
	e := newError()
	if err := detail(C.mien_instance_create(r.c(), nil, &instance, e), e, "cannot create an instance"); err != nil {
		return nil, err
	}
	result := &Instance{rig: r, object: newObject(unsafe.Pointer(instance),
		func(p unsafe.Pointer) { C.mien_instance_destroy((*C.MienInstance)(p)) }, r.object)}
	// These cannot fail for a handle that is valid.
	var view C.MienMutableFloatView
	C.mien_instance_gui_controls(instance, &view)
	result.GuiControls = floats(view.data, view.count)
	C.mien_instance_raw_controls(instance, &view)
	result.RawControls = floats(view.data, view.count)
	C.mien_instance_ml_masks(instance, &view)
	result.MlMasks = floats(view.data, view.count)
	var values C.MienFloatView
	C.mien_instance_controls(instance, &values)
	result.Controls = floats(values.data, values.count)
	C.mien_instance_joints(instance, &values)
	result.Joints = floats(values.data, values.count)
	C.mien_instance_blend_shapes(instance, &values)
	result.BlendShapes = floats(values.data, values.count)
	C.mien_instance_animated_maps(instance, &values)
	result.AnimatedMaps = floats(values.data, values.count)
	return result, nil
}

// Close releases the memory; the fields become nil.
func (i *Instance) Close() {
	i.GuiControls, i.RawControls, i.MlMasks = nil, nil, nil
	i.Controls, i.Joints, i.BlendShapes, i.AnimatedMaps = nil, nil, nil, nil
	i.close()
}

// Set sets a raw control by its name. In loops, find its index once and use RawControls.
func (i *Instance) Set(name string, value float32) error {
	if !i.use() {
		return ErrClosed
	}
	defer i.done()
	index, err := i.rig.Find(KindRawControl, name)
	if err == nil {
		i.RawControls[index] = value
	}
	return err
}

// Get returns a raw control by its name.
func (i *Instance) Get(name string) (float32, error) {
	if !i.use() {
		return 0, ErrClosed
	}
	defer i.done()
	index, err := i.rig.Find(KindRawControl, name)
	if err != nil {
		return 0, err
	}
	return i.RawControls[index], nil
}

// Reset returns to the initial state.
func (i *Instance) Reset() error {
	if !i.use() {
		return ErrClosed
	}
	defer i.done()
	return check(C.mien_instance_reset(i.c()), "reset")
}

// MapGuiToRaw computes the raw controls from the GUI controls.
func (i *Instance) MapGuiToRaw() error {
	if !useBoth(i.object, i.rig.object) {
		return ErrClosed
	}
	defer i.done()
	defer i.rig.done()
	return check(C.mien_rig_map_gui_to_raw(i.rig.c(), i.c()), "GUI controls")
}

// MapRawToGui does the reverse.
func (i *Instance) MapRawToGui() error {
	if !useBoth(i.object, i.rig.object) {
		return ErrClosed
	}
	defer i.done()
	defer i.rig.done()
	return check(C.mien_rig_map_raw_to_gui(i.rig.c(), i.c()), "raw controls")
}

// Evaluate computes the results from the raw controls. Allocates nothing.
func (i *Instance) Evaluate(lod int) error { return i.EvaluateStages(lod, StageAll) }

// EvaluateStages computes some of them.
func (i *Instance) EvaluateStages(lod int, stages Stage) error {
	if !useBoth(i.object, i.rig.object) {
		return ErrClosed
	}
	defer i.done()
	defer i.rig.done()
	return check(C.mien_rig_evaluate_stages(i.rig.c(), i.c(), C.uint32_t(lod), C.uint32_t(stages)),
		"there is no such LOD or stage")
}

// Batch evaluates many instances of a rig in one call, with the bits of Instance.Evaluate. For one goroutine at a time.
type Batch struct {
	*object
	rig       *Rig
	instances []*C.MienInstance
	lods      []C.uint32_t
}

// NewBatch creates a batch for up to `capacity` instances.
func (r *Rig) NewBatch(capacity int) (*Batch, error) {
	if capacity < 0 {
		return nil, invalid("capacity %d", capacity)
	}
	if !r.use() {
		return nil, ErrClosed
	}
	defer r.done()
	desc := &C.MienBatchDesc{struct_size: C.size_t(unsafe.Sizeof(C.MienBatchDesc{})), capacity: C.uint32_t(capacity)}
	var batch *C.MienBatch
	e := newError()
	if err := detail(C.mien_batch_create(r.c(), desc, &batch, e), e, "cannot create a batch"); err != nil {
		return nil, err
	}
	return &Batch{newObject(unsafe.Pointer(batch), func(p unsafe.Pointer) { C.mien_batch_destroy((*C.MienBatch)(p)) },
		r.object), r, make([]*C.MienInstance, capacity), make([]C.uint32_t, capacity)}, nil
}

// Close releases the memory.
func (b *Batch) Close() { b.close() }

// Evaluate evaluates different instances of the rig. lods has one LOD per instance; nil: 0 for all. Allocates nothing.
func (b *Batch) Evaluate(instances []*Instance, lods []int, stages Stage) error {
	if len(instances) > len(b.instances) {
		return invalid("%d instances in a batch for %d", len(instances), len(b.instances))
	}
	if lods != nil && len(lods) != len(instances) {
		return invalid("%d LODs for %d instances", len(lods), len(instances))
	}
	if !useBoth(b.object, b.rig.object) {
		return ErrClosed
	}
	defer b.done()
	defer b.rig.done()
	used := 0
	defer func() {
		for _, instance := range instances[:used] {
			instance.done()
		}
	}()
	for i, instance := range instances {
		if instance == nil || !instance.use() {
			return ErrClosed
		}
		used++
		b.instances[i] = instance.c()
		b.lods[i] = 0
		if lods != nil {
			b.lods[i] = C.uint32_t(lods[i])
		}
	}
	return check(C.mien_rig_evaluate_batch(b.rig.c(), (*C.MienBatch)(b.pointer), (**C.MienInstance)(first(b.instances)),
		(*C.uint32_t)(first(b.lods)), C.uint32_t(len(instances)), C.uint32_t(stages), nil),
		"a LOD does not exist, or instances are not different ones of this rig")
}
