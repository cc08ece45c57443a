// SPDX-License-Identifier: MIT

// mix: a head speaks, is glad, and closes its eyes when a flashlight hits them.
package main

import (
	"fmt"
	"log"
	"mien"
	"mien/author"
)

// must is for an example; a program handles errors.
func must[T any](value T, err error) T {
	check(err)
	return value
}

func check(err error) {
	if err != nil {
		log.Fatal(err)
	}
}

func main() {
	dna := must(author.Generate(mien.PresetHead, 0, 0))
	rig := must(mien.NewRig(dna, nil))
	defer rig.Close()
	deformer := must(mien.NewDeformer(dna, rig, nil))
	defer deformer.Close()
	dna.Close()
	face := must(rig.NewInstance())
	defer face.Close()

	// Speech: the jaw at 60 frames a second, closed for every m of "mama mama".
	jaw := make([]float32, 180)
	for i := range jaw {
		if phase := i % 30; phase >= 8 {
			jaw[i] = float32((phase-8)*(29-phase)) / 220
		}
	}
	speech := must(mien.BuildClip(mien.ClipDesc{Names: []string{"jawOpen"}, Values: jaw}))
	defer speech.Close()
	binding := must(speech.Bind(rig, false))
	defer binding.Close()

	// Joy over it, held back where it would part the lips; the flashlight acts last.
	joy := mien.Pose{"jawOpen": 0.2, "mouthSmileLeft": 0.9, "mouthSmileRight": 0.9, "cheekSquintLeft": 0.6,
		"cheekSquintRight": 0.6}
	flashlight := mien.MixReaction{
		Strokes: []mien.MixStroke{
			{Pose: mien.Pose{"eyeBlinkLeft": 1, "eyeBlinkRight": 1}, Mode: mien.BlendModeMax, Delay: mien.Ticks(0.06),
				Attack: mien.Ticks(0.07), Hold: mien.Ticks(0.06), Release: mien.Ticks(0.22)},
			{Pose: mien.Pose{"eyeSquintLeft": 0.8, "eyeSquintRight": 0.8}, Mode: mien.BlendModeScreen,
				Delay: mien.Ticks(0.09), Attack: mien.Ticks(0.15), Release: mien.Ticks(0.4), IsHeld: true},
		},
		Cooldown: mien.Ticks(0.25), Adapted: 0.6, AdaptTicks: mien.Ticks(1.5), RecoverTicks: mien.Ticks(1.5),
	}
	mix := must(rig.NewMix(mien.MixDesc{
		Layers: []mien.MixLayer{
			{Source: mien.LayerSourceClip, Group: mien.LayerGroupSpeech, Weight: 1},
			{Source: mien.LayerSourcePoses, Group: mien.LayerGroupEmotion, Mode: mien.BlendModeScreen, Weight: 1,
				Poses: []mien.Pose{joy}},
		},
		Reactions: []mien.MixReaction{flashlight}, Guards: mien.GuardLips, Deformer: deformer,
	}))
	defer mix.Close()
	mixer := must(mix.NewMixer(nil))
	defer mixer.Close()
	check(mixer.Play(0, speech, binding, &mien.PlayDesc{TransitionTicks: mien.Ticks(0.1)}))
	check(mixer.SetPoseWeight(1, 0, 0.8, mien.Ticks(0.5)))
	for i := 1; i <= 150; i++ {
		if i == 90 {
			check(mixer.Trigger(0, 1, mien.Ticks(0.6)))
		}
		check(mixer.Step(mien.TicksPerSecond/60, face)) // writes the raw controls of the face
		check(face.Evaluate(0))
		if i%10 != 0 {
			continue
		}
		most := face.Joints[0]
		for _, value := range face.Joints {
			if value > most {
				most = value
			}
		}
		fmt.Printf("%3d  jaw %.4f  smile %.4f  lids %.4f  squint %.4f  joints up to %.3f\n", i, must(face.Get("jawOpen")),
			must(face.Get("mouthSmileLeft")), must(face.Get("eyeBlinkLeft")), must(face.Get("eyeSquintLeft")), most)
	}
}
