# SPDX-License-Identifier: GPL-3.0-or-later
"""Which holes are filled, by selection and size. The filters that select rims and list holes."""
import unittest

import numpy as np
import pymeshlab as ml

from common import (FILL, REPORT, SELECT, boundary_edges, fill_by_library, mesh_set, percent, pure, rim_faces,
                    select_faces, tetrahedron, torus)

# The holes of the torus have 12, 16 and 24 edges.


def condition(faces):
    return " || ".join("fi == %d" % face for face in faces)


class Rules(unittest.TestCase):
    def filled(self, expected, ms=None, **parameters):
        ms = ms or mesh_set(*torus())
        before = ms.current_mesh().face_matrix()
        open_before = boundary_edges(before)
        result = ms.apply_filter(FILL, **parameters)
        self.assertEqual((result["closed_holes"], result["kept_holes"], result["failed_holes"]),
                         (len(expected), 3 - len(expected), 0))
        self.assertEqual(open_before - boundary_edges(ms.current_mesh().face_matrix()), sum(expected))
        np.testing.assert_array_equal(ms.current_mesh().face_matrix()[:len(before)], before)
        return ms

    def test_max_edges(self):
        self.filled([12, 16, 24], maxholesize=0)
        self.filled([12, 16, 24], maxholesize=24)
        self.filled([12, 16], maxholesize=23)
        self.filled([12], maxholesize=12)
        self.filled([], maxholesize=11)

    def test_max_perimeter_in_units(self):
        longest = mesh_set(*torus()).apply_filter(REPORT)["longest_perimeter"]
        self.filled([12, 16, 24], maxperimeter=pure(longest * 1.001))
        self.filled([12, 16], maxperimeter=pure(longest * 0.999))
        self.filled([], maxperimeter=pure(longest * 0.01))

    def test_max_perimeter_in_percent_of_the_diagonal(self):
        ms = mesh_set(*torus())
        report = ms.apply_filter(REPORT)
        share = 100 * report["longest_perimeter"] / ms.current_mesh().bounding_box().diagonal()
        self.assertLess(share, 99)
        self.filled([12, 16], maxperimeter=percent(share * 0.999))
        self.filled([12, 16, 24], maxperimeter=percent(share * 1.001))

    def test_keep_the_largest(self):
        self.filled([12, 16], keeplargest=1)
        self.filled([12], keeplargest=2)
        self.filled([], keeplargest=7)

    def test_rules_together(self):
        # The largest stays open even if other rules choose it, as in the library.
        self.filled([12], keeplargest=1, maxholesize=12)
        ms = self.filled([16], keeplargest=1, maxholesize=20, selected=True, ms=self.selected(1))
        positions, triangles = torus()
        self.assertEqual(ms.current_mesh().vertex_matrix()[:len(positions)].tolist(), positions.tolist())

    def selected(self, *holes):
        """The torus with one face at the rim of each of these holes selected."""
        positions, triangles = torus()
        rims = sorted(rim_faces(triangles), key=len)
        ms = mesh_set(positions, triangles)
        select_faces(ms, condition(min(rims[hole]) for hole in holes))
        return ms

    def test_only_holes_that_touch_the_selection(self):
        sizes = [12, 16, 24]
        for hole in range(3):
            self.filled([sizes[hole]], ms=self.selected(hole), selected=True)
        self.filled([12, 24], ms=self.selected(0, 2), selected=True)
        self.filled(sizes, ms=self.selected(0), selected=False)

    def test_selected_faces_without_a_hole_choose_none(self):
        positions, triangles = torus()
        at_rims = set().union(*rim_faces(triangles))
        ms = mesh_set(positions, triangles)
        select_faces(ms, condition([max(set(range(len(triangles))) - at_rims)]))
        self.filled([], ms=ms, selected=True)
        self.filled([], ms=mesh_set(positions, triangles), selected=True)

    def test_face_at_a_rim_by_a_corner_only_does_not_count(self):
        positions, triangles = torus(blocks=((2, 2, 3),))
        rim = rim_faces(triangles)[0]
        edges = {(int(f[k]), int(f[(k + 1) % 3])) for f in triangles for k in range(3)}
        corners = {v for a, b in edges if (b, a) not in edges for v in (a, b)}
        by_corner = [i for i, f in enumerate(triangles) if i not in rim and corners & set(map(int, f))]
        ms = mesh_set(positions, triangles)
        select_faces(ms, condition(by_corner[:1]))
        self.assertEqual(ms.apply_filter(FILL, selected=True)["closed_holes"], 0)

    def test_the_same_as_the_library_with_the_same_rules(self):
        positions, triangles = torus()
        ms = mesh_set(positions, triangles)
        ms.apply_filter(FILL, maxholesize=20)
        expected = fill_by_library(positions, triangles, max_edges=20)
        np.testing.assert_array_equal(ms.current_mesh().vertex_matrix(), expected[0])
        np.testing.assert_array_equal(ms.current_mesh().face_matrix(), expected[1])

    def test_hole_after_hole(self):
        ms = mesh_set(*torus())
        for edges in (12, 16, 24):
            self.assertEqual(ms.apply_filter(FILL, selected=False, maxholesize=edges)["closed_holes"], 1)
        self.assertEqual(boundary_edges(ms.current_mesh().face_matrix()), 0)


class OtherFilters(unittest.TestCase):
    def test_rims_are_selected(self):
        positions, triangles = torus()
        ms = mesh_set(positions, triangles)
        result = ms.apply_filter(SELECT)
        rims = set().union(*rim_faces(triangles))
        self.assertEqual(result, {"selected_holes": 3, "selected_vertices": 52, "selected_faces": len(rims)})
        mesh = ms.current_mesh()
        self.assertEqual(set(np.flatnonzero(mesh.face_selection_array())), rims)
        self.assertEqual(mesh.selected_vertex_number(), 52)
        np.testing.assert_array_equal(mesh.vertex_matrix(), positions)
        np.testing.assert_array_equal(mesh.face_matrix(), triangles)

    def test_rims_by_rules_and_then_filled(self):
        positions, triangles = torus()
        ms = mesh_set(positions, triangles)
        self.assertEqual(ms.apply_filter(SELECT, maxholesize=12)["selected_holes"], 1)
        self.assertEqual(ms.apply_filter(FILL, selected=True)["closed_holes"], 1)
        self.assertEqual(ms.apply_filter(SELECT, selected=False, keeplargest=1)["selected_holes"], 1)

    def test_report(self):
        positions, triangles = torus()
        ms = mesh_set(positions, triangles)
        result = ms.apply_filter(REPORT)
        self.assertEqual((result["holes"], result["rim_edges"]), (3, 52))
        self.assertGreater(result["longest_perimeter"], result["total_perimeter"] / 3)
        self.assertEqual(mesh_set(*torus(blocks=())).apply_filter(REPORT)["holes"], 0)
        np.testing.assert_array_equal(ms.current_mesh().vertex_matrix(), positions)

    def test_names_and_help(self):
        names = ml.filter_list()
        for name in (FILL, SELECT, REPORT):
            self.assertIn(name, names)
        defaults = mesh_set(*tetrahedron()).filter_parameter_values(FILL)
        self.assertEqual({name: defaults[name] for name in ("selected", "maxholesize", "keeplargest", "density", "seed",
                                                            "newfaceselected", "refuseselfintersection", "mark")},
                         {"selected": False, "maxholesize": 0, "keeplargest": 0, "density": 1.0, "seed": 0,
                          "newfaceselected": True, "refuseselfintersection": False, "mark": 0})


if __name__ == "__main__":
    unittest.main()
