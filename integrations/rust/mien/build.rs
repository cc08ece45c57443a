// SPDX-License-Identifier: MIT
//! Tests and examples find a library that is not where the system looks. Programs of others set
//! their own rpath, or link statically.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let unix = std::env::var_os("CARGO_CFG_UNIX").is_some();
    if let (true, Ok(directory)) = (unix, std::env::var("DEP_MIEN_LIB_DIR")) {
        println!("cargo:rustc-link-arg=-Wl,-rpath,{}", directory);
    }
}
