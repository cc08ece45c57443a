// SPDX-License-Identifier: MIT

package mien

// #include "handles.h"
import "C"

import "unsafe"

// Dna is a checked, read-only view of a DNA file. It never changes: any number of goroutines may use it.
type Dna struct{ *object }

// DnaOptions choose what is read of a file; the zero value reads all.
type DnaOptions struct {
	Layers                Layer
	SkipBlendShapeTargets bool
	UnknownLayers         UnknownLayers
	FileAccess            FileAccess
	Lods                  uint64 // bit l: LOD l; 0: all
	System                string // convert to this coordinate system, such as "unity"; "": keep the file's own
}

func dnaDesc(options *DnaOptions, s *scratch) (*C.MienDnaDesc, error) {
	desc := (*C.MienDnaDesc)(s.bytes(unsafe.Sizeof(C.MienDnaDesc{})))
	desc.struct_size = C.size_t(unsafe.Sizeof(*desc))
	if options == nil {
		return desc, nil
	}
	desc.layers = C.uint32_t(options.Layers)
	desc.skip_blend_shape_targets = boolean(options.SkipBlendShapeTargets)
	desc.unknown_layers = C.uint32_t(options.UnknownLayers)
	desc.file_access = C.uint32_t(options.FileAccess)
	desc.lods = C.uint64_t(options.Lods)
	if options.System != "" {
		system := (*C.MienCoordinateSystem)(s.bytes(unsafe.Sizeof(C.MienCoordinateSystem{})))
		system.struct_size = C.size_t(unsafe.Sizeof(*system))
		name := s.text(options.System)
		if err := check(C.mien_coordinate_system_find_n(name.data, name.count, system), options.System); err != nil {
			return nil, err
		}
		desc.system = system
	}
	return desc, nil
}

func boolean(is bool) C.uint32_t {
	if is {
		return 1
	}
	return 0
}

// TakeDna takes over a MienDna* that another package got from the library.
func TakeDna(pointer unsafe.Pointer) *Dna {
	return &Dna{newObject(pointer, func(p unsafe.Pointer) { C.mien_dna_close((*C.MienDna)(p)) })}
}

// OpenDna opens a file. options may be nil.
func OpenDna(path string, options *DnaOptions) (*Dna, error) {
	var s scratch
	defer s.free()
	desc, err := dnaDesc(options, &s)
	if err != nil {
		return nil, err
	}
	var dna *C.MienDna
	e := newError()
	if err := detail(C.mien_dna_open_file(s.path(path), desc, &dna, e), e, path); err != nil {
		return nil, err
	}
	return TakeDna(unsafe.Pointer(dna)), nil
}

// OpenDnaBytes opens the bytes of a file, of which it makes a copy. options may be nil.
func OpenDnaBytes(bytes []byte, options *DnaOptions) (*Dna, error) {
	var s scratch
	defer s.free()
	desc, err := dnaDesc(options, &s)
	if err != nil {
		return nil, err
	}
	memory := copied(bytes)
	defer memory.close()
	var dna *C.MienDna
	e := newError()
	status := C.mien_dna_open_memory(memory.pointer, C.size_t(len(bytes)), desc, &dna, e)
	if err := detail(status, e, "cannot open the bytes"); err != nil {
		return nil, err
	}
	result := TakeDna(unsafe.Pointer(dna))
	result.keep(memory)
	return result, nil
}

// Close releases the memory. What was made from the DNA stays.
func (d *Dna) Close() { d.close() }

// Info returns the properties of the file.
func (d *Dna) Info() (info DnaInfo, err error) {
	if !d.use() {
		return info, ErrClosed
	}
	defer d.done()
	info.structSize = uint64(unsafe.Sizeof(info))
	return info, check(C.mien_dna_info((*C.MienDna)(d.pointer), (*C.MienDnaInfo)(unsafe.Pointer(&info))), "info")
}

// Save writes a file. options may be nil.
func (d *Dna) Save(path string, options *WriteDesc) error {
	if !d.use() {
		return ErrClosed
	}
	defer d.done()
	var s scratch
	defer s.free()
	e := newError()
	return detail(C.mien_dna_write_file((*C.MienDna)(d.pointer), s.path(path), writeDesc(options), e), e, path)
}

func writeDesc(options *WriteDesc) *C.MienWriteDesc {
	var desc WriteDesc
	if options != nil {
		desc = *options
	}
	desc.structSize = uint64(unsafe.Sizeof(desc))
	return (*C.MienWriteDesc)(unsafe.Pointer(&desc))
}

// Bytes returns the bytes of the file. options may be nil.
func (d *Dna) Bytes(options *WriteDesc) ([]byte, error) {
	if !d.use() {
		return nil, ErrClosed
	}
	defer d.done()
	desc := writeDesc(options)
	return bytesOf(func(buffer unsafe.Pointer, capacity C.size_t, size *C.size_t, e *C.MienError) C.MienStatus {
		return C.mien_dna_write_memory((*C.MienDna)(d.pointer), desc, buffer, capacity, size, e)
	})
}

// Field says what the field of a loaded layer contains, by its path: "defn.jointNames[3]". docs/dna-format.md lists
// the fields.
func (d *Dna) Field(path string) (field DnaField, err error) {
	if !d.use() {
		return field, ErrClosed
	}
	defer d.done()
	var s scratch
	defer s.free()
	field.structSize = uint64(unsafe.Sizeof(field))
	e := newError()
	return field, detail(C.mien_dna_field((*C.MienDna)(d.pointer), s.path(path),
		(*C.MienDnaField)(unsafe.Pointer(&field)), e), e, path)
}

// ReadString returns the text of a field.
func (d *Dna) ReadString(path string) (string, error) {
	if !d.use() {
		return "", ErrClosed
	}
	defer d.done()
	var s scratch
	defer s.free()
	var view C.MienStringView
	e := newError()
	if err := detail(C.mien_dna_read_string((*C.MienDna)(d.pointer), s.path(path), &view, e), e, path); err != nil {
		return "", err
	}
	return text(view), nil
}

// ReadFloats returns the elements of an array of floats.
func (d *Dna) ReadFloats(path string) ([]float32, error) {
	field, err := d.Field(path)
	if err != nil {
		return nil, err
	}
	if !d.use() {
		return nil, ErrClosed
	}
	defer d.done()
	var s scratch
	defer s.free()
	values := make([]float32, field.Count)
	e := newError()
	return values, detail(C.mien_dna_read_floats((*C.MienDna)(d.pointer), s.path(path), 0, C.uint64_t(len(values)),
		(*C.float)(first(values)), e), e, path)
}

// ReadIntegers returns the elements of an array of integers, or the one of a field that is none.
func (d *Dna) ReadIntegers(path string) ([]int64, error) {
	field, err := d.Field(path)
	if err != nil {
		return nil, err
	}
	if !d.use() {
		return nil, ErrClosed
	}
	defer d.done()
	var s scratch
	defer s.free()
	values := make([]int64, field.Count)
	e := newError()
	return values, detail(C.mien_dna_read_integers((*C.MienDna)(d.pointer), s.path(path), 0, C.uint64_t(len(values)),
		(*C.int64_t)(first(values)), e), e, path)
}
