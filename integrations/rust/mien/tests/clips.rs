// SPDX-License-Identifier: MIT
//! Clips: built, opened, read, played, bound to a rig.

use mien::{
    Clip, ClipEvent, ClipOptions, Dna, Interpolation, Kind, Looping, Preset, Rig, Status,
    TICKS_PER_SECOND,
};
use std::io::Cursor;

const NAMES: [&str; 3] = ["jawOpen", "nobody", "joy"];
const ROWS: [f32; 9] = [0.0, 1.0, 0.25, 0.5, 1.0, 0.75, 0.75, 1.0, 0.1];
const FRAME: i64 = TICKS_PER_SECOND / 60;

fn built() -> Clip {
    ClipOptions::new(&NAMES).build(&ROWS).unwrap()
}

#[test]
fn rows_come_back() {
    let clip = ClipOptions::new(&NAMES).rate(30000, 1001).build(&ROWS).unwrap();
    assert_eq!((clip.info().rate_numerator, clip.info().frame_count), (30000, 3));
    assert_eq!(clip.read(0, 3).unwrap(), ROWS);
    assert_eq!(clip.read(1, 1).unwrap(), ROWS[3..6]);
    assert_eq!(clip.find("joy").unwrap(), 2);
    let channel = clip.channel(1).unwrap();
    assert_eq!((channel.name.as_ref(), channel.rest, channel.is_changing), ("nobody", 1.0, false));
    clip.verify().unwrap();
    let bytes = clip.to_bytes().unwrap();
    let again = Clip::from_reader(&mut Cursor::new(&bytes)).unwrap();
    assert_eq!(again.read(0, 3).unwrap(), ROWS);
    assert_eq!(again.to_bytes().unwrap(), bytes);

    let path = std::env::temp_dir().join(format!("mien-{}.clip", std::process::id()));
    clip.save(&path).unwrap();
    let read = Clip::open(&path).unwrap();
    // SAFETY: nobody else knows of the file.
    let mapped = unsafe { Clip::map(&path) }.unwrap();
    assert!(mapped.info().is_mapped && !read.info().is_mapped);
    assert_eq!(mapped.to_bytes().unwrap(), read.to_bytes().unwrap());
    drop((read, mapped));
    std::fs::remove_file(&path).unwrap();
    assert_eq!(Clip::open(&path).unwrap_err().status(), Status::FILE_OPEN);
}

#[test]
fn choices_are_kept() {
    let steps = [0.0, 0.0, 1.0 / 1024.0];
    let options = ClipOptions::new(&NAMES).looping(Looping::WRAP).is_delta(true);
    let clip = options.clone().snap(1.0 / 512.0).build(&ROWS).unwrap();
    assert_eq!((clip.info().snap, clip.info().looping), (1.0 / 512.0, Looping::WRAP));
    assert!(clip.info().is_delta && clip.channel(2).unwrap().max_error > 0.0);
    assert_eq!(options.snaps(&steps).build(&ROWS).unwrap().info().snap, 1.0 / 1024.0);
}

#[test]
fn what_is_wrong_is_refused() {
    let status =
        |options: ClipOptions<'_>, values: &[f32]| options.build(values).unwrap_err().status();
    let plain = || ClipOptions::new(&NAMES);
    assert_eq!(status(plain(), &ROWS[..4]), Status::INVALID_ARGUMENT);
    assert_eq!(status(plain(), &[]), Status::INVALID_ARGUMENT);
    assert_eq!(status(plain().rate(0, 1), &ROWS), Status::INVALID_ARGUMENT);
    assert_eq!(status(plain().snap(0.1), &ROWS), Status::INVALID_ARGUMENT);
    assert_eq!(status(plain().snaps(&[0.0]), &ROWS), Status::INVALID_ARGUMENT);
    assert_eq!(status(plain(), &[f32::NAN; 3]), Status::CLIP_VALUE);
    assert_eq!(status(ClipOptions::new(&["a", "a", "b"]), &ROWS), Status::NAME);
    let late = [ClipEvent { tick: 3 * FRAME, name: "late".into(), value: 0.0 }];
    assert_eq!(status(plain().events(&late), &ROWS), Status::INVALID_ARGUMENT);

    let clip = built();
    assert_eq!(clip.read(0, 4).unwrap_err().status(), Status::INDEX);
    assert_eq!(clip.read(4, 0).unwrap_err().status(), Status::INDEX);
    assert_eq!(clip.channel(3).unwrap_err().status(), Status::INDEX);
    assert_eq!(clip.event(0).unwrap_err().status(), Status::INDEX);
    assert_eq!(clip.find("none").unwrap_err().status(), Status::NAME);
    assert_eq!(Clip::from_static(b"no clip").unwrap_err().status(), Status::CLIP_SIGNATURE);
    let mut damaged = clip.to_bytes().unwrap();
    let at = damaged.len() - 20;
    damaged[at] ^= 255;
    let opened = Clip::from_reader(&mut Cursor::new(&damaged)).unwrap();
    assert_eq!(opened.verify().unwrap_err().status(), Status::CLIP_CHECKSUM);
}

#[test]
fn players_go_on_without_their_clip() {
    let events = [
        ClipEvent { tick: 2 * FRAME, name: "end".into(), value: 0.5 },
        ClipEvent { tick: 0, name: "start".into(), value: 1.0 },
    ];
    let clip = ClipOptions::new(&NAMES).events(&events).build(&ROWS).unwrap();
    assert_eq!(clip.event(0).unwrap(), events[1]);
    let mut player = clip.player().unwrap();
    let mut backward = clip.player_with(Looping::WRAP, Interpolation::STEP, true).unwrap();
    drop(clip);
    assert_eq!(player.sample(), &ROWS[..3]);
    assert_eq!(player.next_event(), None);
    player.advance(FRAME / 2).unwrap();
    assert_eq!(player.sample(), [0.25, 1.0, 0.5]);
    assert_eq!(player.next_event().as_ref(), Some(&events[1]));
    assert_eq!(player.next_event(), None);
    player.seek(i64::MAX).unwrap();
    assert_eq!(player.info().tick, 2 * FRAME);
    backward.set_speed(-1, 2).unwrap();
    backward.advance(FRAME).unwrap();
    assert_eq!(backward.sample(), &ROWS[6..]);
    assert_eq!(backward.info().loops, -1);
    assert_eq!(backward.set_speed(1, 0).unwrap_err().status(), Status::INVALID_ARGUMENT);
    assert_eq!(backward.advance(i64::MAX).unwrap_err().status(), Status::INVALID_ARGUMENT);
}

#[test]
fn bindings_drive_controls() {
    let rig = Rig::new(&Dna::generate(Preset::HEAD).unwrap()).unwrap();
    let matrix = [("joy", "mouthSmileLeft", 0.5), ("grief", "jawOpen", 1.0)];
    let binding = built().bind(&rig, &matrix).unwrap();
    assert_eq!(binding.missing_channels(), [1]);
    assert_eq!(binding.missing_entry_count(), 1);
    let mut face = rig.instance().unwrap();
    let count = face.raw_controls().len();
    assert_eq!(binding.controls().len() + binding.extra_controls().len(), count);
    binding.apply(&ROWS[3..6], face.raw_controls_mut()).unwrap();
    let value = |name| face.raw_controls()[rig.find(Kind::RAW_CONTROL, name).unwrap()];
    assert_eq!((value("jawOpen"), value("mouthSmileLeft")), (0.5, 0.375));
    let wrong = binding.apply(&ROWS, &mut [0.0; 3]).unwrap_err();
    assert_eq!(wrong.status(), Status::INVALID_ARGUMENT);
    let nan = [("joy", "jawOpen", f32::NAN)];
    assert_eq!(built().bind(&rig, &nan).unwrap_err().status(), Status::INVALID_ARGUMENT);
}
