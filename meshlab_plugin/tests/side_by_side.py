#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fill Holes (holefill) side by side with MeshLab's own Close Holes, in one engine and one run.

    HOLEFILL_PLUGIN=PLUGIN PYTHON side_by_side.py --cases CASES --scorer "CMD" --out FOLDER --markdown FILE

PYTHON has PyMeshLab. CASES holds a folder per case: `input.ply`, `truth.ply` (the triangles that were removed; without
it there is no error) and `meta.json`, whose `fill_loops` are to be filled. They are told to both filters in the same
way, by selected faces along their rims. Each fill runs in a process of its own, at most for LIMIT seconds.

The scorer is called as `CMD CASE OUTPUT --json` and prints JSON with `ok` (filled, everything else as it was), `sym_rms`
(two-way root mean square distance of patch and truth, over the size of the hole) and `selfint_patch_patch`,
`selfint_patch_rest` (pairs of triangles that intersect).
"""
import argparse
import json
import os
import shlex
import statistics
import subprocess
import sys
import time

import numpy as np

FILTERS = ("holefill", "close", "close and refine")
REPEATS = 3
# Seconds; a slower fill is not repeated.
SLOW = 2.0
LIMIT = 300


def write_ply(path, positions, triangles, colors):
    """Writes a binary file in double precision, like the cases."""
    fields = [("position", "<f8", 3)] + ([("color", "u1", 3)] if colors is not None else [])
    vertices = np.empty(len(positions), fields)
    vertices["position"] = positions
    properties = "".join("property double %s\n" % axis for axis in "xyz")
    if colors is not None:
        vertices["color"] = np.rint(255 * colors[:, :3])
        properties += "".join("property uchar %s\n" % name for name in ("red", "green", "blue"))
    faces = np.empty(len(triangles), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"] = 3
    faces["corners"] = triangles
    with open(path, "wb") as file:
        file.write(("ply\nformat binary_little_endian 1.0\nelement vertex %d\n%selement face %d\n"
                    "property list uchar int vertex_indices\nend_header\n"
                    % (len(vertices), properties, len(faces))).encode())
        file.write(vertices.tobytes())
        file.write(faces.tobytes())


def rims(triangles, edges):
    """The faces along the loops through these boundary edges."""
    owner = {}
    for index, face in enumerate(triangles.tolist()):
        for k in range(3):
            owner[face[k], face[(k + 1) % 3]] = index
    after = {}
    for a, b in owner:
        if (b, a) not in owner:
            after.setdefault(a, []).append(b)
    along = []
    for edge in edges:
        start, vertex = edge if tuple(edge) in owner else edge[::-1]
        # Where loops touch, the rim goes on along the faces round the vertex.
        along.append((start, vertex))
        while vertex != start and len(along) <= len(owner):
            ways = after[vertex]
            following = ways[0] if len(ways) == 1 else turn(owner, triangles, along[-1])
            along.append((vertex, following))
            vertex = following
    return {owner[edge] for edge in along}


def turn(owner, triangles, edge):
    """The boundary edge after `edge`. Walks through the faces at its end."""
    index, vertex = owner[edge], edge[1]
    while True:
        face = triangles[index].tolist()
        following = face[(face.index(vertex) + 1) % 3]
        if (following, vertex) not in owner:
            return following
        index = owner[following, vertex]


def fill(case, name, output):
    """Runs in a separate process: fills and prints the seconds."""
    import pymeshlab as ml
    ml.load_plugin(os.path.abspath(os.environ["HOLEFILL_PLUGIN"]))
    with open(os.path.join(case, "meta.json")) as file:
        meta = json.load(file)
    loaded = ml.MeshSet()
    loaded.load_new_mesh(os.path.join(case, "input.ply"))
    mesh = loaded.current_mesh()
    positions, triangles = mesh.vertex_matrix(), mesh.face_matrix()
    values = {"v_color_matrix": mesh.vertex_color_matrix()} if mesh.has_vertex_color() else {}
    faces = rims(triangles, [tuple(loop["edge"]) for loop in meta["fill_loops"]])
    chosen = np.zeros(len(triangles))
    chosen[list(faces)] = 1
    seconds = []
    while len(seconds) < REPEATS and (not seconds or seconds[-1] < SLOW):
        ms = ml.MeshSet()
        ms.add_mesh(ml.Mesh(positions, triangles, f_scalar_array=chosen, **values))
        ms.compute_selection_by_condition_per_face(condselect="fq == 1")
        start = time.perf_counter()
        if name == "holefill":
            ms.apply_filter("meshing_fill_holes_holefill", selected=True)
        else:
            # The length of refined edges is MeshLab's default, 3 percent of the diagonal.
            ms.apply_filter("meshing_close_holes", selected=True, maxholesize=1000000, refinehole=name != "close")
        seconds.append(time.perf_counter() - start)
    mesh = ms.current_mesh()
    write_ply(output, mesh.vertex_matrix(), mesh.face_matrix(), mesh.vertex_color_matrix() if values else None)
    print("RESULT " + json.dumps({"seconds": statistics.median(seconds)}))


def measure(case, name, arguments):
    output = os.path.join(arguments.out, name.replace(" ", "-"), os.path.basename(case) + ".ply")
    os.makedirs(os.path.dirname(output), exist_ok=True)
    if os.path.exists(output):
        os.remove(output)
    try:
        done = subprocess.run([sys.executable, __file__, "--fill", case, name, output], capture_output=True, text=True,
                              timeout=LIMIT)
    except subprocess.TimeoutExpired:
        return {"why": "more than %d s" % LIMIT}
    result = [line for line in done.stdout.splitlines() if line.startswith("RESULT ")]
    if done.returncode != 0 or not result:
        reasons = [line for line in done.stderr.strip().splitlines() if line.strip()]
        return {"why": reasons[-1].split("Exception: ")[-1] if reasons else "ended by signal %d" % -done.returncode}
    score = subprocess.run(shlex.split(arguments.scorer) + [case, output, "--json"], capture_output=True, text=True)
    score = json.loads(score.stdout)
    return {"seconds": json.loads(result[0][7:])["seconds"], "ok": bool(score["ok"]), "rms": score["sym_rms"],
            "intersections": (score["selfint_patch_patch"] or 0) + (score["selfint_patch_rest"] or 0)}


def cell(value, shape):
    return "–" if value is None else shape % value


def row(case, results):
    cells = [case]
    cells += ["yes" if results[name].get("ok") else "no" for name in FILTERS]
    cells += [cell(results[name].get("rms") if results[name].get("ok") else None, "%.4g") for name in FILTERS]
    cells += [cell(results[name].get("intersections"), "%d") for name in FILTERS]
    cells += [cell(results[name].get("seconds"), "%.3f") for name in FILTERS]
    return "| " + " | ".join(cells) + " |"


def summary(table):
    lines = []
    count = len(table)
    for name in FILTERS:
        of = [results[name] for results in table.values()]
        lines.append("- **%s**: %d of %d cases ok; cases with intersecting pairs: %d; %.1f s of filling altogether."
                     % (name, sum(bool(r.get("ok")) for r in of), count,
                        sum(bool(r.get("intersections")) for r in of), sum(r.get("seconds") or 0 for r in of)))
    for other in FILTERS[1:]:
        both = [(r["holefill"]["rms"], r[other]["rms"]) for r in table.values()
                if r["holefill"].get("ok") and r[other].get("ok") and None not in (r["holefill"]["rms"], r[other]["rms"])]
        # Rounding of the scorer's own arithmetic is no difference.
        lower = sum(ours < theirs or (ours < 1e-12 and theirs < 1e-12) for ours, theirs in both)
        ratios = [theirs / ours for ours, theirs in both if ours > 1e-12]
        lines.append("- Filled by both, with a known truth: %d cases against *%s*. The error of *holefill* is lower in %d "
                     "(%.0f %%); median of the other's error over it: %.1f."
                     % (len(both), other, lower, 100 * lower / max(len(both), 1),
                        statistics.median(ratios) if ratios else 0))
    refused = {}
    for case, results in table.items():
        for name in FILTERS:
            if "why" in results[name]:
                refused.setdefault((name, results[name]["why"]), []).append(case)
    for (name, why), cases in refused.items():
        lines.append("- *%s* on %s: %s" % (name, ", ".join(cases), why))
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fill", nargs=3, help=argparse.SUPPRESS)
    parser.add_argument("--cases")
    parser.add_argument("--scorer")
    parser.add_argument("--out")
    parser.add_argument("--markdown")
    parser.add_argument("--only", default="", help="cases whose name has this text")
    arguments = parser.parse_args()
    if arguments.fill:
        return fill(*arguments.fill)
    table = {}
    for case in sorted(os.listdir(arguments.cases)):
        folder = os.path.join(arguments.cases, case)
        if arguments.only in case and os.path.exists(os.path.join(folder, "input.ply")):
            table[case] = {name: measure(folder, name, arguments) for name in FILTERS}
            print(row(case, table[case]), flush=True)
    head = ["case"] + ["%s: %s" % (what, name) for what in ("ok", "rms", "intersections", "seconds") for name in FILTERS]
    lines = summary(table) + ["", "| " + " | ".join(head) + " |", "| --- |" + " --- |" * 3 + " ---: |" * 9]
    lines += [row(case, results) for case, results in table.items()]
    with open(arguments.markdown, "w") as file:
        file.write("\n".join(lines) + "\n")
    print("\n".join(summary(table)))


if __name__ == "__main__":
    main()
