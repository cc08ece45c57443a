// SPDX-License-Identifier: MIT

package mien

// #include "handles.h"
import "C"

import "unsafe"

// Mixer plays a mix for one character. For one goroutine at a time, except Push. Step, Push, Play, weights and triggers
// allocate nothing. Times are ticks.
type Mixer struct {
	*object
	accepted, layer C.uint32_t // results of calls, here because Go would allocate variables whose address C gets
	play            PlayDesc
	failure         C.MienError

	Row []float32 // all curves of the last step: raw controls, then variables. Memory of the mixer, valid until Close
}

func (m *Mixer) c() *C.MienMixer { return (*C.MienMixer)(m.pointer) }

// NewMixer creates a character. options may be nil.
func (m *Mix) NewMixer(options *MixerDesc) (*Mixer, error) {
	if !m.use() {
		return nil, ErrClosed
	}
	defer m.done()
	var desc MixerDesc
	if options != nil {
		desc = *options
	}
	desc.structSize = uint64(unsafe.Sizeof(desc))
	var mixer *C.MienMixer
	e := newError()
	status := C.mien_mixer_create(m.c(), (*C.MienMixerDesc)(unsafe.Pointer(&desc)), &mixer, e)
	if err := detail(status, e, "cannot create a mixer"); err != nil {
		return nil, err
	}
	result := &Mixer{object: newObject(unsafe.Pointer(mixer),
		func(p unsafe.Pointer) { C.mien_mixer_destroy((*C.MienMixer)(p)) }, m.object), failure: *newError()}
	var view C.MienFloatView // cannot fail for a handle that is valid
	C.mien_mixer_row(mixer, &view)
	result.Row = floats(view.data, view.count)
	return result, nil
}

// Close releases the memory, and the clips that the mixer played if they are closed; Row becomes nil.
func (m *Mixer) Close() {
	m.Row = nil
	m.close()
}

// Play plays a clip in a layer. options may be nil. The mixer keeps the clip and the binding until it is closed, even if
// you close them.
func (m *Mixer) Play(layer int, clip *Clip, binding *ClipBinding, options *PlayDesc) error {
	if !useBoth(m.object, clip.object) {
		return ErrClosed
	}
	defer m.done()
	defer clip.done()
	if !binding.use() {
		return ErrClosed
	}
	defer binding.done()
	m.play = PlayDesc{}
	if options != nil {
		m.play = *options
	}
	m.play.structSize = uint64(unsafe.Sizeof(m.play))
	status := C.mien_mixer_play(m.c(), C.uint32_t(layer), clip.c(), binding.c(),
		(*C.MienPlayDesc)(unsafe.Pointer(&m.play)), &m.failure)
	if status == 0 {
		m.keep(clip.object)
		m.keep(binding.object)
		return nil
	}
	return detail(status, &m.failure, "cannot play the clip")
}

// Stop fades out the clip of a layer.
func (m *Mixer) Stop(layer int, fade int64) error {
	if !m.use() {
		return ErrClosed
	}
	defer m.done()
	return check(C.mien_mixer_stop(m.c(), C.uint32_t(layer), C.int64_t(fade)), "no clips play in this layer, or a wrong fade")
}

// SetWeight fades the weight of a layer.
func (m *Mixer) SetWeight(layer int, weight float32, fade int64) error {
	if !m.use() {
		return ErrClosed
	}
	defer m.done()
	return check(C.mien_mixer_set_weight(m.c(), C.uint32_t(layer), C.float(weight), C.int64_t(fade)),
		"no such layer, weight or fade")
}

// SetPoseWeight fades the weight of a pose of a layer.
func (m *Mixer) SetPoseWeight(layer, pose int, weight float32, fade int64) error {
	if !m.use() {
		return ErrClosed
	}
	defer m.done()
	return check(C.mien_mixer_set_pose_weight(m.c(), C.uint32_t(layer), C.uint32_t(pose), C.float(weight), C.int64_t(fade)),
		"no such layer, pose, weight or fade")
}

// SetVariable sets what a pose variable has at the start of each step.
func (m *Mixer) SetVariable(variable int, value float32) error {
	if !m.use() {
		return ErrClosed
	}
	defer m.done()
	return check(C.mien_mixer_set_variable(m.c(), C.uint32_t(variable), C.float(value)), "no such variable or value")
}

// SetGuard sets how much a guard acts, 0 to 1; negative: automatic.
func (m *Mixer) SetGuard(guard int, activation float32) error {
	if !m.use() {
		return ErrClosed
	}
	defer m.done()
	return check(C.mien_mixer_set_guard(m.c(), C.uint32_t(guard), C.float(activation)), "no such guard or activation")
}

// Trigger starts a reaction. hold: how long the stimulus lasts; negative: until Release.
func (m *Mixer) Trigger(reaction int, strength float32, hold int64) error {
	if !m.use() {
		return ErrClosed
	}
	defer m.done()
	return check(C.mien_mixer_trigger(m.c(), C.uint32_t(reaction), C.float(strength), C.int64_t(hold)),
		"no such reaction, strength or hold")
}

// Release ends the stimulus of a reaction.
func (m *Mixer) Release(reaction int) error {
	if !m.use() {
		return ErrClosed
	}
	defer m.done()
	return check(C.mien_mixer_release(m.c(), C.uint32_t(reaction)), "no such reaction")
}

// SetLevel sets the level of what a reaction responds to.
func (m *Mixer) SetLevel(reaction int, level float32) error {
	if !m.use() {
		return ErrClosed
	}
	defer m.done()
	return check(C.mien_mixer_set_level(m.c(), C.uint32_t(reaction), C.float(level)), "no such reaction or level")
}

// Push queues a row for a stream layer. False: it was not taken, because it is not newer than the last one, or the queue is
// full. One goroutine may call this while another one uses the mixer.
func (m *Mixer) Push(layer int, tick int64, values []float32) (bool, error) {
	if !m.use() {
		return false, ErrClosed
	}
	defer m.done()
	err := check(C.mien_mixer_push(m.c(), C.uint32_t(layer), C.int64_t(tick), (*C.float)(first(values)),
		C.size_t(len(values)), &m.accepted), "no such stream, or a wrong number of values, or one that is not finite")
	return m.accepted != 0, err
}

// Step advances the time and writes the raw controls of a character, unless it is nil; then evaluate it.
func (m *Mixer) Step(ticks int64, face *Instance) error {
	if !m.use() {
		return ErrClosed
	}
	defer m.done()
	var instance *C.MienInstance
	if face != nil {
		if !face.use() {
			return ErrClosed
		}
		defer face.done()
		instance = face.c()
	}
	return check(C.mien_mixer_step(m.c(), C.int64_t(ticks), instance),
		"ticks are out of range, or the instance is of another rig")
}

// Info returns the time, and how many events of clips the last step passed.
func (m *Mixer) Info() (info MixerInfo, err error) {
	if !m.use() {
		return info, ErrClosed
	}
	defer m.done()
	info.structSize = uint64(unsafe.Sizeof(info))
	return info, check(C.mien_mixer_info(m.c(), (*C.MienMixerInfo)(unsafe.Pointer(&info))), "info")
}

// Event returns an event of the last step, and its layer.
func (m *Mixer) Event(index int) (event ClipEvent, layer int, err error) {
	if !m.use() {
		return event, 0, ErrClosed
	}
	defer m.done()
	var from C.MienClipEvent
	if err = check(C.mien_mixer_event(m.c(), C.uint32_t(index), &from, &m.layer), "no such event"); err != nil {
		return event, 0, err
	}
	return eventOf(from), int(m.layer), nil
}

// Stage returns the row after a stage of the last step, of a mixer with MixerDesc.Stages: memory of the mixer.
func (m *Mixer) Stage(stage int) ([]float32, error) {
	if !m.use() {
		return nil, ErrClosed
	}
	defer m.done()
	var view C.MienFloatView
	err := check(C.mien_mixer_stage(m.c(), C.uint32_t(stage), &view), "no such stage, or no stages are kept")
	return floats(view.data, view.count), err
}

// GuardState is what a guard did in the last step, as in MienGuardState.
type GuardState struct {
	Name                                                   string
	Kind                                                   Guard
	Controls                                               []uint16
	Activation, ProtectedDistance, Wanted, Limit, Distance float32
}

// Guard returns what a guard did in the last step.
func (m *Mixer) Guard(guard int) (result GuardState, err error) {
	if !m.use() {
		return result, ErrClosed
	}
	defer m.done()
	state := C.MienGuardState{struct_size: C.size_t(unsafe.Sizeof(C.MienGuardState{}))}
	if err = check(C.mien_mixer_guard(m.c(), C.uint32_t(guard), &state), "no such guard"); err != nil {
		return result, err
	}
	return GuardState{text(state.name), Guard(state.kind), append([]uint16(nil), indices(state.controls)...),
		float32(state.activation), float32(state.protected_distance), float32(state.wanted), float32(state.limit),
		float32(state.distance)}, nil
}

// Snapshot returns the state as bytes.
func (m *Mixer) Snapshot() ([]byte, error) {
	if !m.use() {
		return nil, ErrClosed
	}
	defer m.done()
	return bytesOf(func(buffer unsafe.Pointer, capacity C.size_t, size *C.size_t, e *C.MienError) C.MienStatus {
		return C.mien_mixer_snapshot(m.c(), buffer, capacity, size, e)
	})
}

// MixerClip is a clip that Restore may need.
type MixerClip struct {
	ClipId  uint64
	Clip    *Clip
	Binding *ClipBinding
}

// Restore takes a snapshot of a mixer of the same mix. playing: clips that may have been playing.
func (m *Mixer) Restore(snapshot []byte, playing ...MixerClip) error {
	if !m.use() {
		return ErrClosed
	}
	defer m.done()
	clips := make([]C.MienMixerClip, len(playing))
	for i, one := range playing {
		if !useBoth(one.Clip.object, one.Binding.object) {
			return ErrClosed
		}
		defer one.Clip.done()
		defer one.Binding.done()
		clips[i] = C.MienMixerClip{clip_id: C.uint64_t(one.ClipId), clip: one.Clip.c(), clip_binding: one.Binding.c()}
	}
	e := newError()
	status := C.mien_mixer_restore(m.c(), first(snapshot), C.size_t(len(snapshot)), (*C.MienMixerClip)(first(clips)),
		C.size_t(len(clips)), e)
	if err := detail(status, e, "cannot restore"); err != nil {
		return err
	}
	for _, one := range playing {
		m.keep(one.Clip.object)
		m.keep(one.Binding.object)
	}
	return nil
}
