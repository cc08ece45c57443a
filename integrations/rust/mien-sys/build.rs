// SPDX-License-Identifier: MIT
//! Finds libmien, libmien-author and libmien-solve: built here with the feature `vendored`, else in `MIEN_LIB_DIR` if that
//! is set, else by pkg-config. Documentation is made without them.
//!
//! Crates that depend on this one directly learn from `DEP_MIEN_LIB_DIR` where they are, if that is no
//! place where the dynamic linker looks by itself.

use std::env;
use std::path::Path;
use std::process::{exit, Command};

/// In the order in which linkers need them.
const LIBRARIES: [&str; 3] = ["mien-solve", "mien-author", "mien"];

fn main() {
    for variable in ["MIEN_LIB_DIR", "MIEN_STATIC", "PKG_CONFIG", "PKG_CONFIG_PATH"] {
        println!("cargo:rerun-if-env-changed={}", variable);
    }
    println!("cargo:rerun-if-changed=build.rs");

    // Documentation needs no library, and Miri (which links nothing) brings its own functions. cargo does
    // not tell build scripts that it only documents, so MIEN_DOCS=1 does.
    println!("cargo:rerun-if-env-changed=MIEN_DOCS");
    for variable in ["DOCS_RS", "MIEN_DOCS", "CARGO_CFG_MIRI"] {
        if env::var_os(variable).is_some() {
            return;
        }
    }
    if env::var_os("CARGO_FEATURE_VENDORED").is_some() {
        link_statically(&build_vendored());
        return;
    }

    let feature = env::var_os("CARGO_FEATURE_STATIC").is_some();
    let statically = feature || matches!(env::var("MIEN_STATIC").as_deref(), Ok("1"));
    match env::var("MIEN_LIB_DIR") {
        Ok(directory) if !directory.is_empty() => link_directory(&directory, statically),
        _ => link_by_pkg_config(statically),
    }
}

/// Builds the static libraries with CMake in cargo's output directory; returns where they are.
fn build_vendored() -> String {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
    if !sources.join("capi/include/mien.h").exists() {
        fail("the feature `vendored` needs the sources of the repository around the crate");
    }
    let build = format!("{}/mien", env::var("OUT_DIR").expect("cargo sets it"));
    let run = |arguments: &[&str]| match Command::new("cmake").args(arguments).status() {
        Ok(status) if status.success() => {}
        Ok(status) => fail(&format!("cmake {}: {}", arguments.join(" "), status)),
        Err(error) => fail(&format!("cmake cannot be run: {}", error)),
    };
    let sources = sources.display().to_string();
    run(&[
        "-S",
        &sources,
        "-B",
        &build,
        "-DCMAKE_BUILD_TYPE=Release",
        "-DMIEN_BUILD_CLI=OFF",
        "-DMIEN_BUILD_TESTS=OFF",
        "-DMIEN_BUILD_BENCH=OFF",
    ]);
    let targets = ["mien_author_static", "mien_solve_static"];
    run(&["--build", &build, "--parallel", "--target", targets[0], targets[1]]);
    for room in ["author", "capi", "runtime", "simd", "solve"] {
        println!("cargo:rerun-if-changed={}/{}", sources, room);
    }
    format!("{}/lib", build)
}

fn link_directory(directory: &str, statically: bool) {
    for library in LIBRARIES {
        let (lib, archive) = (format!("{}.lib", library), format!("lib{}.a", library));
        let names = match (statically, target("OS").as_str(), target("ENV").as_str()) {
            (_, "windows", "msvc") => vec![lib],
            (true, ..) => vec![archive],
            (false, "windows", _) => vec![format!("lib{}.dll.a", library), lib],
            (false, "macos", _) => vec![format!("lib{}.dylib", library)],
            (false, ..) => vec![format!("lib{}.so", library)],
        };
        if !names.iter().any(|name| Path::new(directory).join(name).exists()) {
            fail(&format!("there is no {} in MIEN_LIB_DIR={}", names[0], directory));
        }
    }
    // Relative to where cargo was called, which is not where the linker works.
    let directory = match Path::new(directory).canonicalize() {
        Ok(path) => path.display().to_string(),
        Err(error) => fail(&format!("MIEN_LIB_DIR={}: {}", directory, error)),
    };
    if statically {
        link_statically(&directory);
    } else {
        println!("cargo:rustc-link-search=native={}", directory);
        println!("cargo:lib_dir={}", directory);
        link("dylib");
    }
}

fn link_by_pkg_config(statically: bool) {
    let program = env::var("PKG_CONFIG").unwrap_or_else(|_| "pkg-config".into());
    let ask = |arguments: &[&str]| {
        let output = Command::new(&program).args(arguments).output();
        match output {
            Ok(output) if output.status.success() => {
                String::from_utf8_lossy(&output.stdout).trim().to_string()
            }
            Ok(output) => fail(String::from_utf8_lossy(&output.stderr).trim()),
            Err(error) => fail(&format!("{} cannot be run: {}", program, error)),
        }
    };
    let flags = ask(&["--libs-only-L", "mien-author >= 0.1", "mien-solve >= 0.1"]);
    if statically {
        link_statically(&ask(&["--variable=libdir", "mien-solve"]));
        return;
    }
    for flag in flags.split_whitespace() {
        let directory = flag.trim_start_matches("-L");
        println!("cargo:rustc-link-search=native={}", directory);
        println!("cargo:lib_dir={}", directory);
    }
    link("dylib");
}

fn link(kind: &str) {
    for library in LIBRARIES {
        println!("cargo:rustc-link-lib={}={}", kind, library);
    }
}

fn link_statically(directory: &str) {
    println!("cargo:rustc-link-search=native={}", directory);
    link("static");
    // They become part of the crate, which has to follow them.
    for library in LIBRARIES {
        println!("cargo:rerun-if-changed={}/lib{}.a", directory, library);
    }
    // What the libraries themselves are written in.
    match (target("OS").as_str(), target("ENV").as_str()) {
        ("macos", _) => println!("cargo:rustc-link-lib=dylib=c++"),
        (_, "msvc") => {}
        _ => println!("cargo:rustc-link-lib=dylib=stdc++"),
    }
    if target("OS") == "linux" {
        println!("cargo:rustc-link-lib=dylib=m");
    }
}

fn target(what: &str) -> String {
    env::var(format!("CARGO_CFG_TARGET_{}", what)).unwrap_or_default()
}

fn fail(why: &str) -> ! {
    eprintln!("mien-sys does not find the Mien libraries: {}", why);
    eprintln!(
        "Install them where pkg-config looks, set MIEN_LIB_DIR to their directory, or use the feature \
         `vendored`."
    );
    exit(1);
}
