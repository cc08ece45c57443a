// SPDX-License-Identifier: MIT

package mien

// StructSizes are those in Go and in C.
func StructSizes() [][2]uintptr { return structSizes }
