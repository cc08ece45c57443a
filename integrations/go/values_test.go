// SPDX-License-Identifier: MIT

package mien_test

import (
	"math"
	"mien"
	"mien/author"
	"os"
	"path/filepath"
	"reflect"
	"strings"
	"testing"
	"unsafe"
)

func must[T any](value T, err error) T {
	check(err)
	return value
}

func check(err error) {
	if err != nil {
		panic(err)
	}
}

func equal(t *testing.T, got, expected any, what string) {
	t.Helper()
	if !reflect.DeepEqual(got, expected) {
		t.Fatalf("%s is %v, not %v", what, got, expected)
	}
}

// small returns a rig and its deformer, which the test closes.
func small(t *testing.T, preset mien.Preset) (*mien.Rig, *mien.Deformer) {
	dna := must(author.Generate(preset, 5, 0))
	defer dna.Close()
	rig := must(mien.NewRig(dna, nil))
	deformer := must(mien.NewDeformer(dna, rig, nil))
	t.Cleanup(deformer.Close)
	t.Cleanup(rig.Close)
	return rig, deformer
}

func newFace(t *testing.T, rig *mien.Rig, seed int) *mien.Instance {
	face := must(rig.NewInstance())
	t.Cleanup(face.Close)
	setControls(face, seed)
	return face
}

// setControls gives the raw controls different values.
func setControls(face *mien.Instance, seed int) {
	for i := range face.RawControls {
		face.RawControls[i] = float32((i*7+seed*5)%11) / 10
	}
}

func TestStructsHaveTheSizesOfTheHeader(t *testing.T) {
	if len(mien.StructSizes()) < 30 {
		t.Fatal("there are few structs")
	}
	for i, sizes := range mien.StructSizes() {
		equal(t, sizes[0], sizes[1], "size of struct "+string(rune('0'+i)))
	}
}

func TestBatchAndBakedFilesGiveTheBitsOfEvaluate(t *testing.T) {
	rig, deformer := small(t, mien.PresetSmall)
	baked := must(mien.OpenBakedBytes(must(rig.BakeBytes(deformer)), nil))
	same := must(baked.Rig(nil))
	baked.Close()
	defer same.Close()
	batch := must(rig.NewBatch(4))
	defer batch.Close()
	var faces []*mien.Instance
	for i := 0; i < 3; i++ {
		faces = append(faces, newFace(t, rig, i))
	}
	check(batch.Evaluate(faces, nil, mien.StageAll))
	for i := range faces {
		again, other := newFace(t, rig, i), newFace(t, same, i)
		check(again.Evaluate(0))
		check(other.Evaluate(0))
		equal(t, faces[i].Joints, again.Joints, "joints of the batch")
		equal(t, faces[i].BlendShapes, again.BlendShapes, "blend shapes of the batch")
		equal(t, other.Joints, again.Joints, "joints of the baked rig")
	}
	if reflect.DeepEqual(faces[0].Joints, faces[1].Joints) {
		t.Fatal("different controls gave the same joints")
	}
}

func TestBatchesTakeOneLodPerInstance(t *testing.T) {
	rig, _ := small(t, mien.PresetMedium)
	last := int(must(rig.Info()).LodCount) - 1
	batch := must(rig.NewBatch(2))
	defer batch.Close()
	faces := []*mien.Instance{newFace(t, rig, 1), newFace(t, rig, 2)}
	check(batch.Evaluate(faces, []int{0, last}, mien.StageAll))
	for i, lod := range []int{0, last} {
		again := newFace(t, rig, i+1)
		check(again.Evaluate(lod))
		equal(t, faces[i].Joints, again.Joints, "joints")
	}
}

func TestADnaFileSurvivesMemoryAndDisk(t *testing.T) {
	dna := must(author.Generate(mien.PresetSmall, 5, 0))
	defer dna.Close()
	bytes, path := must(dna.Bytes(nil)), filepath.Join(t.TempDir(), "head.dna")
	check(dna.Save(path, nil))
	equal(t, must(os.ReadFile(path)), bytes, "file")
	again := must(mien.OpenDna(path, &mien.DnaOptions{FileAccess: mien.FileAccessRead}))
	defer again.Close()
	equal(t, must(again.Bytes(nil)), bytes, "bytes")
	meters := must(mien.OpenDnaBytes(bytes, &mien.DnaOptions{System: "unity"}))
	defer meters.Close()
	equal(t, must(meters.Info()).TranslationUnit, mien.TranslationUnitMeters, "unit")
	info := must(dna.Info())
	equal(t, must(dna.Field("defn.jointNames")).Count, uint64(info.JointCount), "names")
	equal(t, must(dna.ReadIntegers("desc.lodCount")), []int64{int64(info.LodCount)}, "LODs")
	equal(t, len(must(dna.ReadFloats("defn.neutralJointTranslations.xs"))), int(info.JointCount), "translations")
	rig := must(mien.NewRig(dna, nil))
	defer rig.Close()
	equal(t, must(dna.ReadString("defn.jointNames[0]")), must(rig.Name(mien.KindJoint, 0)), "name")
}

func TestNamesAndIndicesAreInverse(t *testing.T) {
	rig, _ := small(t, mien.PresetSmall)
	for _, kind := range []mien.Kind{mien.KindRawControl, mien.KindJoint} {
		for i := 0; i < rig.Count(kind); i++ {
			equal(t, must(rig.Find(kind, must(rig.Name(kind, i)))), i, "index")
		}
	}
	equal(t, len(must(rig.JointParents())), rig.Count(mien.KindJoint), "parents")
	face := newFace(t, rig, 0)
	check(face.Set(must(rig.Name(mien.KindRawControl, 2)), 0.25))
	equal(t, face.RawControls[2], float32(0.25), "control")
}

func TestTheDeformerMovesWhatJointsMove(t *testing.T) {
	rig, deformer := small(t, mien.PresetSmall)
	face, mesh := newFace(t, rig, 1), must(deformer.Mesh(0))
	equal(t, must(deformer.Triangles(0)), mesh.Triangles, "triangles")
	equal(t, must(deformer.TextureCoordinates(0)), mesh.TextureCoordinates, "texture coordinates")
	body := must(deformer.NewInstance(nil))
	defer body.Close()
	check(face.Evaluate(0))
	check(body.Update(face))
	check(body.Deform(0, mien.NormalsDefault))
	positions := must(body.Positions(0))
	equal(t, len(positions), 3*mesh.PositionCount, "numbers")
	farthest := 0.0
	for i := range positions {
		farthest = math.Max(farthest, math.Abs(float64(positions[i]-mesh.Positions[i])))
	}
	if farthest < 0.01 {
		t.Fatal("nothing moved")
	}
	matrices := append([]float32(nil), body.SkinMatrices...)
	equal(t, len(matrices), 16*rig.Count(mien.KindJoint), "matrices")
	check(body.UpdateFromValues(face.Joints, face.BlendShapes))
	equal(t, body.SkinMatrices, matrices, "matrices from values")
	// VerticesTo writes to memory of C, here that of a second instance.
	other := must(deformer.NewInstance(nil))
	defer other.Close()
	memory := must(other.Positions(0))
	if mesh.VertexCount == mesh.PositionCount {
		check(body.VerticesTo(0, unsafe.Pointer(&memory[0]), nil, 12, mesh.VertexCount))
		for i, position := range mesh.VertexPositionIndices {
			equal(t, memory[3*i:3*i+3], positions[3*position:3*position+3], "vertex")
		}
	}
}

func TestClipsKeepEveryBitPlayAndDriveTheControlsTheyName(t *testing.T) {
	rig, _ := small(t, mien.PresetSmall)
	values := make([]float32, 200)
	for i := range values {
		values[i] = float32(i) / 300
	}
	clip := must(mien.BuildClip(mien.ClipDesc{Names: []string{must(rig.Name(mien.KindRawControl, 1)), "nobody"},
		Values: values, RateNumerator: 30, RateDenominator: 1,
		Events: []mien.ClipEvent{{Tick: mien.Ticks(0.5), Name: "step", Value: 2}}}))
	defer clip.Close()
	equal(t, must(clip.Read(0, 100)), values, "values")
	path := filepath.Join(t.TempDir(), "a.clip")
	check(clip.Save(path))
	opened := must(mien.OpenClip(path, nil))
	equal(t, must(opened.Bytes()), must(clip.Bytes()), "bytes")
	opened.Close()
	opened = must(mien.OpenClipBytes(must(clip.Bytes()), nil))
	player := must(opened.NewPlayer(nil))
	defer player.Close()
	opened.Close()
	check(player.Advance(mien.Ticks(1)))
	event, found, err := player.NextEvent()
	check(err)
	equal(t, found, true, "event")
	equal(t, event, mien.ClipEvent{Tick: mien.Ticks(0.5), Name: "step", Value: 2}, "event")
	_, found, _ = player.NextEvent()
	equal(t, found, false, "a second event")
	equal(t, must(player.Sample())[0], values[60], "frame 30")
	binding := must(clip.Bind(rig, true))
	defer binding.Close()
	face := must(rig.NewInstance())
	defer face.Close()
	check(binding.Apply(must(player.Sample()), face))
	equal(t, face.RawControls[1], values[60], "control")
	equal(t, face.RawControls[2], float32(0), "another control")
	_, _, missing, err := binding.Found()
	check(err)
	equal(t, missing, []uint16{1}, "missing channels")
	check(player.SetSpeed(2, 1))
	check(player.SeekTo(0))
	check(player.Advance(mien.Ticks(1)))
	equal(t, must(player.Info()).Tick, mien.Ticks(2), "tick")
}

func TestAMixOpensAgainItsMixerRestoresAndEventsArrive(t *testing.T) {
	rig, _ := small(t, mien.PresetSmall)
	name, other := must(rig.Name(mien.KindRawControl, 0)), must(rig.Name(mien.KindRawControl, 1))
	mix := must(rig.NewMix(mien.MixDesc{Variables: []string{"surprise"}, Layers: []mien.MixLayer{
		{Weight: 1, Mask: mien.Pose{name: 1, other: 0.5, "surprise": 1}},
		{Weight: 1, Source: mien.LayerSourcePoses, Group: mien.LayerGroupEmotion, Mode: mien.BlendModeAdd,
			Poses: []mien.Pose{{other: 0.25}}},
		{Weight: 1, Source: mien.LayerSourceStream, Group: mien.LayerGroupEmotion, Mode: mien.BlendModeAdd,
			Curves: []string{"surprise"}}}}))
	defer mix.Close()
	again := must(mien.OpenMixBytes(must(mix.Bytes()), rig))
	equal(t, must(again.Bytes()), must(mix.Bytes()), "bytes")
	again.Close()
	if !strings.Contains(must(mix.Text()), name) {
		t.Fatal("the text has no name")
	}
	clip := must(mien.BuildClip(mien.ClipDesc{Names: []string{name, other}, Values: []float32{0.5, 0.5, 0.5, 0.5},
		Looping: mien.LoopingClamp, Events: []mien.ClipEvent{{Tick: 100, Name: "now", Value: 3}}}))
	binding := must(clip.Bind(rig, false))
	mixer, face := must(mix.NewMixer(nil)), newFace(t, rig, 0)
	defer mixer.Close()
	check(mixer.Play(0, clip, binding, &mien.PlayDesc{ClipId: 7, Transition: mien.TransitionCut}))
	check(mixer.SetPoseWeight(1, 0, 1, 0))
	equal(t, must(mixer.Push(2, 1, []float32{0.75})), true, "first row")
	equal(t, must(mixer.Push(2, 1, []float32{0.75})), false, "a row that is not newer")
	const frame = mien.TicksPerSecond / 60
	check(mixer.Step(frame, face))
	event, layer, err := mixer.Event(0)
	check(err)
	equal(t, event, mien.ClipEvent{Tick: 100, Name: "now", Value: 3}, "event")
	equal(t, layer, 0, "layer")
	equal(t, face.RawControls[:2], []float32{0.5, 0.5}, "controls")
	snapshot := must(mixer.Snapshot())
	twin := must(mix.NewMixer(nil))
	defer twin.Close()
	fails(t, twin.Restore(snapshot), mien.StatusMismatch) // without the clip
	check(twin.Restore(snapshot, mien.MixerClip{ClipId: 7, Clip: clip, Binding: binding}))
	clip.Close() // the mixers keep them
	binding.Close()
	before := mixer.Row[1]
	for _, one := range []*mien.Mixer{mixer, twin} {
		check(one.SetPoseWeight(1, 0, 0, 5*frame))
		for i := 0; i < 4; i++ {
			check(one.Step(frame, nil))
		}
	}
	equal(t, twin.Row[:len(face.RawControls)], mixer.Row[:len(face.RawControls)], "row after Restore")
	if !(mixer.Row[1] < before) {
		t.Fatal("the pose does not fade")
	}
}

func TestTablesMeasuredOnTheGeneratedHead(t *testing.T) {
	rig, deformer := small(t, mien.PresetHead)
	left, right := must(rig.Find(mien.KindRawControl, "eyeBlinkLeft")), must(rig.Find(mien.KindRawControl, "eyeBlinkRight"))
	shares, match, err := rig.Match("eyeBlink_L")
	check(err)
	equal(t, shares, []mien.ControlShare{{Control: uint32(left), Weight: 1}}, "controls")
	equal(t, match, mien.NameMatchSpelling, "match")
	face := must(rig.NewInstance())
	defer face.Close()
	mirror := must(deformer.Mirror(len(face.RawControls)))
	equal(t, int(mirror[left]), right, "counterpart")
	gaze := must(deformer.NewGaze("", ""))
	defer gaze.Close()
	restLeft, _, err := gaze.LookAt(5000, 0, 1000, face)
	check(err)
	if restLeft <= 0 {
		t.Fatal("the eyes reach a target far to the side")
	}
	if info := must(gaze.Info()); info.LeftEye[0] <= info.RightEye[0] {
		t.Fatal("the left eye is not on the left")
	}
	clip := must(mien.BuildClip(mien.ClipDesc{Names: []string{"eyeBlinkLeft"}, Values: []float32{0.5, 0.5},
		Looping: mien.LoopingClamp}))
	defer clip.Close()
	binding := must(clip.Bind(rig, false))
	defer binding.Close()
	mix := must(rig.NewMix(mien.MixDesc{Layers: []mien.MixLayer{{Weight: 1, Group: mien.LayerGroupSpeech}},
		Mirror: mirror, Gaze: gaze, Antagonists: must(rig.Antagonists()), Guards: mien.GuardLips, Deformer: deformer}))
	defer mix.Close()
	mixer := must(mix.NewMixer(&mien.MixerDesc{Stages: 1}))
	defer mixer.Close()
	check(mixer.Play(0, clip, binding, &mien.PlayDesc{Transition: mien.TransitionCut, Mirrored: 1}))
	check(mixer.Step(1, nil))
	equal(t, mixer.Row[right], float32(0.5), "the other eye")
	equal(t, must(mixer.Stage(0))[right], float32(0.5), "the first stage")
	guard := must(mixer.Guard(0))
	equal(t, guard.Kind, mien.GuardLips, "kind")
	if guard.Name == "" || len(guard.Controls) == 0 {
		t.Fatal("the guard has no name or controls")
	}
}

func TestFramesAllocateNothing(t *testing.T) {
	rig, deformer := small(t, mien.PresetSmall)
	name := must(rig.Name(mien.KindRawControl, 0))
	face := newFace(t, rig, 0)
	faces := []*mien.Instance{newFace(t, rig, 1), newFace(t, rig, 2)}
	body, batch := must(deformer.NewInstance(nil)), must(rig.NewBatch(2))
	defer body.Close()
	defer batch.Close()
	mix := must(rig.NewMix(mien.MixDesc{Layers: []mien.MixLayer{{Weight: 1},
		{Weight: 1, Source: mien.LayerSourcePoses, Poses: []mien.Pose{{name: 1}}},
		{Weight: 1, Source: mien.LayerSourceStream, Curves: []string{name}}}}))
	defer mix.Close()
	mixer := must(mix.NewMixer(nil))
	defer mixer.Close()
	clip := must(mien.BuildClip(mien.ClipDesc{Names: []string{name}, Values: make([]float32, 100)}))
	defer clip.Close()
	binding, player := must(clip.Bind(rig, false)), must(clip.NewPlayer(nil))
	defer binding.Close()
	defer player.Close()
	row, tick := make([]float32, 1), int64(0)
	allocations := testing.AllocsPerRun(200, func() {
		tick++
		check(mixer.Play(0, clip, binding, nil))
		check(mixer.SetPoseWeight(1, 0, float32(tick%2), 100))
		must(mixer.Push(2, tick, row))
		check(mixer.Step(mien.TicksPerSecond/60, face))
		check(face.Evaluate(0))
		check(batch.Evaluate(faces, nil, mien.StageAll))
		check(player.Advance(1000))
		check(binding.Apply(must(player.Sample()), face))
		check(body.Update(face))
		check(body.Deform(0, mien.NormalsDefault))
	})
	equal(t, allocations, 0.0, "allocations of a frame")
}
