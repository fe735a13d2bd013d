#!/usr/bin/env bash
# Runs the tests of the C interface under a sanitizer.
#
#     ./sanitize.sh address|thread [TEST-FILTER]
#
# The stable toolchain carries the runtimes; the switch that allows them is for tests only. The library is built anew in
# target/sanitize-NAME, which takes some minutes the first time.
set -euo pipefail
cd "$(dirname "$0")"
sanitizer=${1:?address or thread}
filter=${2:-ffi::}
target=$(rustc -vV | sed -n 's/^host: //p')
export RUSTC_BOOTSTRAP=1
export RUSTFLAGS="-Zsanitizer=$sanitizer"
case "$sanitizer" in
    address)
        export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_leaks=1:allocator_may_return_null=1}
        ;;
    thread)
        # The standard library and the lock-free queues of the thread pool order memory by fences, which this sanitizer
        # does not know: see suppressions.
        RUSTFLAGS="$RUSTFLAGS -Cunsafe-allow-abi-mismatch=sanitizer"
        export TSAN_OPTIONS=${TSAN_OPTIONS:-"suppressions=$PWD/tests/tsan.supp"}
        ;;
    *)
        echo "unknown sanitizer $sanitizer" >&2
        exit 2
        ;;
esac
cargo test --locked --lib --no-default-features --target "$target" --target-dir "target/sanitize-$sanitizer" -- "$filter"
