// SPDX-License-Identifier: MIT

package mien

// #include "handles.h"
import "C"

import "unsafe"

// ClipEvent is a named moment of a clip.
type ClipEvent struct {
	Tick  int64
	Name  string
	Value float32
}

func eventOf(from C.MienClipEvent) ClipEvent {
	return ClipEvent{int64(from.tick), text(from.name), float32(from.value)}
}

// ClipDesc is what a clip is compressed from.
type ClipDesc struct {
	Names                          []string  // of the channels
	Values                         []float32 // one value per channel, one frame after the other
	RateNumerator, RateDenominator int       // frames per second; 0 and 0: 60
	Snap                           float32   // as in MienClipDesc
	Snaps                          []float32 // one for each channel instead, or nil
	Looping                        Looping
	IsDelta                        bool
	Events                         []ClipEvent
}

// Clip has compressed curves. It never changes.
type Clip struct{ *object }

func (c *Clip) c() *C.MienClip { return (*C.MienClip)(c.pointer) }

func takeClip(clip *C.MienClip, kept ...*object) *Clip {
	return &Clip{newObject(unsafe.Pointer(clip), func(p unsafe.Pointer) { C.mien_clip_close((*C.MienClip)(p)) }, kept...)}
}

// BuildClip compresses curves.
func BuildClip(from ClipDesc) (*Clip, error) {
	channels := len(from.Names)
	if channels == 0 || len(from.Values) == 0 || len(from.Values)%channels != 0 {
		return nil, invalid("%d values are no rows of %d", len(from.Values), channels)
	}
	if from.Snaps != nil && len(from.Snaps) != channels {
		return nil, invalid("%d snaps for %d channels", len(from.Snaps), channels)
	}
	if from.RateNumerator == 0 && from.RateDenominator == 0 {
		from.RateNumerator, from.RateDenominator = 60, 1
	}
	var s scratch
	defer s.free()
	names := make([]C.MienStringView, channels)
	for i, name := range from.Names {
		names[i] = s.text(name)
	}
	events := make([]C.MienClipEvent, len(from.Events))
	for i, event := range from.Events {
		events[i] = C.MienClipEvent{tick: C.int64_t(event.Tick), name: s.text(event.Name), value: C.float(event.Value)}
	}
	desc := (*C.MienClipDesc)(s.bytes(unsafe.Sizeof(C.MienClipDesc{})))
	desc.struct_size = C.size_t(unsafe.Sizeof(*desc))
	desc.rate_numerator, desc.rate_denominator = C.uint32_t(from.RateNumerator), C.uint32_t(from.RateDenominator)
	desc.frame_count, desc.channel_count = C.uint32_t(len(from.Values)/channels), C.uint32_t(channels)
	desc.names = (*C.MienStringView)(inScratch(&s, names))
	desc.values = (*C.float)(inScratch(&s, from.Values))
	desc.snaps = (*C.float)(inScratch(&s, from.Snaps))
	desc.snap, desc.looping, desc.is_delta = C.float(from.Snap), C.uint32_t(from.Looping), boolean(from.IsDelta)
	desc.event_count, desc.events = C.uint32_t(len(events)), (*C.MienClipEvent)(inScratch(&s, events))
	var clip *C.MienClip
	e := newError()
	if err := detail(C.mien_clip_build(desc, &clip, e), e, "cannot build the clip"); err != nil {
		return nil, err
	}
	return takeClip(clip), nil
}

func clipOpenDesc(options *ClipOpenDesc) *C.MienClipOpenDesc {
	var desc ClipOpenDesc
	if options != nil {
		desc = *options
	}
	desc.structSize = uint64(unsafe.Sizeof(desc))
	return (*C.MienClipOpenDesc)(unsafe.Pointer(&desc))
}

// OpenClip opens a file, which must not change while it is used: it is mapped. options may be nil.
func OpenClip(path string, options *ClipOpenDesc) (*Clip, error) {
	var s scratch
	defer s.free()
	var clip *C.MienClip
	e := newError()
	if err := detail(C.mien_clip_open_file(s.path(path), clipOpenDesc(options), &clip, e), e, path); err != nil {
		return nil, err
	}
	return takeClip(clip), nil
}

// OpenClipBytes opens the bytes of a file, of which it makes a copy. options may be nil.
func OpenClipBytes(bytes []byte, options *ClipOpenDesc) (*Clip, error) {
	memory := copied(bytes)
	defer memory.close()
	var clip *C.MienClip
	e := newError()
	status := C.mien_clip_open_memory(memory.pointer, C.size_t(len(bytes)), clipOpenDesc(options), &clip, e)
	if err := detail(status, e, "cannot open the bytes"); err != nil {
		return nil, err
	}
	return takeClip(clip, memory), nil
}

// Close releases the clip once its players are closed and no mixer that is open has played it.
func (c *Clip) Close() { c.close() }

// Info returns the properties of the clip.
func (c *Clip) Info() (info ClipInfo, err error) {
	if !c.use() {
		return info, ErrClosed
	}
	defer c.done()
	info.structSize = uint64(unsafe.Sizeof(info))
	return info, check(C.mien_clip_info(c.c(), (*C.MienClipInfo)(unsafe.Pointer(&info))), "info")
}

// Save writes a file.
func (c *Clip) Save(path string) error {
	if !c.use() {
		return ErrClosed
	}
	defer c.done()
	var s scratch
	defer s.free()
	e := newError()
	return detail(C.mien_clip_write_file(c.c(), s.path(path), e), e, path)
}

// Bytes returns the bytes of the file.
func (c *Clip) Bytes() ([]byte, error) {
	if !c.use() {
		return nil, ErrClosed
	}
	defer c.done()
	return bytesOf(func(buffer unsafe.Pointer, capacity C.size_t, size *C.size_t, e *C.MienError) C.MienStatus {
		return C.mien_clip_write_memory(c.c(), buffer, capacity, size, e)
	})
}

// Read returns the values of frames, channels side by side, one frame after the other.
func (c *Clip) Read(firstFrame, count int) ([]float32, error) {
	info, err := c.Info()
	if err != nil {
		return nil, err
	}
	if firstFrame < 0 || count < 0 || firstFrame+count > int(info.FrameCount) {
		return nil, invalid("frames %d to %d of %d", firstFrame, firstFrame+count, info.FrameCount)
	}
	if !c.use() {
		return nil, ErrClosed
	}
	defer c.done()
	values := make([]float32, count*int(info.ChannelCount))
	e := newError()
	return values, detail(C.mien_clip_read(c.c(), C.uint32_t(firstFrame), C.uint32_t(count), (*C.float)(first(values)), 0,
		e), e, "cannot read the frames")
}

// ClipPlayer plays a clip. For one goroutine at a time.
type ClipPlayer struct {
	*object
	view C.MienFloatView
}

func (p *ClipPlayer) c() *C.MienClipPlayer { return (*C.MienClipPlayer)(p.pointer) }

// NewPlayer creates a player. options may be nil.
func (c *Clip) NewPlayer(options *ClipPlayerDesc) (*ClipPlayer, error) {
	if !c.use() {
		return nil, ErrClosed
	}
	defer c.done()
	var desc ClipPlayerDesc
	if options != nil {
		desc = *options
	}
	desc.structSize = uint64(unsafe.Sizeof(desc))
	var player *C.MienClipPlayer
	e := newError()
	status := C.mien_clip_player_create(c.c(), (*C.MienClipPlayerDesc)(unsafe.Pointer(&desc)), &player, e)
	if err := detail(status, e, "cannot create a player"); err != nil {
		return nil, err
	}
	return &ClipPlayer{object: newObject(unsafe.Pointer(player),
		func(p unsafe.Pointer) { C.mien_clip_player_destroy((*C.MienClipPlayer)(p)) }, c.object)}, nil
}

// Close releases the memory.
func (p *ClipPlayer) Close() { p.close() }

// Info returns the state of the player.
func (p *ClipPlayer) Info() (info ClipPlayerInfo, err error) {
	if !p.use() {
		return info, ErrClosed
	}
	defer p.done()
	info.structSize = uint64(unsafe.Sizeof(info))
	return info, check(C.mien_clip_player_info(p.c(), (*C.MienClipPlayerInfo)(unsafe.Pointer(&info))), "info")
}

// SeekTo jumps to a tick.
func (p *ClipPlayer) SeekTo(tick int64) error {
	if !p.use() {
		return ErrClosed
	}
	defer p.done()
	return check(C.mien_clip_player_seek(p.c(), C.int64_t(tick)), "the tick is out of range")
}

// SetSpeed sets the speed, a fraction.
func (p *ClipPlayer) SetSpeed(numerator, denominator int) error {
	if !p.use() {
		return ErrClosed
	}
	defer p.done()
	return check(C.mien_clip_player_set_speed(p.c(), C.int32_t(numerator), C.int32_t(denominator)),
		"the speed is out of range")
}

// Advance moves by ticks times the speed.
func (p *ClipPlayer) Advance(ticks int64) error {
	if !p.use() {
		return ErrClosed
	}
	defer p.done()
	return check(C.mien_clip_player_advance(p.c(), C.int64_t(ticks)), "the player cannot advance as far")
}

// NextEvent returns the next event that the last Advance passed; false after the last one.
func (p *ClipPlayer) NextEvent() (event ClipEvent, found bool, err error) {
	if !p.use() {
		return event, false, ErrClosed
	}
	defer p.done()
	var from C.MienClipEvent
	var isFound C.uint32_t
	if err = check(C.mien_clip_player_next_event(p.c(), &from, &isFound), "events"); err != nil || isFound == 0 {
		return event, false, err
	}
	return eventOf(from), true, nil
}

// Sample returns the values at the current position, one per channel: memory of the player, valid until Close. Allocates
// nothing.
func (p *ClipPlayer) Sample() ([]float32, error) {
	if !p.use() {
		return nil, ErrClosed
	}
	defer p.done()
	err := check(C.mien_clip_player_sample(p.c(), &p.view), "cannot sample")
	return floats(p.view.data, p.view.count), err
}

// ClipBinding knows which raw controls of a rig the channels of a clip drive. It never changes.
type ClipBinding struct{ *object }

func (b *ClipBinding) c() *C.MienClipBinding { return (*C.MienClipBinding)(b.pointer) }

// Bind finds the controls of a rig that the channels drive, by names. arkit: names of ARKit, which the rig may lack, drive
// what they stand for. Clip and rig may be closed afterwards.
func (c *Clip) Bind(rig *Rig, arkit bool) (*ClipBinding, error) {
	if !useBoth(c.object, rig.object) {
		return nil, ErrClosed
	}
	defer c.done()
	defer rig.done()
	var s scratch
	defer s.free()
	desc := (*C.MienClipBindingDesc)(s.bytes(unsafe.Sizeof(C.MienClipBindingDesc{})))
	desc.struct_size = C.size_t(unsafe.Sizeof(*desc))
	if arkit {
		var count C.size_t
		if err := check(C.mien_arkit_matrix(nil, 0, &count), "matrix"); err != nil {
			return nil, err
		}
		entries := (*C.MienMatrixEntry)(s.bytes(unsafe.Sizeof(C.MienMatrixEntry{}) * uintptr(count)))
		if err := check(C.mien_arkit_matrix(entries, count, &count), "matrix"); err != nil {
			return nil, err
		}
		desc.matrix, desc.matrix_count = entries, count
	}
	var binding *C.MienClipBinding
	e := newError()
	if err := detail(C.mien_clip_binding_create(c.c(), rig.c(), desc, &binding, e), e, "cannot bind the clip"); err != nil {
		return nil, err
	}
	return &ClipBinding{newObject(unsafe.Pointer(binding),
		func(p unsafe.Pointer) { C.mien_clip_binding_destroy((*C.MienClipBinding)(p)) })}, nil
}

// Close releases the memory once no mixer that is open has used it.
func (b *ClipBinding) Close() { b.close() }

// Found returns raw controls that are driven, raw controls that are not, and channels that drive nothing.
func (b *ClipBinding) Found() (controls, extraControls, missingChannels []uint16, err error) {
	if !b.use() {
		return nil, nil, nil, ErrClosed
	}
	defer b.done()
	info := C.MienClipBindingInfo{struct_size: C.size_t(unsafe.Sizeof(C.MienClipBindingInfo{}))}
	if err := check(C.mien_clip_binding_info(b.c(), &info), "info"); err != nil {
		return nil, nil, nil, err
	}
	list := func(view C.MienIndex16View) []uint16 { return append([]uint16(nil), indices(view)...) }
	return list(info.controls), list(info.extra_controls), list(info.missing_channels), nil
}

// Apply sets the raw controls of a character from values of the clip, such as of ClipPlayer.Sample. Allocates nothing.
func (b *ClipBinding) Apply(values []float32, face *Instance) error {
	if !useBoth(b.object, face.object) {
		return ErrClosed
	}
	defer b.done()
	defer face.done()
	return check(C.mien_clip_binding_apply(b.c(), (*C.float)(first(values)), C.size_t(len(values)),
		(*C.float)(first(face.RawControls)), C.size_t(len(face.RawControls))),
		"the values are of another clip, or the instance of another rig")
}
