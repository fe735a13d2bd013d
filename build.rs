//! How the shared library is linked.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    if std::env::var("CARGO_CFG_TARGET_OS").as_deref() == Ok("linux") {
        // The number is `HOLEFILL_ABI_VERSION`.
        println!("cargo:rustc-cdylib-link-arg=-Wl,-soname,libholefill.so.0");
        // Worker threads may still end when a plug-in that uses the library is unloaded.
        println!("cargo:rustc-cdylib-link-arg=-Wl,-z,nodelete");
    }
}
