#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes pictures of the plugin in MeshLab's windows: the menu, the dialog, a mesh before and after.
#
#     meshlab_plugin/tests/screenshots.sh FOLDER MESH.ply PICTURES
#
# Run it as root on Debian, with debootstrap, cmake and the build dependencies of the plugin. It installs Debian's
# development suite with MeshLab 2025.07 in FOLDER/gui, about 1 GB. It builds the plugin in single precision, and
# controls MeshLab by mouse on a virtual screen. The first run takes some minutes. This is not a test: positions of menus
# and buttons are those of this release on a screen of 1280 by 900. Look at the pictures.
set -euo pipefail

[ $# = 3 ] || {
    sed -n '3,11s/^# \?//p' "$0" >&2
    exit 2
}
here=$(cd "$(dirname "$0")" && pwd)
repository=$(cd "$here/../.." && pwd)
mkdir -p "$1" "$3"
folder=$(cd "$1" && pwd)
system="$folder/gui/sid"
library="$system/usr/lib/x86_64-linux-gnu/meshlab/libmeshlab-common.so"
# The home folder of MeshLab's user inside that system.
desk="$system/srv"
plugins="$desk/.local/share/VCG/MeshLab_64bit_fp/MeshLabExtraPlugins/2025.07"

"$here/fetch.sh" "$folder"

if [ ! -e "$library" ]; then
    mkdir -p "$folder/gui"
    server=$(apt-get indextargets --format '$(REPO_URI)' | grep -m1 '/debian/$')
    debootstrap --variant=minbase sid "$system" "$server"
    cp /etc/resolv.conf "$system/etc/resolv.conf"
    chroot "$system" apt-get -o Acquire::Check-Valid-Until=false update
    # MeshLab needs the last four; without them it shows errors when it starts.
    DEBIAN_FRONTEND=noninteractive chroot "$system" apt-get install -y --no-install-recommends meshlab xvfb openbox \
        xdotool imagemagick libgl1-mesa-dri fonts-dejavu-core libmuparser2v5 libqhull-r8.0 lib3ds-1-3 libopenctm1
fi

cmake -S "$repository" -B "$folder/gui/build" -DCMAKE_BUILD_TYPE=Release -DHOLEFILL_BUILD_MESHLAB=ON \
    -DHOLEFILL_BUILD_PROGRAM=OFF -DHOLEFILL_BUILD_TESTS=OFF -DHOLEFILL_CARGO_TARGET_DIR="$repository/target" \
    -DMESHLAB_SOURCE_DIR="$folder/2025.07/source" -DMESHLAB_COMMON_LIBRARY="$library"
cmake --build "$folder/gui/build" --parallel "$(nproc)"
mkdir -p "$plugins"
cp "$folder/gui/build/meshlab_plugin/2025.07/libfilter_holefill.so" "$plugins/"

cp "$2" "$desk/bunny.ply"
rm -rf "$desk/pictures" "$system/tmp/.X77-lock"
mkdir "$desk/pictures"
cat >"$desk/work.sh" <<'WORK'
export DISPLAY=:77 LIBGL_ALWAYS_SOFTWARE=1 LC_ALL=C.UTF-8
Xvfb :77 -screen 0 1280x900x24 >/dev/null 2>&1 &
screen=$!
sleep 2
openbox >/dev/null 2>&1 &
sleep 1
meshlab bunny.ply &
meshlab=$!
trap 'kill $meshlab $screen' EXIT
for second in $(seq 60); do
    xdotool search --onlyvisible --name "MeshLab 2025" >/dev/null 2>&1 && break
    sleep 1
done
sleep 10

picture() { import -window root -crop "$2" +repage "$1.png"; }
at() { xdotool mousemove "$1" "$2"; sleep 1; }
click() { at "$1" "$2"; xdotool click 1; sleep 2; }
# Drags the mouse from left to right over the mesh: turns it by about 60 degrees.
turn() {
    at 300 477
    xdotool mousedown 1
    for step in 1 2 3 4 5 6 7 8 9 10; do
        xdotool mousemove $((300 + $1 * step / 10)) 477
        sleep 0.2
    done
    xdotool mouseup 1
    sleep 1
}
bunny=480x560+210+190

turn 260; turn 260; turn 260; turn 110
picture before "$bunny"
click 116 28      # Filters
click 260 168     # Remeshing, Simplification and Reconstruction
at 560 176        # Fill Holes (holefill)
at 562 177
picture menu 926x480+0+0
xdotool click 1
sleep 4
picture dialog 588x872+427+24
click 679 466     # Select the new faces and vertices: off, to see colors
click 864 874     # Apply
sleep 6
click 577 874     # Close
at 640 840
picture after "$bunny"
picture log 420x122+852+707

convert before.png after.png +append pictures/meshlab-before-after.png
for name in menu dialog log; do
    convert $name.png -colors 128 pictures/meshlab-$name.png
done
WORK
mount -t proc proc "$system/proc" 2>/dev/null && trap 'umount "$system/proc"' EXIT
chroot "$system" env HOME=/srv bash -c 'cd && exec bash work.sh'
cp "$desk"/pictures/*.png "$3/"
ls -l "$3"
