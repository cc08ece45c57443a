// SPDX-License-Identifier: MIT

package mien

// #include "handles.h"
import "C"

import (
	"sort"
	"unsafe"
)

// Pose has values of curves by their names: raw controls, and variables of the mix.
type Pose map[string]float32

// MixLayer is one layer; docs/mixing.md and MienMixLayer explain the fields. Times are ticks.
type MixLayer struct {
	Source        LayerSource
	Group         LayerGroup
	Mode          BlendMode
	Weight        float32 // the initial one, 0 if you leave it out
	AfterGuards   bool
	Mask          Pose      // weights of curves, 0 of all others; nil: 1 of all
	Poses         []Pose    // with LayerSourcePoses
	Curves        []string  // of a stream or generator
	Amounts       []float32 // of a generator: a factor for each curve, or nil
	Generator     Generator
	Period, Delay int64
	StreamFrames  int
}

// MixStroke is one stroke of a reaction, as in MienMixStroke. Times are ticks.
type MixStroke struct {
	Pose                         Pose
	Mode                         BlendMode
	Delay, Attack, Hold, Release int64
	IsHeld, IsLag, IsScaled      bool
}

// MixReaction is a reaction to a stimulus, as in MienMixReaction. Times are ticks.
type MixReaction struct {
	Strokes                            []MixStroke
	Retrigger                          Retrigger
	AfterGuards                        bool
	Cooldown, AdaptTicks, RecoverTicks int64
	Adapted                            float32 // 1: does not adapt
	LevelOn, LevelOff                  float32
}

// MixAntagonists are two curves that move the face in opposite directions.
type MixAntagonists struct {
	First, Second uint16
	Stiffness     float32
}

// MixDesc says what a mix does with the curves of a rig; docs/mixing.md and MienMixDesc explain it.
type MixDesc struct {
	Layers                                                   []MixLayer
	Reactions                                                []MixReaction
	Variables                                                []string // names of pose variables: curves behind the raw controls
	Antagonists                                              []MixAntagonists
	Mirror                                                   []uint16  // such as of Deformer.Mirror, so that clips can be played mirrored; or nil
	Lower, Upper                                             []float32 // limits of all curves, or nil
	Guards                                                   Guard     // measured with the deformer
	Deformer                                                 *Deformer
	Gaze                                                     *Gaze // for layers of GeneratorGaze
	PlayerCount, MaxChannels, MaxChangingChannels, MaxEvents int
	Reverse                                                  bool
}

// Mix has layers, reactions and guards of a rig. It never changes.
type Mix struct{ *object }

func (m *Mix) c() *C.MienMix { return (*C.MienMix)(m.pointer) }

func takeMix(mix *C.MienMix) *Mix {
	return &Mix{newObject(unsafe.Pointer(mix), func(p unsafe.Pointer) { C.mien_mix_destroy((*C.MienMix)(p)) })}
}

// mixArrays makes the structs of a MixDesc in C memory.
type mixArrays struct {
	scratch
	rig       *Rig
	variables []string
	rawCount  int
	poses     []C.MienMixPose
}

func (m *mixArrays) curve(name string) (uint16, error) {
	for i, variable := range m.variables {
		if variable == name {
			return uint16(m.rawCount + i), nil
		}
	}
	index, err := m.rig.Find(KindRawControl, name)
	if err != nil {
		return 0, &Error{StatusName, "no raw control or variable " + name, -1}
	}
	return uint16(index), nil
}

func (m *mixArrays) curves(names []string) (*C.uint16_t, error) {
	indices := make([]uint16, len(names))
	for i, name := range names {
		index, err := m.curve(name)
		if err != nil {
			return nil, err
		}
		indices[i] = index
	}
	return (*C.uint16_t)(inScratch(&m.scratch, indices)), nil
}

func (m *mixArrays) pose(pose Pose) (C.uint32_t, error) {
	values := map[uint16]float32{}
	indices := make([]uint16, 0, len(pose))
	for name, value := range pose {
		index, err := m.curve(name)
		if err != nil {
			return 0, err
		}
		values[index] = value
		indices = append(indices, index)
	}
	sort.Slice(indices, func(a, b int) bool { return indices[a] < indices[b] })
	sorted := make([]float32, len(indices))
	for i, index := range indices {
		sorted[i] = values[index]
	}
	m.poses = append(m.poses, C.MienMixPose{curves: (*C.uint16_t)(inScratch(&m.scratch, indices)),
		values: (*C.float)(inScratch(&m.scratch, sorted)), count: C.size_t(len(indices))})
	return C.uint32_t(len(m.poses) - 1), nil
}

func (m *mixArrays) layer(from MixLayer) (to C.MienMixLayer, err error) {
	if from.Amounts != nil && len(from.Amounts) != len(from.Curves) {
		return to, invalid("%d amounts for %d curves", len(from.Amounts), len(from.Curves))
	}
	to = C.MienMixLayer{period: C.int64_t(from.Period), delay: C.int64_t(from.Delay), group: C.uint32_t(from.Group),
		mode: C.uint32_t(from.Mode), source: C.uint32_t(from.Source), after_guards: boolean(from.AfterGuards),
		weight: C.float(from.Weight), generator: C.uint32_t(from.Generator), stream_frames: C.uint32_t(from.StreamFrames),
		first_pose: C.uint32_t(len(m.poses)), pose_count: C.uint32_t(len(from.Poses)),
		curve_count: C.uint32_t(len(from.Curves)), amounts: (*C.float)(inScratch(&m.scratch, from.Amounts))}
	if to.curves, err = m.curves(from.Curves); err != nil {
		return to, err
	}
	if from.Mask != nil {
		weights := make([]float32, m.rawCount+len(m.variables))
		for name, weight := range from.Mask {
			index, err := m.curve(name)
			if err != nil {
				return to, err
			}
			weights[index] = weight
		}
		to.mask, to.mask_count = (*C.float)(inScratch(&m.scratch, weights)), C.uint32_t(len(weights))
	}
	for _, pose := range from.Poses {
		if _, err = m.pose(pose); err != nil {
			return to, err
		}
	}
	return to, nil
}

func (m *mixArrays) reaction(from MixReaction) (to C.MienMixReaction, err error) {
	strokes := make([]C.MienMixStroke, len(from.Strokes))
	for i, one := range from.Strokes {
		strokes[i] = C.MienMixStroke{delay: C.int64_t(one.Delay), attack: C.int64_t(one.Attack), hold: C.int64_t(one.Hold),
			release: C.int64_t(one.Release), mode: C.uint32_t(one.Mode), is_held: boolean(one.IsHeld),
			is_lag: boolean(one.IsLag), is_scaled: boolean(one.IsScaled)}
		if strokes[i].pose, err = m.pose(one.Pose); err != nil {
			return to, err
		}
	}
	return C.MienMixReaction{cooldown: C.int64_t(from.Cooldown), adapt_ticks: C.int64_t(from.AdaptTicks),
		recover_ticks: C.int64_t(from.RecoverTicks), strokes: (*C.MienMixStroke)(inScratch(&m.scratch, strokes)),
		stroke_count: C.size_t(len(strokes)), retrigger: C.uint32_t(from.Retrigger),
		after_guards: boolean(from.AfterGuards), adapted: C.float(from.Adapted), level_on: C.float(from.LevelOn),
		level_off: C.float(from.LevelOff)}, nil
}

// fill returns the desc without gaze and deformer.
func (m *mixArrays) fill(from MixDesc) (*C.MienMixDesc, error) {
	count := m.rawCount + len(m.variables)
	if from.Mirror != nil && len(from.Mirror) != count || from.Lower != nil && len(from.Lower) != count ||
		from.Upper != nil && len(from.Upper) != count {
		return nil, invalid("Mirror, Lower and Upper have one value for each of %d curves", count)
	}
	layers := make([]C.MienMixLayer, len(from.Layers))
	reactions := make([]C.MienMixReaction, len(from.Reactions))
	var err error
	for i, layer := range from.Layers {
		if layers[i], err = m.layer(layer); err != nil {
			return nil, err
		}
	}
	for i, reaction := range from.Reactions {
		if reactions[i], err = m.reaction(reaction); err != nil {
			return nil, err
		}
	}
	desc := (*C.MienMixDesc)(m.bytes(unsafe.Sizeof(C.MienMixDesc{})))
	desc.struct_size = C.size_t(unsafe.Sizeof(*desc))
	desc.layers, desc.layer_count = (*C.MienMixLayer)(inScratch(&m.scratch, layers)), C.size_t(len(layers))
	desc.poses, desc.pose_count = (*C.MienMixPose)(inScratch(&m.scratch, m.poses)), C.size_t(len(m.poses))
	desc.reactions, desc.reaction_count = (*C.MienMixReaction)(inScratch(&m.scratch, reactions)), C.size_t(len(reactions))
	desc.antagonists = (*C.MienMixAntagonists)(inScratch(&m.scratch, from.Antagonists))
	desc.antagonist_count = C.size_t(len(from.Antagonists))
	desc.mirror = (*C.uint16_t)(inScratch(&m.scratch, from.Mirror))
	desc.lower, desc.upper = (*C.float)(inScratch(&m.scratch, from.Lower)), (*C.float)(inScratch(&m.scratch, from.Upper))
	desc.guards, desc.variable_count = C.uint32_t(from.Guards), C.uint32_t(len(m.variables))
	desc.player_count, desc.max_events = C.uint32_t(from.PlayerCount), C.uint32_t(from.MaxEvents)
	desc.max_channels, desc.max_changing_channels = C.uint32_t(from.MaxChannels), C.uint32_t(from.MaxChangingChannels)
	desc.reverse = boolean(from.Reverse)
	return desc, nil
}

// NewMix creates a mix for this rig.
func (r *Rig) NewMix(from MixDesc) (*Mix, error) {
	if !r.use() {
		return nil, ErrClosed
	}
	defer r.done()
	arrays := mixArrays{rig: r, variables: from.Variables, rawCount: r.Count(KindRawControl)}
	defer arrays.free()
	desc, err := arrays.fill(from)
	if err != nil {
		return nil, err
	}
	if from.Deformer != nil {
		if !from.Deformer.use() {
			return nil, ErrClosed
		}
		defer from.Deformer.done()
		desc.deformer = from.Deformer.c()
	}
	if from.Gaze != nil {
		if !from.Gaze.use() {
			return nil, ErrClosed
		}
		defer from.Gaze.done()
		desc.gaze = (*C.MienGaze)(from.Gaze.pointer)
	}
	var mix *C.MienMix
	e := newError()
	if err := detail(C.mien_mix_create(r.c(), desc, &mix, e), e, "cannot create the mix"); err != nil {
		return nil, err
	}
	return takeMix(mix), nil
}

// Antagonists returns pairs of raw controls that move the face in opposite directions, for MixDesc.Antagonists.
func (r *Rig) Antagonists() ([]MixAntagonists, error) {
	if !r.use() {
		return nil, ErrClosed
	}
	defer r.done()
	var count C.size_t
	if err := check(C.mien_mix_antagonists(r.c(), nil, 0, &count), "antagonists"); err != nil {
		return nil, err
	}
	pairs := make([]MixAntagonists, int(count))
	return pairs, check(C.mien_mix_antagonists(r.c(), (*C.MienMixAntagonists)(first(pairs)), count, &count), "antagonists")
}

// OpenMix opens a file, as Save writes it, for a rig that has its controls.
func OpenMix(path string, rig *Rig) (*Mix, error) {
	if !rig.use() {
		return nil, ErrClosed
	}
	defer rig.done()
	var s scratch
	defer s.free()
	var mix *C.MienMix
	e := newError()
	if err := detail(C.mien_mix_open_file(s.path(path), rig.c(), nil, &mix, e), e, path); err != nil {
		return nil, err
	}
	return takeMix(mix), nil
}

// OpenMixBytes opens the bytes of a file.
func OpenMixBytes(bytes []byte, rig *Rig) (*Mix, error) {
	if !rig.use() {
		return nil, ErrClosed
	}
	defer rig.done()
	var mix *C.MienMix
	e := newError()
	status := C.mien_mix_open_memory(first(bytes), C.size_t(len(bytes)), rig.c(), nil, &mix, e)
	if err := detail(status, e, "cannot open the bytes"); err != nil {
		return nil, err
	}
	return takeMix(mix), nil
}

// Close releases the mix once its mixers are closed, too.
func (m *Mix) Close() { m.close() }

// Save writes a file.
func (m *Mix) Save(path string) error {
	if !m.use() {
		return ErrClosed
	}
	defer m.done()
	var s scratch
	defer s.free()
	e := newError()
	return detail(C.mien_mix_write_file(m.c(), s.path(path), e), e, path)
}

// Bytes returns the bytes of the file.
func (m *Mix) Bytes() ([]byte, error) {
	if !m.use() {
		return nil, ErrClosed
	}
	defer m.done()
	return bytesOf(func(buffer unsafe.Pointer, capacity C.size_t, size *C.size_t, e *C.MienError) C.MienStatus {
		return C.mien_mix_write_memory(m.c(), buffer, capacity, size, e)
	})
}

// Text returns the text of the file.
func (m *Mix) Text() (string, error) {
	if !m.use() {
		return "", ErrClosed
	}
	defer m.done()
	bytes, err := bytesOf(func(buffer unsafe.Pointer, capacity C.size_t, size *C.size_t, e *C.MienError) C.MienStatus {
		return C.mien_mix_write_text(m.c(), buffer, capacity, size, e)
	})
	return string(bytes), err
}

// Info returns the properties of the mix.
func (m *Mix) Info() (info MixInfo, err error) {
	if !m.use() {
		return info, ErrClosed
	}
	defer m.done()
	info.structSize = uint64(unsafe.Sizeof(info))
	return info, check(C.mien_mix_info(m.c(), (*C.MienMixInfo)(unsafe.Pointer(&info))), "info")
}
