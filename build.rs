//! How the shared library is linked.

/// Where the version of the C interface stands, which the SONAME ends with.
const VERSION_FILE: &str = "src/ffi/version.rs";

fn abi_version() -> u32 {
    let source = std::fs::read_to_string(VERSION_FILE).expect("the sources are readable");
    source
        .lines()
        .filter_map(|line| line.strip_prefix("pub const HOLEFILL_ABI_VERSION: u32 = "))
        .find_map(|rest| rest.strip_suffix(';')?.parse().ok())
        .expect("HOLEFILL_ABI_VERSION is set in src/ffi/version.rs")
}

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed={VERSION_FILE}");
    if std::env::var("CARGO_CFG_TARGET_OS").as_deref() == Ok("linux") {
        let version = abi_version();
        println!("cargo:rustc-cdylib-link-arg=-Wl,-soname,libholefill.so.{version}");
        // Worker threads may still end when a plug-in that uses the library is unloaded.
        println!("cargo:rustc-cdylib-link-arg=-Wl,-z,nodelete");
    }
}
