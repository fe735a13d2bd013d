#!/usr/bin/env bash
# Line coverage of src/ and program/src/ by the tests, with what rustc and LLVM bring along: no other tool is needed.
#
#     ./coverage.sh
#
# Prints each file, the worst ones first, then the total, and fails when that is below 85 %. Code that only
# tests use (`#[cfg(test)]`) is not counted. The LLVM tools must be as new as rustc's LLVM; they come from
# `rustup component add llvm-tools` or, on Debian and Ubuntu, the package llvm-N.
set -euo pipefail
cd "$(dirname "$0")"

MINIMUM=85

major=$(rustc --version --verbose | sed -n 's/^LLVM version: \([0-9]*\).*/\1/p')
host=$(rustc --version --verbose | sed -n 's/^host: //p')
sysroot=$(rustc --print sysroot)

# The path of an LLVM tool of rustc's version.
find_tool() {
    local candidate
    for candidate in "$sysroot/lib/rustlib/$host/bin/$1" "$1-$major" "$1"; do
        if command -v "$candidate" >/dev/null &&
            "$candidate" --version | grep -Eq "LLVM version $major\."; then
            command -v "$candidate"
            return
        fi
    done
    return 1
}

if ! find_tool llvm-cov >/dev/null || ! find_tool llvm-profdata >/dev/null; then
    echo "coverage: fetching llvm-cov and llvm-profdata $major" >&2
    if command -v rustup >/dev/null && rustup component add llvm-tools >&2; then
        :
    elif command -v apt-get >/dev/null && [ "$(id -u)" = 0 ]; then
        apt-get update >&2
        DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "llvm-$major" >&2
    fi
fi
if ! llvm_cov=$(find_tool llvm-cov) || ! llvm_profdata=$(find_tool llvm-profdata); then
    echo "coverage: llvm-cov and llvm-profdata $major are missing: install rustup's component llvm-tools" \
        "or the package llvm-$major" >&2
    exit 1
fi

export CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-$PWD/target}/coverage"
raw="$CARGO_TARGET_DIR/raw"
rm -rf "$raw"
mkdir -p "$raw"
# Only our own crates count: counters in the numerics of others would cost minutes.
printf '#!/bin/sh\nexec "$@" -C instrument-coverage\n' >"$CARGO_TARGET_DIR/rustc"
chmod +x "$CARGO_TARGET_DIR/rustc"
export RUSTC_WORKSPACE_WRAPPER="$CARGO_TARGET_DIR/rustc"
# Four files per program, which its runs merge into.
export LLVM_PROFILE_FILE="$raw/%4m.profraw"

mapfile -t programs < <(cargo test --locked --no-run --message-format=json |
    sed -n 's/.*"executable":"\([^"]*\)".*/\1/p')
[ ${#programs[@]} -gt 0 ] || { echo "coverage: the tests do not compile" >&2 && exit 1; }
tests=passed
# Instrumented code is slower than what these tests allow.
cargo test --locked --lib --bins --tests --no-fail-fast -- --skip asked_often --skip answered_soon --skip costs_little || tests=failed

"$llvm_profdata" merge --sparse "$raw"/*.profraw -o "$raw/all.profdata"
objects=()
for program in "${programs[@]}"; do
    objects+=(--object "$program")
done
"$llvm_cov" export --format=lcov --instr-profile "$raw/all.profdata" "${objects[@]:1}" \
    "$PWD"/src "$PWD"/program/src >"$raw/all.lcov"

# What only tests use: 0 and a file or folder without its ending, or the line where a file's test module begins.
find src program/src -name '*.rs' | sort | while read -r file; do
    folder=$(dirname "$file")
    case $(basename "$file") in
    mod.rs | lib.rs | main.rs) children=$folder ;;
    *) children=${file%.rs} ;;
    esac
    awk -v file="$file" -v folder="$folder" -v children="$children" '
        /^#\[cfg\(test\)\]$/ { is_test = 1; path = ""; next }
        is_test && /^#\[path = / { split($0, part, "\""); path = folder "/" part[2]; sub(/\.rs$/, "", path); next }
        is_test && /^#\[/ { next }
        is_test && match($0, /mod [a-z_0-9]+;/) {
            print 0, path ? path : children "/" substr($0, RSTART + 4, RLENGTH - 5)
        }
        is_test && /mod [a-z_0-9]+ \{/ { print FNR, file }
        { is_test = 0 }' "$file"
done >"$raw/tests"

awk -v root="$PWD/" -v minimum=$MINIMUM '
    FNR == NR { if ($1) start[$2] = $1; else whole[$2]; next }
    /^SF:/ {
        file = substr($0, 4)
        sub(root, "", file)
        end = (file in start) ? start[file] : 1e9
        for (place in whole) {
            if (file == place ".rs" || index(file, place "/") == 1) end = 0
        }
    }
    /^DA:/ {
        split(substr($0, 4), at, ",")
        if (at[1] < end) { lines[file]++; hit[file] += at[2] > 0 }
    }
    END {
        for (file in lines) {
            printf "%6.1f %%  %5d of %5d  %s\n", 100 * hit[file] / lines[file], hit[file], lines[file], file | "sort -n"
            all += lines[file]; all_hit += hit[file]
        }
        close("sort -n")
        if (all == 0) { print "coverage: nothing was measured"; exit 1 }
        share = 100 * all_hit / all
        printf "%6.1f %%  %5d of %5d  lines of src/ and program/src/ (at least %d %% wanted)\n", share, all_hit, all, minimum
        exit share < minimum
    }' "$raw/tests" "$raw/all.lcov"
[ $tests = passed ] || { echo "coverage: some tests failed" >&2 && exit 1; }
