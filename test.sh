#!/usr/bin/env bash
# Every check of this repository. Needs a Rust toolchain; fetches what else is missing if it can.
#
#     ./test.sh
#
# Where something is missing and cannot be fetched, the checks that need it are skipped, and the last lines
# say so. With CI=true in the environment that is a failure.
set -euo pipefail
cd "$(dirname "$0")"
exec </dev/null
command -v cargo >/dev/null || PATH="$HOME/.cargo/bin:$PATH"

skipped=()
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

say() { printf '\n=== %s\n' "$*"; }

fail() {
    printf '\nFAILED: %s\n' "$*" >&2
    exit 1
}

skip() {
    printf '\n!!! SKIPPED: %s\n' "$*"
    skipped+=("$*")
    [ "${CI:-}" != true ] || fail "$* (with CI=true nothing may be skipped)"
}

# Installs Debian packages if this is a Debian or Ubuntu machine and we may.
apt_install() {
    if command -v apt-get >/dev/null && [ "$(id -u)" = 0 ]; then
        apt-get update && DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "$@"
    else
        echo "missing; on Debian or Ubuntu, as root: apt-get update && apt-get install $*"
        return 1
    fi
}

# Unpacks Debian packages into a folder, without installing them or what they depend on.
apt_unpack() {
    local folder="$1"
    shift
    if command -v apt-get >/dev/null && command -v dpkg-deb >/dev/null && [ "$(id -u)" = 0 ]; then
        mkdir -p "$folder"
        (
            cd "$folder" && apt-get update && apt-get download "$@" || exit 1
            for package in *.deb; do
                dpkg-deb -x "$package" . && rm "$package" || exit 1
            done
        )
    else
        echo "missing; on Debian or Ubuntu, as root: apt-get update && apt-get install $*"
        return 1
    fi
}

has_header() { echo "#include <$1>" | c++ -E -x c++ -I/usr/include/eigen3 - >/dev/null 2>&1; }

# Whether a part of the Rust toolchain is there; fetches it by rustup if it is not.
have_component() {
    cargo "$1" --version >/dev/null 2>&1 && return
    if command -v rustup >/dev/null; then
        rustup component add "$2" && cargo "$1" --version
    else
        echo "missing: cargo $1, part of the Rust toolchain"
        return 1
    fi
}

holefill() { cargo run --locked --release --quiet -- "$@"; }

say "tools"
command -v cargo >/dev/null || fail "there is no cargo: install Rust 1.90 or newer, see https://rustup.rs"
rustc --version
if ! command -v cc >/dev/null && ! apt_install gcc libc6-dev; then
    fail "there is no C compiler, which Rust needs to link programs"
fi

say "format"
if have_component fmt rustfmt; then
    cargo fmt --all --check
else
    skip "the check of the format: no rustfmt"
fi

say "lints"
if have_component clippy clippy; then
    cargo clippy --locked --workspace --all-targets -- -D warnings
else
    skip "the lints: no clippy"
fi

say "tests"
# With the output of tests that pass: it says what they left out.
HOLEFILL_HAMMER=10000 cargo test --locked --workspace -- --show-output 2>&1 | tee "$scratch/tests"

say "documentation"
RUSTDOCFLAGS="-D warnings" cargo doc --locked --workspace --no-deps

say "release build"
cargo build --locked --release --workspace

say "C and C++: package, tests, examples"
tools=()
for tool in cmake:cmake c++:g++ pkg-config:pkg-config valgrind:valgrind make:make; do
    command -v "${tool%%:*}" >/dev/null || tools+=("${tool##*:}")
done
if [ ${#tools[@]} = 0 ] || apt_install "${tools[@]}"; then
    peers="$PWD/target/peers"
    if ! { has_header CGAL/version.h && has_header Eigen/Sparse && has_header mpfr.h && has_header zlib.h; } &&
        ! apt_install libcgal-dev libeigen3-dev zlib1g-dev; then
        skip "CGAL's judgement: no CGAL or Eigen"
    fi
    # Not installed: the package depends on a toolkit for graphics that OpenMesh itself does without.
    if ! has_header OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh && [ ! -d "$peers/openmesh/usr/include/OpenMesh" ] &&
        ! apt_unpack "$peers/openmesh" libopenmesh-dev libopenmesh1; then
        skip "OpenMesh's judgement: no OpenMesh"
    fi
    if [ ! -d "$peers/cgal/data/meshes" ] && ! {
        apt_unpack "$peers/cgal" libcgal-demo &&
            tar -xzf "$peers/cgal/usr/share/doc/libcgal-dev/data.tar.gz" -C "$peers/cgal" data/meshes
    }; then
        skip "the inputs of CGAL's tests: no data of CGAL"
    fi
    cmake -S . -B target/cpp -DCMAKE_BUILD_TYPE=Release -DHOLEFILL_BUILD_PROGRAM=OFF \
        -DHOLEFILL_CARGO_TARGET_DIR="$PWD/target" -DHOLEFILL_OPENMESH_ROOT="$peers/openmesh" \
        -DHOLEFILL_CASES="${HOLEFILL_CASES:-$PWD/../shared/data/cases}" -DHOLEFILL_CGAL_DATA="$peers/cgal/data/meshes"
    cmake --build target/cpp --parallel "$(nproc)"
    ctest --test-dir target/cpp --label-exclude 'cgal|openmesh' --output-on-failure 2>&1 | tee "$scratch/ctest"

    say "CGAL and OpenMesh judge the results"
    for label in cgal openmesh; do
        listed=$(ctest --test-dir target/cpp --label-regex "$label" --show-only)
        [[ "$listed" != *"Total Tests: 0"* ]] || skip "the tests of the label $label"
    done
    ctest --test-dir target/cpp --label-regex 'cgal|openmesh' --verbose 2>&1 | tee "$scratch/judge"
else
    skip "the tests in C and C++: ${tools[*]} missing"
fi

say "MeshLab plugin: built for two generations of MeshLab, tested in their engines"
meshlab=(ca-certificates xz-utils cmake make g++ binutils python3 python3-venv qtbase5-dev libqt5opengl5-dev
    libglew-dev libeigen3-dev libgl1)
apt_install "${meshlab[@]}" || echo "trying without"
if meshlab_plugin/tests/fetch.sh target/meshlab 2>&1 | tee "$scratch/meshlab" &&
    cmake -S . -B target/cpp-meshlab -DCMAKE_BUILD_TYPE=Release -DHOLEFILL_BUILD_MESHLAB=ON \
        -DHOLEFILL_BUILD_PROGRAM=OFF -DHOLEFILL_BUILD_TESTS=OFF -DHOLEFILL_CARGO_TARGET_DIR="$PWD/target" \
        -DHOLEFILL_MESHLAB_PEERS="$PWD/target/meshlab"; then
    cmake --build target/cpp-meshlab --parallel "$(nproc)"
    ctest --test-dir target/cpp-meshlab -L meshlab --parallel "$(nproc)" --no-tests=error --output-on-failure 2>&1 | tee -a "$scratch/ctest"
else
    skip "the MeshLab plugin: MeshLab's headers, PyMeshLab or Qt are missing"
fi

say "demo"
demo="$scratch/demo"
holefill demo "$demo"
for file in damaged.ply filled.ply report.json preview.png; do
    [ -s "$demo/$file" ] || fail "the demo wrote no $file"
done
[ "$(head -c 8 "$demo/preview.png" | tail -c 7 | tr -d '\r\n\032')" = PNG ] || fail "the picture is no PNG"
holefill inspect "$demo/damaged.ply" --json | tr -d ' \n' | grep -q '"loops":\[{' ||
    fail "the demo's damaged model has no hole"
holefill inspect "$demo/filled.ply" --json | tr -d ' \n' | grep -q '"loops":\[\]' ||
    fail "the demo left a hole open"

say "the same bytes for any number of threads, and again"
methods=$(holefill fill --help | sed -n '/^Methods:/,/^$/p' | awk 'NR > 1 && NF { print $1 }')
[ -n "$methods" ] || fail "the program lists no methods"
for method in $methods; do
    for threads in 1 2 1 2; do
        holefill fill "$demo/damaged.ply" -o "$scratch/out.ply" --method "$method" --threads "$threads" --quiet
        sha256sum <"$scratch/out.ply" | cut -d" " -f1
    done >"$scratch/sums"
    printf '%-14s %s\n' "$method" "$(sort -u "$scratch/sums" | tr '\n' ' ')"
    [ "$(sort -u "$scratch/sums" | wc -l)" = 1 ] || fail "$method gives different files"
done

say "summary"
grep -E '^ *(Running|Doc-tests) |^test result' "$scratch/tests"
grep -E 'SKIPPED|^CASES' "$scratch/tests" | sort -u || true
[ ! -e "$scratch/ctest" ] || grep 'tests passed' "$scratch/ctest"
[ ! -e "$scratch/judge" ] || grep 'tests passed' "$scratch/judge"
grep '^SKIPPED' "$scratch/meshlab" || true
for reason in ${skipped[@]+"${skipped[@]}"}; do
    printf '!!! SKIPPED: %s\n' "$reason"
done
if [ ${#skipped[@]} = 0 ]; then
    echo "All checks passed."
else
    echo "All checks passed but the ${#skipped[@]} that were skipped."
fi
