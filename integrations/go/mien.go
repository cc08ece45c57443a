// SPDX-License-Identifier: MIT

// Package mien opens, evaluates, mixes and deforms facial rigs in DNA files, through libmien. README.md explains memory,
// threads and errors; api.go has enums and structs with the comments of the C headers.
package mien

/*
#cgo LDFLAGS: -lmien
#include "handles.h"
#include <stdlib.h>
*/
import "C"

import (
	"errors"
	"fmt"
	"math"
	"sync/atomic"
	"unsafe"
)

// ErrClosed is the error of calls of closed objects.
var ErrClosed = errors.New("mien: the object is closed")

// Error is the error of a failed call of the library.
type Error struct {
	Status     Status
	Message    string
	ByteOffset int64 // in the file; -1: unknown
}

func (e *Error) Error() string {
	return "mien: " + C.GoString(C.mien_status_name(C.MienStatus(e.Status))) + ": " + e.Message
}

// check is for statuses of calls that give no message.
func check(status C.MienStatus, what string) error {
	if status == 0 {
		return nil
	}
	return &Error{Status(status), what, -1}
}

// detail is for calls that give one.
func detail(status C.MienStatus, e *C.MienError, what string) error {
	if status == 0 {
		return nil
	}
	result := &Error{Status(status), what, -1}
	if e.status == status {
		if text := C.GoString(&e.message[0]); text != "" {
			result.Message = text
		}
		if e.byte_offset != math.MaxUint64 {
			result.ByteOffset = int64(e.byte_offset)
		}
	}
	return result
}

func newError() *C.MienError {
	return &C.MienError{struct_size: C.size_t(unsafe.Sizeof(C.MienError{}))}
}

func invalid(format string, values ...any) error {
	return &Error{StatusInvalidArgument, fmt.Sprintf(format, values...), -1}
}

// object owns memory of the library. It counts its users: the Go object until Close, calls that use it, and objects that
// were made from it. The last one releases the memory, so the order of Close does not matter.
type object struct {
	pointer unsafe.Pointer
	users   int64
	closed  int32
	kept    []*object
	destroy func(unsafe.Pointer)
}

var openObjects int64

// OpenObjects returns how many objects of the library have not been released, to find those that are never closed.
func OpenObjects() int { return int(atomic.LoadInt64(&openObjects)) }

func newObject(pointer unsafe.Pointer, destroy func(unsafe.Pointer), kept ...*object) *object {
	for _, one := range kept {
		atomic.AddInt64(&one.users, 1) // the caller uses it, so it is not released
	}
	atomic.AddInt64(&openObjects, 1)
	return &object{pointer: pointer, users: 1, kept: kept, destroy: destroy}
}

// use begins a call. False: the object is closed.
func (o *object) use() bool {
	if o == nil {
		return false
	}
	for {
		users := atomic.LoadInt64(&o.users)
		if users == 0 || atomic.LoadInt32(&o.closed) != 0 {
			return false
		}
		if atomic.CompareAndSwapInt64(&o.users, users, users+1) {
			return true
		}
	}
}

// done ends it.
func (o *object) done() {
	if atomic.AddInt64(&o.users, -1) != 0 {
		return
	}
	o.destroy(o.pointer)
	atomic.AddInt64(&openObjects, -1)
	for _, one := range o.kept {
		one.done()
	}
}

// keep keeps another object in use as long as this one; it is in use already.
func (o *object) keep(other *object) {
	for _, one := range o.kept {
		if one == other {
			return
		}
	}
	atomic.AddInt64(&other.users, 1)
	o.kept = append(o.kept, other)
}

func (o *object) close() {
	if o != nil && atomic.CompareAndSwapInt32(&o.closed, 0, 1) {
		o.done()
	}
}

// useBoth begins a call that uses two objects.
func useBoth(a, b *object) bool {
	if !a.use() {
		return false
	}
	if b.use() {
		return true
	}
	a.done()
	return false
}

// copied is an object with a copy of bytes that the library reads for longer than a call: Go memory must not be kept by C.
func copied(bytes []byte) *object {
	return newObject(C.CBytes(append(bytes, 0)), func(p unsafe.Pointer) { C.free(p) })
}

// scratch is C memory for the arrays of a call: structs with pointers to Go memory must not be passed to C.
type scratch struct{ blocks []unsafe.Pointer }

// bytes returns zeroed memory.
func (s *scratch) bytes(size uintptr) unsafe.Pointer {
	block := C.calloc(1, C.size_t(size+1))
	if block == nil {
		panic("mien: out of memory")
	}
	s.blocks = append(s.blocks, block)
	return block
}

func (s *scratch) free() {
	for _, block := range s.blocks {
		C.free(block)
	}
}

func (s *scratch) text(text string) C.MienStringView {
	if text == "" {
		return C.MienStringView{}
	}
	memory := s.bytes(uintptr(len(text)))
	copy(unsafe.Slice((*byte)(memory), len(text)), text)
	return C.MienStringView{data: (*C.char)(memory), count: C.size_t(len(text))}
}

// inScratch copies values to C memory; nil for none.
func inScratch[T any](s *scratch, values []T) unsafe.Pointer {
	if len(values) == 0 {
		return nil
	}
	memory := s.bytes(unsafe.Sizeof(values[0]) * uintptr(len(values)))
	copy(unsafe.Slice((*T)(memory), len(values)), values)
	return memory
}

func (s *scratch) path(path string) *C.char {
	text := C.CString(path)
	s.blocks = append(s.blocks, unsafe.Pointer(text))
	return text
}

// first returns a pointer to the first element, or nil.
func first[T any](values []T) unsafe.Pointer {
	if len(values) == 0 {
		return nil
	}
	return unsafe.Pointer(&values[0])
}

func floats(data *C.float, count C.size_t) []float32 {
	return unsafe.Slice((*float32)(data), int(count))
}

func indices(view C.MienIndex16View) []uint16 {
	return unsafe.Slice((*uint16)(view.data), int(view.count))
}

func text(view C.MienStringView) string { return C.GoStringN(view.data, C.int(view.count)) }

// bytesOf returns what call writes to a buffer.
func bytesOf(call func(buffer unsafe.Pointer, capacity C.size_t, size *C.size_t, e *C.MienError) C.MienStatus) ([]byte, error) {
	var size C.size_t
	e := newError()
	if err := detail(call(nil, 0, &size, e), e, "cannot write"); err != nil {
		return nil, err
	}
	buffer := make([]byte, int(size))
	if err := detail(call(first(buffer), size, &size, e), e, "cannot write"); err != nil {
		return nil, err
	}
	return buffer[:int(size)], nil
}

// LibraryVersion returns major, minor and patch version of the library in use.
func LibraryVersion() (major, minor, patch int) {
	v := int(C.mien_version())
	return v >> 24, v >> 16 & 255, v & 65535
}

func init() {
	if major, minor, _ := LibraryVersion(); major != VersionMajor || major == 0 && minor != VersionMinor {
		panic(fmt.Sprintf("mien: the library is version %d.%d, this package is for %d.%d", major, minor, VersionMajor,
			VersionMinor))
	}
}

// Ticks returns seconds as ticks, the unit of all times.
func Ticks(seconds float64) int64 { return int64(math.Floor(seconds*TicksPerSecond + 0.5)) }
