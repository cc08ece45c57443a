// SPDX-License-Identifier: MIT

// evaluate [FILE.dna [CONTROL]]: turns a control up and tells which joint moves or turns most.
package main

import (
	"fmt"
	"math"
	"mien"
	"mien/author"
	"os"
	"strings"
)

func main() {
	if err := run(append(os.Args[1:], "", "")); err != nil {
		fmt.Fprintln(os.Stderr, err)
		os.Exit(1)
	}
}

func run(arguments []string) error {
	file, control := arguments[0], arguments[1]
	if control == "" {
		control = "CTRL_expressions.jawOpen"
	}
	dna, err := author.Generate(mien.PresetLarge, 0, 0)
	if file != "" {
		dna.Close()
		dna, err = mien.OpenDna(file, nil)
	}
	if err != nil {
		return err
	}
	defer dna.Close()
	rig, err := mien.NewRig(dna, nil)
	if err != nil {
		return err
	}
	defer rig.Close()
	face, err := rig.NewInstance()
	if err != nil {
		return err
	}
	defer face.Close()
	if _, err := rig.Find(mien.KindRawControl, control); err != nil { // some rigs leave the prefix out
		control = control[strings.LastIndex(control, ".")+1:]
	}
	if err := face.Set(control, 1); err != nil { // or face.RawControls[i] = 1
		return err
	}
	if err := face.Evaluate(0); err != nil {
		return err
	}

	most := 0
	for i, value := range face.Joints { // per joint tx ty tz rx ry rz sx sy sz
		if i%9 < 6 && math.Abs(float64(value)) > math.Abs(float64(face.Joints[most])) {
			most = i
		}
	}
	name, err := rig.Name(mien.KindJoint, most/9)
	d := face.Joints[most/9*9:]
	fmt.Printf("%s moves %s most: by %.3f %.3f %.3f, turning it by %.3f %.3f %.3f\n", control, name, d[0], d[1], d[2], d[3],
		d[4], d[5])
	return err
}
