#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Downloads what the plugin needs for its build and its tests into a folder:
#
#     meshlab_plugin/tests/fetch.sh FOLDER
#
#     FOLDER/2022.02/source    MeshLab's source, of which only headers are used    Debian's source packages
#     FOLDER/2022.02/venv      the same release as a Python module                 PyPI
#     FOLDER/2025.07/...       the same
#
# Sources come from apt, from the server that this machine's apt uses. They use separate apt folders, so the machine's
# lists do not change. Files that exist are not downloaded again. Debian has 2025.07 only in its development suite and
# may remove it at any time. Then the script skips that release, and prints a line that begins with SKIPPED. Anything
# else that is missing is an error.
set -euo pipefail

[ $# = 1 ] || {
    sed -n '3,14s/^# \?//p' "$0" >&2
    exit 2
}
mkdir -p "$1"
folder=$(cd "$1" && pwd)

# Repeats a command that fails, because networks can fail.
again() {
    local try
    for try in 1 2 3 4; do
        "$@" && return
        echo "failed ($try of 4): $*" >&2
        sleep $((try * 5))
    done
    return 1
}

# Sets `apt` to the options that make apt use the sources of one suite.
use_suite() {
    local place="$folder/apt/$1" server
    mkdir -p "$place/lists/partial" "$place/cache/archives/partial" "$place/parts"
    server=$(apt-get indextargets --format '$(REPO_URI)' | grep -m1 '/debian/$') || {
        echo "apt knows no server of Debian packages: run apt-get update" >&2
        return 1
    }
    printf 'Types: deb-src\nURIs: %s\nSuites: %s\nComponents: main\nSigned-By: %s\n' "$server" "$1" \
        /usr/share/keyrings/debian-archive-keyring.gpg >"$place/parts/source.sources"
    # A server may have an old list. That is harmless, because the release is named.
    apt=(-o Dir::Etc::sourcelist=/dev/null -o "Dir::Etc::sourceparts=$place/parts" -o "Dir::State::lists=$place/lists"
        -o "Dir::Cache=$place/cache" -o "Dir::Cache::archives=$place/cache/archives"
        -o Acquire::Check-Valid-Until=false -o Acquire::Retries=3 -o APT::Sandbox::User=)
    again apt-get "${apt[@]}" -qq update
}

# The source of a release: the upstream part of its newest package in a suite.
fetch_source() {
    local release=$1 suite=$2 place="$folder/$1" version
    [ ! -e "$place/source/ML_VERSION" ] || return 0
    use_suite "$suite" || return 1
    version=$(apt-cache "${apt[@]}" showsrc meshlab | sed -n "s/^Version: \($release[~+-].*\)/\1/p" | sort -V | tail -n 1)
    [ -n "$version" ] || {
        echo "$suite has no source package of MeshLab $release" >&2
        return 1
    }
    rm -rf "$place/download" "$place/unpacked"
    mkdir -p "$place/download" "$place/unpacked"
    (cd "$place/download" && again apt-get "${apt[@]}" -qq source --download-only --tar-only "meshlab=$version") ||
        return 1
    tar xf "$place"/download/meshlab_*.orig.tar.* -C "$place/unpacked" --strip-components=1 || return 1
    [ -e "$place/unpacked/ML_VERSION" ] || return 1
    mv "$place/unpacked" "$place/source"
    rm -r "$place/download"
}

# The module, in a virtual environment of the first Python for which a build exists.
fetch_module() {
    local place="$folder/$1/venv" python
    [ ! -e "$place/complete" ] || return 0
    for python in python3 /usr/bin/python3 python3.12 python3.11 python3.10; do
        command -v "$python" >/dev/null || continue
        rm -rf "$place"
        "$python" -m venv "$place" || continue
        "$place/bin/pip" download --quiet --disable-pip-version-check --no-deps --only-binary :all: \
            --dest "$place/wheels" --retries 5 --timeout 60 "$2" || continue
        again "$place/bin/pip" install --quiet --disable-pip-version-check --retries 5 --timeout 60 \
            "$place"/wheels/*.whl "$3" || return 1
        rm -r "$place/wheels"
        touch "$place/complete"
        return 0
    done
    return 1
}

fetch_source 2022.02 trixie
again fetch_module 2022.02 pymeshlab==2022.2.post4 'numpy<2'
if fetch_source 2025.07 sid; then
    again fetch_module 2025.07 pymeshlab==2025.7.post1 'numpy<3'
else
    echo "SKIPPED: MeshLab 2025.07: its source is no longer available"
fi
