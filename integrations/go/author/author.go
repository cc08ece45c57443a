// SPDX-License-Identifier: MIT

// Package author generates rigs, through libmien-author.
package author

/*
#cgo LDFLAGS: -lmien-author -lmien
#include <mien_author.h>
*/
import "C"

import (
	"mien"
	"unsafe"
)

// Generate generates a rig. flags: as MienGenerateDesc.flags.
func Generate(preset mien.Preset, seed uint64, flags mien.Generate) (*mien.Dna, error) {
	desc := &C.MienGenerateDesc{struct_size: C.size_t(unsafe.Sizeof(C.MienGenerateDesc{})), preset: C.uint32_t(preset),
		flags: C.uint32_t(flags), seed: C.uint64_t(seed)}
	e := &C.MienError{struct_size: C.size_t(unsafe.Sizeof(C.MienError{}))}
	var dna *C.MienDna
	if status := C.mien_dna_generate(desc, &dna, e); status != 0 {
		return nil, &mien.Error{Status: mien.Status(status), Message: C.GoString(&e.message[0]), ByteOffset: -1}
	}
	return mien.TakeDna(unsafe.Pointer(dna)), nil
}
