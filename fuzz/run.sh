#!/usr/bin/env bash
# Fuzzes the C interface. Needs nothing but the Rust toolchain and a C++ compiler.
#
#     fuzz/run.sh [SECONDS]
#
# What it finds is written to fuzz/artifacts and becomes a named test in src/ffi/tests.
set -euo pipefail
cd "$(dirname "$0")"
target=$(rustc -vV | sed -n 's/^host: //p')
mkdir -p corpus/calls artifacts/calls
# The switches that cargo-fuzz gives, as a stable compiler takes them for tests.
export RUSTC_BOOTSTRAP=1
export RUSTFLAGS="-Zsanitizer=address -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
 -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
 -Cllvm-args=-sanitizer-coverage-trace-compares -Ccodegen-units=1 --cfg fuzzing"
cargo build --release --target "$target"
export LSAN_OPTIONS=${LSAN_OPTIONS:-"suppressions=$PWD/../tests/lsan.supp:print_suppressions=0"}
exec "target/$target/release/calls" -max_total_time="${1:-1800}" -timeout=60 -rss_limit_mb=4096 -max_len=4096 \
    -artifact_prefix=artifacts/calls/ corpus/calls
