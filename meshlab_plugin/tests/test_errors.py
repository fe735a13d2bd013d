# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors are exceptions that say what is wrong. The mesh stays, and nothing crashes or leaks."""
import ctypes
import gc
import os
import unittest

import numpy as np
import pymeshlab as ml

from common import (FILL, REPORT, SELECT, boundary_edges, fill_by_library, mesh_set, methods, rim_faces, torus)


class MallocInfo(ctypes.Structure):
    _fields_ = [(name, ctypes.c_size_t) for name in (
        "arena", "ordblks", "smblks", "hblks", "hblkhd", "usmblks", "fsmblks", "uordblks", "fordblks", "keepcost")]


def live_memory():
    """Bytes that all threads have allocated and not freed."""
    mallinfo = ctypes.CDLL(None).mallinfo2
    mallinfo.restype = MallocInfo
    info = mallinfo()
    return info.uordblks + info.hblkhd


def resident_memory():
    """Resident bytes of the process, with those that the allocator keeps for later."""
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


class Errors(unittest.TestCase):
    def refused(self, pattern, error=ml.PyMeshLabException, **parameters):
        ms = mesh_set(*torus())
        mesh = ms.current_mesh()
        positions, triangles = mesh.vertex_matrix(), mesh.face_matrix()
        with self.assertRaisesRegex(error, pattern):
            ms.apply_filter(FILL, **parameters)
        np.testing.assert_array_equal(ms.current_mesh().vertex_matrix(), positions)
        np.testing.assert_array_equal(ms.current_mesh().face_matrix(), triangles)
        self.assertEqual(ms.current_mesh().selected_face_number(), 0)

    def test_unknown_method(self):
        self.refused("no-such", method="no-such", error=ml.InvalidEnumException)
        # PyMeshLab itself accepts one number too many.
        for number in (-1, len(methods()), 99):
            self.refused("", method=number, error=(ml.InvalidEnumException, ml.PyMeshLabException))

    def test_unknown_parameter(self):
        self.refused("", nosuchparameter=1)

    def test_wrong_types(self):
        for parameters in ({"maxholesize": "many"}, {"density": "fine"}, {"selected": "x"}):
            with self.subTest(parameters=parameters):
                self.refused("", error=Exception, **parameters)

    def test_values_out_of_range(self):
        self.refused("MaxHoleSize.*negative", maxholesize=-1)
        self.refused("KeepLargest.*negative", keeplargest=-1)
        self.refused("Seed.*negative", seed=-1)
        self.refused("density", density=-1.0)
        self.refused("density", density=1e9)
        self.refused("density", density=float("nan"))
        self.refused("budget", timebudget=-1.0)
        self.refused("", maxperimeter=-1.0, error=Exception)

    def test_named_parameters(self):
        self.refused("name=value", parameters="refine.density")
        self.refused("no.such", parameters="no.such=1")
        self.refused("refine.density", parameters="refine.density=thick")

    def test_points_without_faces(self):
        ms = ml.MeshSet()
        ms.add_mesh(ml.Mesh(np.random.RandomState(0).rand(10, 3)))
        for name in (FILL, SELECT, REPORT):
            with self.assertRaises(ml.PyMeshLabException):
                ms.apply_filter(name)

    def test_no_mesh(self):
        for name in (FILL, SELECT, REPORT):
            with self.assertRaises(ml.PyMeshLabException):
                ml.MeshSet().apply_filter(name)

    def test_coordinates_that_are_no_numbers(self):
        for value in (np.nan, np.inf, -np.inf):
            positions, triangles = torus()
            positions[7, 1] = value
            for name in (FILL, SELECT, REPORT):
                ms = mesh_set(positions, triangles)
                with self.assertRaisesRegex(ml.PyMeshLabException, "row 7 .*not finite"):
                    ms.apply_filter(name)
                np.testing.assert_array_equal(ms.current_mesh().vertex_matrix(), positions)
                self.assertEqual(ms.current_mesh().face_number(), len(triangles))


class Irregular(unittest.TestCase):
    def test_edges_with_three_faces(self):
        positions, triangles = torus()
        # A fin on an edge away from the holes, and one on a rim.
        fin = len(positions)
        edges = {(int(f[k]), int(f[(k + 1) % 3])) for f in triangles for k in range(3)}
        inner = next((a, b) for a, b in sorted(edges, reverse=True) if (b, a) in edges)
        positions = np.vstack([positions, [0, 0, 5]])
        triangles = np.vstack([triangles, [inner[0], inner[1], fin]]).astype(np.int32)
        ms = mesh_set(positions, triangles)
        result = ms.apply_filter(FILL)
        expected = fill_by_library(positions, triangles)
        np.testing.assert_array_equal(ms.current_mesh().face_matrix(), expected[1])
        np.testing.assert_array_equal(ms.current_mesh().vertex_matrix(), expected[0])
        self.assertGreaterEqual(result["closed_holes"], 3)
        self.assertGreaterEqual(result["failed_holes"], 1)
        # MeshLab's own filter refuses such a mesh.
        with self.assertRaises(ml.PyMeshLabException):
            mesh_set(positions, triangles).apply_filter("meshing_close_holes")

    def test_broken_connectivity_does_not_crash(self):
        positions, triangles = torus()
        random = np.random.RandomState(7)
        for change in range(20):
            with self.subTest(change=change):
                broken = triangles.copy()
                rows = random.randint(0, len(broken), 40)
                broken[rows] = random.randint(0, len(positions), (40, 3))
                ms = mesh_set(positions, broken)
                before = ms.current_mesh().face_matrix()
                result = ms.apply_filter(FILL, method="fair-c1")
                np.testing.assert_array_equal(ms.current_mesh().face_matrix()[:len(before)], before)
                self.assertEqual(ms.current_mesh().face_number(), len(before) + result["new_faces"])
                ms.apply_filter(SELECT)
                ms.apply_filter(REPORT)

    def test_mixed_orientation(self):
        positions, triangles = torus()
        triangles[::3] = triangles[::3, ::-1]
        ms = mesh_set(positions, triangles)
        result = ms.apply_filter(FILL)
        self.assertEqual(result["new_faces"], ms.current_mesh().face_number() - len(triangles))

    def test_intersecting_patches_can_be_refused(self):
        # A strip of surface lies across the hole: every patch intersects the strip.
        positions, triangles = torus(blocks=((2, 2, 6),))
        middle = positions[np.unique(triangles[list(rim_faces(triangles)[0])])].mean(axis=0)
        across = np.array([middle - 2, middle + 2, middle + [2, 2, -2]])
        positions = np.vstack([positions, across])
        n = len(positions)
        triangles = np.vstack([triangles, [n - 3, n - 2, n - 1]]).astype(np.int32)
        ms = mesh_set(positions, triangles)
        result = ms.apply_filter(FILL, keeplargest=1)
        self.assertGreater(result["self_intersections"], 0)
        ms = mesh_set(positions, triangles)
        result = ms.apply_filter(FILL, keeplargest=1, refuseselfintersection=True)
        self.assertEqual((result["closed_holes"], result["failed_holes"]), (0, 1))
        self.assertEqual(result["self_intersections"], 0)
        np.testing.assert_array_equal(ms.current_mesh().face_matrix(), triangles)
        np.testing.assert_array_equal(ms.current_mesh().vertex_matrix(), positions)

    def test_time_budget(self):
        ms = mesh_set(*torus())
        result = ms.apply_filter(FILL, timebudget=1e-9)
        self.assertEqual(result["closed_holes"] + result["failed_holes"], 3)
        self.assertGreater(result["failed_holes"], 0)
        self.assertGreater(boundary_edges(ms.current_mesh().face_matrix()), 0)


class Memory(unittest.TestCase):
    def test_a_thousand_calls_do_not_grow_memory(self):
        positions, triangles = torus(around=24, across=12, blocks=((2, 2, 2), (10, 3, 3)))
        bad = positions.copy()
        bad[0, 0] = np.nan

        def call(i):
            ms = mesh_set(positions, triangles, v_color_matrix=np.ones((len(positions), 4)))
            self.assertEqual(ms.apply_filter(FILL, method="fair-c1" if i % 4 else "auto")["closed_holes"], 2)
            ms = mesh_set(bad, triangles)
            with self.assertRaises(ml.PyMeshLabException):
                ms.apply_filter(FILL)

        for i in range(200):
            call(i)
        gc.collect()
        live, resident = live_memory(), resident_memory()
        for i in range(1000):
            call(i)
        gc.collect()
        live, resident = live_memory() - live, resident_memory() - resident
        print("after 1,000 calls that fill and 1,000 that fail: %+.1f KiB live, %+.1f MiB resident" %
              (live / 2**10, resident / 2**20), flush=True)
        # A copy of this small mesh in each call would be 30 MiB. Resident memory goes up and down with the threads.
        self.assertLess(live, 2**20)
        self.assertLess(resident, 64 * 2**20)


if __name__ == "__main__":
    unittest.main()
