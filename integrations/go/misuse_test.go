// SPDX-License-Identifier: MIT

package mien_test

import (
	"errors"
	"math"
	"mien"
	"mien/author"
	"sync"
	"testing"
)

// fails expects an error of the library with this status.
func fails(t *testing.T, err error, status mien.Status) *mien.Error {
	t.Helper()
	var e *mien.Error
	if !errors.As(err, &e) || e.Status != status {
		t.Fatalf("failed with %v, not with status %d", err, status)
	}
	return e
}

func errorOf[T any](_ T, err error) error { return err }

func TestFilesThatAreNone(t *testing.T) {
	fails(t, errorOf(mien.OpenDna("/nowhere/head.dna", nil)), mien.StatusFileOpen)
	text := []byte("This is neither a DNA file nor a baked rig nor a clip, but long enough for one.")
	fails(t, errorOf(mien.OpenDnaBytes(text, nil)), mien.StatusDnaSignature)
	rig, _ := small(t, mien.PresetSmall)
	for what, err := range map[string]error{"baked": errorOf(mien.OpenBakedBytes(text, nil)),
		"clip": errorOf(mien.OpenClipBytes(text, nil)), "mix": errorOf(mien.OpenMixBytes(text, rig))} {
		if err == nil {
			t.Fatal(what + " opened")
		}
	}
	dna := must(author.Generate(mien.PresetSmall, 0, 0))
	defer dna.Close()
	bytes := must(dna.Bytes(nil))
	for _, length := range []int{0, 1, 20, 1000, len(bytes) - 1} {
		if _, err := mien.OpenDnaBytes(bytes[:length], nil); err == nil {
			t.Fatal("cut bytes opened")
		}
	}
	var e *mien.Error
	if errors.As(errorOf(mien.OpenDnaBytes(bytes[:1000], nil)), &e); e.ByteOffset < 0 {
		t.Fatal("no byte offset")
	}
	fails(t, errorOf(mien.OpenDnaBytes(bytes, &mien.DnaOptions{System: "nowhere"})), mien.StatusName)
}

func TestClosedObjects(t *testing.T) {
	before := mien.OpenObjects()
	dna := must(author.Generate(mien.PresetSmall, 0, 0))
	rig := must(mien.NewRig(dna, nil))
	deformer := must(mien.NewDeformer(dna, rig, nil))
	face, living := must(rig.NewInstance()), must(rig.NewInstance())
	batch, body := must(rig.NewBatch(1)), must(deformer.NewInstance(nil))
	clip := must(mien.BuildClip(mien.ClipDesc{Names: []string{"a"}, Values: []float32{0, 1}}))
	player, binding := must(clip.NewPlayer(nil)), must(clip.Bind(rig, false))
	mix := must(rig.NewMix(mien.MixDesc{Layers: []mien.MixLayer{{Weight: 1}}}))
	mixer := must(mix.NewMixer(nil))
	check(mixer.Play(0, clip, binding, nil))
	objects := []interface{ Close() }{dna, rig, deformer, face, batch, body, clip, player, binding, mix, mixer}
	for _, one := range objects {
		one.Close()
		one.Close()
	}
	for i, err := range []error{errorOf(mien.NewRig(dna, nil)), errorOf(dna.Bytes(nil)), errorOf(rig.NewInstance()),
		errorOf(rig.BakeBytes(nil)), errorOf(rig.Find(mien.KindJoint, "a")), errorOf(deformer.NewInstance(nil)),
		face.Evaluate(0), face.Set("a", 1), face.Reset(), living.Evaluate(0), batch.Evaluate(nil, nil, 0),
		body.Deform(0, 0), body.Update(living), errorOf(body.Positions(0)), errorOf(clip.Bytes()),
		errorOf(player.Sample()), binding.Apply(nil, living), errorOf(mix.NewMixer(nil)), mixer.Step(1, nil),
		mixer.Play(0, clip, binding, nil), errorOf(mixer.Push(0, 0, nil))} {
		if err != mien.ErrClosed {
			t.Fatalf("call %d of a closed object: %v", i, err)
		}
	}
	equal(t, len(face.Joints)+len(body.SkinMatrices)+len(mixer.Row), 0, "elements of closed objects")
	equal(t, living.Joints[0], float32(0), "an instance that is open")
	if mien.OpenObjects() == before {
		t.Fatal("the rig was released before its instance")
	}
	living.Close()
	equal(t, mien.OpenObjects(), before, "open objects")
}

func TestObjectsOfAnotherRig(t *testing.T) {
	rig, deformer := small(t, mien.PresetSmall)
	other, _ := small(t, mien.PresetMedium)
	face, stranger := newFace(t, rig, 0), newFace(t, other, 0)
	body, batch := must(deformer.NewInstance(nil)), must(rig.NewBatch(2))
	defer body.Close()
	defer batch.Close()
	fails(t, body.Update(stranger), mien.StatusMismatch)
	fails(t, batch.Evaluate([]*mien.Instance{face, stranger}, nil, mien.StageAll), mien.StatusMismatch)
	clip := must(mien.BuildClip(mien.ClipDesc{Names: []string{"a"}, Values: []float32{0, 1}}))
	defer clip.Close()
	binding := must(clip.Bind(other, false))
	defer binding.Close()
	mix := must(rig.NewMix(mien.MixDesc{Layers: []mien.MixLayer{{Weight: 1}}}))
	defer mix.Close()
	mixer := must(mix.NewMixer(nil))
	defer mixer.Close()
	fails(t, mixer.Play(0, clip, binding, nil), mien.StatusMismatch)
	fails(t, mixer.Step(1, stranger), mien.StatusMismatch)
	fails(t, binding.Apply([]float32{0}, face), mien.StatusInvalidArgument)
	check(mixer.Step(1, face))
}

func TestIndicesLodsAndSizes(t *testing.T) {
	rig, deformer := small(t, mien.PresetSmall)
	face := newFace(t, rig, 0)
	name := must(rig.Name(mien.KindRawControl, 0))
	fails(t, face.Evaluate(99), mien.StatusLod)
	fails(t, face.Evaluate(-1), mien.StatusLod)
	fails(t, face.EvaluateStages(0, 1<<20), mien.StatusInvalidArgument)
	fails(t, errorOf(rig.Name(mien.KindJoint, 1000000)), mien.StatusIndex)
	fails(t, face.Set("nobody", 1), mien.StatusName)
	fails(t, errorOf(deformer.Mesh(99)), mien.StatusIndex)
	fails(t, errorOf(rig.NewBatch(-1)), mien.StatusInvalidArgument)
	batch := must(rig.NewBatch(2))
	defer batch.Close()
	fails(t, batch.Evaluate(make([]*mien.Instance, 3), nil, mien.StageAll), mien.StatusInvalidArgument)
	fails(t, batch.Evaluate([]*mien.Instance{face}, []int{0, 0}, mien.StageAll), mien.StatusInvalidArgument)
	fails(t, batch.Evaluate([]*mien.Instance{face, face}, nil, mien.StageAll), mien.StatusInvalidArgument)
	equal(t, batch.Evaluate([]*mien.Instance{face, nil}, nil, mien.StageAll), mien.ErrClosed, "a batch with nil")
	check(batch.Evaluate([]*mien.Instance{face}, nil, mien.StageAll))
	body := must(deformer.NewInstance(nil))
	defer body.Close()
	fails(t, body.UpdateFromValues([]float32{1}, nil), mien.StatusInvalidArgument)
	fails(t, body.VerticesTo(0, nil, nil, 12, 10), mien.StatusInvalidArgument)
	fails(t, errorOf(mien.BuildClip(mien.ClipDesc{Names: []string{"a", "b"}, Values: make([]float32, 3)})),
		mien.StatusInvalidArgument)
	clip := must(mien.BuildClip(mien.ClipDesc{Names: []string{"a"}, Values: []float32{0, 1}}))
	defer clip.Close()
	fails(t, errorOf(clip.Read(1, 2)), mien.StatusInvalidArgument)
	fails(t, errorOf(clip.Read(-1, 1)), mien.StatusInvalidArgument)
	mix := must(rig.NewMix(mien.MixDesc{
		Layers: []mien.MixLayer{{Weight: 1, Source: mien.LayerSourceStream, Curves: []string{name}}}}))
	defer mix.Close()
	mixer := must(mix.NewMixer(nil))
	defer mixer.Close()
	fails(t, errorOf(mixer.Push(0, 1, []float32{1, 2})), mien.StatusMismatch)
	fails(t, errorOf(mixer.Push(0, 1, []float32{float32(math.NaN())})), mien.StatusInvalidArgument)
	fails(t, mixer.SetWeight(1, 1, 0), mien.StatusIndex)
	fails(t, errorOf(mixer.Stage(0)), mien.StatusInvalidArgument)
	fails(t, mixer.Restore(make([]byte, 10)), mien.StatusInvalidArgument)
	fails(t, errorOf(mixer.Guard(0)), mien.StatusIndex)
	fails(t, errorOf(rig.NewMix(mien.MixDesc{Layers: []mien.MixLayer{
		{Source: mien.LayerSourcePoses, Poses: []mien.Pose{{"nobody": 1}}}}})), mien.StatusName)
	fails(t, errorOf(rig.NewMix(mien.MixDesc{Lower: []float32{1}})), mien.StatusInvalidArgument)
	fails(t, errorOf(deformer.NewGaze("nobody", "nobody")), mien.StatusName)
	check(face.Evaluate(0))
}

func TestCloseWhileOtherGoroutinesEvaluate(t *testing.T) {
	// A call that began keeps the memory; later ones fail.
	for round := 0; round < 20; round++ {
		rig, _ := small(t, mien.PresetSmall)
		var group sync.WaitGroup
		var started sync.WaitGroup
		for i := 0; i < 2; i++ {
			face := must(rig.NewInstance())
			group.Add(1)
			started.Add(1)
			go func() {
				defer group.Done()
				defer face.Close()
				started.Done()
				for k := 0; k < 1000000; k++ {
					if err := face.Evaluate(0); err != nil {
						if err != mien.ErrClosed {
							t.Error(err)
						}
						return
					}
				}
				t.Error("the rig stayed open")
			}()
		}
		started.Wait()
		rig.Close()
		group.Wait()
	}
}

func TestMixersOfOneMixInManyGoroutines(t *testing.T) {
	rig, _ := small(t, mien.PresetSmall)
	name := must(rig.Name(mien.KindRawControl, 0))
	mix := must(rig.NewMix(mien.MixDesc{
		Layers: []mien.MixLayer{{Weight: 1, Source: mien.LayerSourceStream, Curves: []string{name}}}}))
	defer mix.Close()
	var group sync.WaitGroup
	rows := make([][]float32, 4)
	for i := range rows {
		group.Add(1)
		go func(i int) {
			defer group.Done()
			mixer, face := must(mix.NewMixer(nil)), must(rig.NewInstance())
			defer mixer.Close()
			defer face.Close()
			for tick := int64(1); tick < 100; tick++ {
				must(mixer.Push(0, tick*1000, []float32{0.5}))
				check(mixer.Step(1000, face))
				check(face.Evaluate(0))
			}
			rows[i] = append([]float32(nil), face.Joints...)
		}(i)
	}
	group.Wait()
	for _, row := range rows[1:] {
		equal(t, row, rows[0], "joints")
	}
}
