#!/usr/bin/env bash
# Runs the tests of the C interface under a sanitizer: those in Rust, then the programs in C and C++, which are
# instrumented by their own compiler (with `address`, for undefined behaviour too).
#
#     ./sanitize.sh address|thread [TEST-FILTER]
#
# The stable toolchain carries the runtimes; the switch that allows them is for tests only. Everything is built anew in
# target/sanitize-NAME, which takes ten minutes of processor time the first time. With `thread` that includes the
# standard library, whose source is needed: rustup component add rust-src. HOLEFILL_HAMMER in the environment is the
# number of calls that each of the eight threads of the Rust test makes.
set -euo pipefail
cd "$(dirname "$0")"
sanitizer=${1:?address or thread}
filter=${2:-ffi::}
target=$(rustc -vV | sed -n 's/^host: //p')
export RUSTC_BOOTSTRAP=1
export RUSTFLAGS="-Zsanitizer=$sanitizer"
build_std=()
case "$sanitizer" in
    address)
        export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_leaks=1:allocator_may_return_null=1}
        ;;
    thread)
        # Without instruments in the standard library what channels and locks order may look like a race. Nothing is
        # suppressed.
        build_std=(-Zbuild-std)
        export TSAN_OPTIONS=${TSAN_OPTIONS:-allocator_may_return_null=1}
        ;;
    *)
        echo "unknown sanitizer $sanitizer" >&2
        exit 2
        ;;
esac
folder="target/sanitize-$sanitizer"
cargo test --locked "${build_std[@]}" --package holefill --lib --target "$target" --target-dir "$folder" -- "$filter" \
    --skip answered_soon --skip costs_little # Instrumented code takes longer than these tests allow.

if ! command -v cmake >/dev/null; then
    echo "SKIPPED: the programs in C and C++: cmake is missing"
    exit
fi
# cargo gets its flags from CMake here.
unset RUSTFLAGS
cmake -S . -B "$folder/cpp" -DHOLEFILL_SANITIZER="$sanitizer" -DHOLEFILL_CARGO_PROFILE=dev \
    -DHOLEFILL_CARGO_TARGET_DIR="$PWD/$folder" -DHOLEFILL_BUILD_PROGRAM=OFF -DHOLEFILL_INSTALL=OFF
cmake --build "$folder/cpp"
ctest --test-dir "$folder/cpp" --output-on-failure -L 'abi|examples'
