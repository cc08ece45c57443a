// SPDX-License-Identifier: MIT
//! Memory comes from the allocator that was given, goes back to it, and may be refused.

use mien::{
    Allocator, Batch, DeformerInstance, DeformerInstanceOptions, DeformerOptions, Dna,
    GenerateOptions, Instance, Normals, OpenOptions, Preset, Report, Result, RigOptions, Status,
};
use std::alloc::{GlobalAlloc, Layout, System};
use std::collections::HashMap;
use std::sync::{Arc, Mutex};

/// Passes on to the system, remembers each block, refuses after so many.
struct Watched(Arc<Mutex<Book>>);

#[derive(Default)]
struct Book {
    blocks: HashMap<usize, Layout>,
    requests: usize,
    allowed: usize,
}

unsafe impl GlobalAlloc for Watched {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let mut book = self.0.lock().unwrap();
        book.requests += 1;
        if book.requests > book.allowed {
            return std::ptr::null_mut();
        }
        let block = System.alloc(layout);
        assert_eq!(block as usize % layout.align(), 0);
        book.blocks.insert(block as usize, layout);
        block
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        let known = self.0.lock().unwrap().blocks.remove(&(block as usize));
        assert_eq!(known, Some(layout), "given back as it was asked for");
        System.dealloc(block, layout);
    }
}

fn watched(allowed: usize) -> (Allocator, Arc<Mutex<Book>>) {
    let book = Arc::new(Mutex::new(Book { allowed, ..Default::default() }));
    (Allocator::new(Watched(book.clone())), book)
}

/// Everything that takes an allocator, once.
fn live(file: &[u8], memory: &Allocator) -> Result<(Instance, DeformerInstance)> {
    GenerateOptions::new().allocator(memory).generate()?;
    Report::of_bytes_in(file, memory)?;
    let dna = OpenOptions::new().allocator(memory).open_bytes(file)?;
    let rig = RigOptions::new().allocator(memory).create(&dna)?;
    let mut face = Instance::new_in(&rig, memory)?;
    Batch::new_in(&rig, 3, 2, memory)?.evaluate([&mut face], 0)?;
    let deformer = DeformerOptions::new().allocator(memory).create(&dna, &rig)?;
    let mut pose = DeformerInstanceOptions::new().allocator(memory).create(&deformer)?;
    pose.update(&face)?;
    pose.deform(0, Normals::RECOMPUTED)?;
    Ok((face, pose))
}

#[test]
fn all_of_it_is_given_back() {
    let file = Dna::generate(Preset::TINY).unwrap().to_bytes().unwrap();
    let (memory, book) = watched(usize::MAX);
    let (mut face, mut pose) = live(&file, &memory).unwrap();
    // The allocator lives as long as what was made with it.
    drop(memory);
    {
        let book = book.lock().unwrap();
        let bytes: usize = book.blocks.values().map(Layout::size).sum();
        let info = face.rig().info();
        let deformer = pose.deformer().info();
        let expected =
            [info.rig_bytes, info.instance_bytes, deformer.deformer_bytes, deformer.instance_bytes];
        assert_eq!(bytes as u64, expected.iter().sum::<u64>());
    }
    let requests = book.lock().unwrap().requests;
    face.evaluate(0).unwrap();
    pose.update(&face).unwrap();
    pose.deform(0, Normals::SKINNED).unwrap();
    assert_eq!(book.lock().unwrap().requests, requests, "frames take no memory");
    // On another thread, too.
    drop(face);
    assert!(!book.lock().unwrap().blocks.is_empty(), "a pose needs its rig");
    std::thread::spawn(move || drop(pose)).join().unwrap();
    assert!(book.lock().unwrap().blocks.is_empty());
    assert_eq!(Arc::strong_count(&book), 1, "the allocator is gone");
}

#[test]
fn what_is_refused_is_an_error() {
    let file = Dna::generate(Preset::TINY).unwrap().to_bytes().unwrap();
    let mut allowed = 0;
    loop {
        let (memory, book) = watched(allowed);
        let result = live(&file, &memory);
        match result {
            Ok(_) => break,
            Err(error) => assert_eq!(error.status(), Status::MEMORY, "request {allowed}: {error}"),
        }
        assert!(book.lock().unwrap().blocks.is_empty(), "request {allowed}");
        allowed += 1;
    }
    assert!(allowed > 5);
}
