# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests share: the plugin in PyMeshLab, the library, and meshes.

HOLEFILL_PLUGIN names the plugin, HOLEFILL_LIBRARY the shared library built from the same sources.
"""
import ctypes
import os
import unittest

import numpy as np
import pymeshlab as ml

FILL = "meshing_fill_holes_holefill"
SELECT = "compute_selection_from_hole_rims"
REPORT = "get_holes_report"

# PyMeshLab 2022.2 writes beyond the end of the memory when it makes a custom attribute of points.
HAS_POINT_ATTRIBUTES = hasattr(ml, "PureValue")

ml.load_plugin(os.path.abspath(os.environ["HOLEFILL_PLUGIN"]))


# The library, by its C interface.

class Input(ctypes.Structure):
    _fields_ = [("data", ctypes.c_void_p), ("count", ctypes.c_uint64), ("stride", ctypes.c_uint64),
                ("scalar_type", ctypes.c_uint32), ("reserved", ctypes.c_uint32)]


class Handle(ctypes.Structure):
    _fields_ = [("id", ctypes.c_uint64)]


class MeshInfo(ctypes.Structure):
    _fields_ = [("struct_size", ctypes.c_uint32), ("version", ctypes.c_uint32)] + [
        (name, ctypes.c_uint64) for name in ("vertices", "triangles", "input_vertices", "input_triangles", "undo")] + [
        ("is_polyline", ctypes.c_uint32), ("reserved", ctypes.c_uint32)]


class Selection(ctypes.Structure):
    _fields_ = [("struct_size", ctypes.c_uint32), ("version", ctypes.c_uint32), ("only", Input), ("keep", Input),
                ("max_edges", ctypes.c_uint64), ("max_perimeter", ctypes.c_double), ("keep_largest", ctypes.c_uint64)]


class Target(ctypes.Structure):
    _fields_ = [("struct_size", ctypes.c_uint32), ("version", ctypes.c_uint32), ("kind", ctypes.c_uint32),
                ("reserved", ctypes.c_uint32), ("loop_id", ctypes.c_uint64), ("edge", ctypes.c_uint64 * 2),
                ("ids", ctypes.POINTER(Input)), ("selection", ctypes.POINTER(Selection))]


class Options(ctypes.Structure):
    _fields_ = [("struct_size", ctypes.c_uint32), ("version", ctypes.c_uint32), ("method", ctypes.c_char_p),
                ("parameters", Handle), ("seed", ctypes.c_uint64), ("time_budget", ctypes.c_double),
                ("density", ctypes.c_double), ("max_new_vertices", ctypes.c_uint64), ("threads", ctypes.c_uint32),
                ("log_level", ctypes.c_uint32), ("progress", ctypes.c_void_p), ("progress_data", ctypes.c_void_p),
                ("log", ctypes.c_void_p), ("log_data", ctypes.c_void_p)]


U32, U64, F64 = 6, 8, 10
library = ctypes.CDLL(os.environ["HOLEFILL_LIBRARY"])
library.holefill_method_name.restype = ctypes.c_char_p
library.holefill_method_name.argtypes = [ctypes.c_uint64]
library.holefill_method_count.restype = ctypes.c_uint64


def methods():
    return [library.holefill_method_name(i).decode() for i in range(library.holefill_method_count())]


def rows(array, scalar_type):
    return Input(array.ctypes.data, len(array), 0, scalar_type, 0)


def fill_by_library(positions, triangles, method=None, density=0.0, **rules):
    """Positions and triangles of the mesh that the library fills directly."""
    positions = np.ascontiguousarray(positions, np.float64)
    triangles = np.ascontiguousarray(triangles, np.uint32)
    mesh = Handle()

    def check(status):
        assert status in (0, 1), status

    check(library.holefill_mesh_from_arrays(ctypes.byref(rows(positions, F64)), ctypes.byref(rows(triangles, U32)),
                                            ctypes.byref(mesh), None))
    selection = Selection(ctypes.sizeof(Selection), 1, **rules)
    options = Options(ctypes.sizeof(Options), 1, method.encode() if method else None, density=density)
    target = Target(ctypes.sizeof(Target), 1, selection=ctypes.pointer(selection))
    check(library.holefill_mesh_fill(mesh, ctypes.byref(target), ctypes.byref(options), None, None))
    info = MeshInfo(ctypes.sizeof(MeshInfo), 1)
    check(library.holefill_mesh_info(mesh, ctypes.byref(info), None))
    positions = np.empty((info.vertices, 3))
    triangles = np.empty((info.triangles, 3), np.uint32)
    zero = ctypes.c_uint64(0)
    check(library.holefill_mesh_read_positions(mesh, zero, ctypes.byref(rows(positions, F64)), None))
    check(library.holefill_mesh_read_triangles(mesh, zero, ctypes.byref(rows(triangles, U32)), None))
    check(library.holefill_mesh_free(mesh))
    return positions, triangles


# Meshes

def torus(blocks=((2, 2, 3), (20, 5, 4), (35, 14, 6)), around=48, across=24):
    """A torus without square blocks of its grid: (i, j, size) has 4 * size edges along its rim. Without isolated
    vertices."""
    i, j = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    a, b = 2 * np.pi * i / around, 2 * np.pi * j / across
    radius = 3 + np.cos(b)
    points = np.stack([radius * np.cos(a), radius * np.sin(a), np.sin(b)], -1).reshape(-1, 3)
    faces = []
    for u in range(around):
        for v in range(across):
            if any(i <= u < i + n and j <= v < j + n for i, j, n in blocks):
                continue
            p, q = u * across + v, u * across + (v + 1) % across
            r, s = ((u + 1) % around) * across + v, ((u + 1) % around) * across + (v + 1) % across
            faces += [(p, r, s), (p, s, q)]
    faces = np.array(faces, np.int32)
    used = np.unique(faces)
    index = np.full(len(points), -1, np.int32)
    index[used] = np.arange(len(used))
    return points[used], index[faces]


def tetrahedron():
    """Without its bottom."""
    return (np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float64),
            np.array([[0, 1, 3], [1, 2, 3], [2, 0, 3]], np.int32))


def mesh_set(positions, triangles, **values):
    ms = ml.MeshSet()
    ms.add_mesh(ml.Mesh(positions, triangles, **values))
    return ms


def select_faces(ms, condition):
    """By a condition such as `fi == 5`."""
    ms.apply_filter("compute_selection_by_condition_per_face", condselect=condition)


def percent(value):
    return ml.PercentageValue(value) if hasattr(ml, "PercentageValue") else ml.Percentage(value)


def pure(value):
    return ml.PureValue(value) if hasattr(ml, "PureValue") else ml.AbsoluteValue(value)


def rim_faces(triangles):
    """For each boundary loop, by its smallest vertex: the faces along it and its number of edges."""
    edges = {}
    for index, face in enumerate(triangles):
        for k in range(3):
            edges[int(face[k]), int(face[(k + 1) % 3])] = index
    after = {a: b for a, b in edges if (b, a) not in edges}
    loops = []
    while after:
        start = min(after)
        faces, vertex = set(), start
        while vertex in after:
            following = after.pop(vertex)
            faces.add(edges[vertex, following])
            vertex = following
        loops.append(faces)
    return loops


def boundary_edges(triangles):
    edges = {(int(f[k]), int(f[(k + 1) % 3])) for f in triangles for k in range(3)}
    return sum((b, a) not in edges for a, b in edges)


def load(path):
    """A mesh set with the mesh of a file.

    When a filter fails, PyMeshLab keeps a pointer to the log of its mesh set until some filter succeeds, and writes
    there when a file is read, even if the mesh set is gone. So one succeeds first.
    """
    mesh_set(*tetrahedron()).apply_filter(REPORT)
    ms = ml.MeshSet()
    ms.load_new_mesh(path)
    return ms


def case(name):
    """The file of a case; skips the test where there is none."""
    here = os.path.dirname(os.path.abspath(__file__))
    folder = os.environ.get("HOLEFILL_CASES", os.path.join(here, "../../../shared/data/cases"))
    path = os.path.join(folder, name, "input.ply")
    if not os.path.exists(path):
        raise unittest.SkipTest("SKIPPED: there is no case " + name)
    return path
