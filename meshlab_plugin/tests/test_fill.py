# SPDX-License-Identifier: GPL-3.0-or-later
"""Fill Holes (holefill) gives the results of the library, and keeps all existing elements."""
import unittest

import numpy as np
import pymeshlab as ml

from common import (FILL, HAS_POINT_ATTRIBUTES, boundary_edges, case, fill_by_library, load, mesh_set, methods, pure, select_faces, tetrahedron,
                    torus)


class Filled(unittest.TestCase):
    def assert_as_library(self, ms, **choice):
        """Fills the current mesh by the filter. The result must be that of the library, bit for bit."""
        before = ms.current_mesh()
        positions, triangles = before.vertex_matrix(), before.face_matrix()
        names = {"max_edges": "maxholesize", "max_perimeter": "maxperimeter", "keep_largest": "keeplargest"}
        parameters = {names.get(name, name): value for name, value in choice.items()}
        if "max_perimeter" in choice:
            parameters["maxperimeter"] = pure(choice["max_perimeter"])
        result = ms.apply_filter(FILL, **parameters)
        expected_positions, expected_triangles = fill_by_library(positions, triangles, **choice)
        mesh = ms.current_mesh()
        np.testing.assert_array_equal(mesh.face_matrix(), expected_triangles)
        np.testing.assert_array_equal(mesh.vertex_matrix(), expected_positions)
        # The existing elements come first, unchanged.
        np.testing.assert_array_equal(mesh.vertex_matrix()[:len(positions)], positions)
        np.testing.assert_array_equal(mesh.face_matrix()[:len(triangles)], triangles)
        self.assertEqual(result["new_vertices"], len(expected_positions) - len(positions))
        self.assertEqual(result["new_faces"], len(expected_triangles) - len(triangles))
        return result


class Generated(Filled):
    def test_a_tetrahedron_gets_its_bottom(self):
        ms = mesh_set(*tetrahedron())
        result = self.assert_as_library(ms)
        self.assertEqual(result, {"closed_holes": 1, "failed_holes": 0, "kept_holes": 0, "new_faces": 1,
                                  "new_vertices": 0, "self_intersections": 0})
        measures = ms.get_topological_measures()
        self.assertEqual(measures["boundary_edges"], 0)
        self.assertTrue(measures["is_mesh_two_manifold"])

    def test_every_method_by_name_and_by_number(self):
        for number, method in enumerate(methods()):
            with self.subTest(method=method):
                by_name = mesh_set(*torus())
                result = self.assert_as_library(by_name, method=method)
                self.assertEqual(result["closed_holes"], 3)
                self.assertEqual(boundary_edges(by_name.current_mesh().face_matrix()), 0)
                by_number = mesh_set(*torus())
                by_number.apply_filter(FILL, method=number)
                np.testing.assert_array_equal(by_number.current_mesh().vertex_matrix(),
                                              by_name.current_mesh().vertex_matrix())

    def test_auto_is_the_default(self):
        default, auto = mesh_set(*torus()), mesh_set(*torus())
        default.apply_filter(FILL)
        auto.apply_filter(FILL, method="auto")
        np.testing.assert_array_equal(default.current_mesh().vertex_matrix(), auto.current_mesh().vertex_matrix())

    def test_density(self):
        self.assert_as_library(mesh_set(*torus()), density=2.0)
        fine, coarse = mesh_set(*torus()), mesh_set(*torus())
        self.assertGreater(fine.apply_filter(FILL, density=0.5)["new_faces"],
                           2 * coarse.apply_filter(FILL, density=2.0)["new_faces"])

    def test_parameters_of_the_library(self):
        ms = mesh_set(*torus())
        ms.apply_filter(FILL, parameters="refine.density=2  refine.grading=0.5")
        other = mesh_set(*torus())
        other.apply_filter(FILL, density=2.0)
        self.assertGreater(len(ms.current_mesh().face_matrix()), 0)

    def test_a_mesh_without_holes_stays(self):
        ms = mesh_set(*torus(blocks=()))
        self.assertEqual(ms.apply_filter(FILL)["new_faces"], 0)

    def test_a_script_can_be_saved_and_replayed(self):
        import os
        import tempfile
        with tempfile.TemporaryDirectory() as folder:
            script = os.path.join(folder, "fill.mlx")
            ms = mesh_set(*torus())
            ms.apply_filter(FILL, method="flat", keeplargest=1)
            ms.save_filter_script(script)
            again = mesh_set(*torus())
            again.load_filter_script(script)
            again.apply_filter_script()
            np.testing.assert_array_equal(ms.current_mesh().face_matrix(), again.current_mesh().face_matrix())

    def test_the_transform_of_a_layer_is_left_alone(self):
        ms = mesh_set(*torus())
        ms.compute_matrix_from_translation(traslmethod="XYZ translation", axisx=5.0, freeze=False)
        self.assert_as_library(ms)


class Cases(Filled):
    def fill(self, name, **choice):
        ms = load(case(name))
        return ms, self.assert_as_library(ms, **choice)

    def test_bunny_natural(self):
        ms, result = self.fill("bunny_natural")
        self.assertEqual((result["closed_holes"], result["failed_holes"]), (5, 0))
        self.assertEqual(boundary_edges(ms.current_mesh().face_matrix()), 0)

    def test_colored_bunny(self):
        ms = load(case("colored_bunny"))
        before = ms.current_mesh().vertex_color_matrix()
        result = self.assert_as_library(ms)
        self.assertEqual((result["closed_holes"], result["failed_holes"]), (2, 0))
        after = ms.current_mesh().vertex_color_matrix()
        np.testing.assert_array_equal(after[:len(before)], before)
        new = after[len(before):]
        self.assertGreater(len(new), 0)
        # Neither black nor the white that the host gives to new vertices.
        self.assertGreater(new[:, :3].max(axis=1).min(), 0.05)
        self.assertLess(new[:, :3].min(axis=1).max(), 0.999)
        self.assertTrue((new[:, 3] == 1).all())
        self.assertFalse(ms.current_mesh().has_face_color())

    def test_many_holes_600(self):
        ms, result = self.fill("many_holes_600")
        self.assertEqual((result["closed_holes"], result["failed_holes"]), (635, 0))
        self.assertEqual(boundary_edges(ms.current_mesh().face_matrix()), 0)

    def test_cylinder_side(self):
        # Both ends stay open.
        ms, result = self.fill("cylinder_side", max_perimeter=5.8854261545)
        self.assertEqual((result["closed_holes"], result["kept_holes"], result["failed_holes"]), (1, 2, 0))
        ms, result = self.fill("cylinder_side", keep_largest=2)
        self.assertEqual((result["closed_holes"], result["kept_holes"], result["failed_holes"]), (1, 2, 0))


def rich_mesh():
    """A torus with a value of every kind that scripts can write."""
    positions, triangles = torus()
    x, y, z = positions.T
    color = np.stack([0.5 + x / 10, 0.5 + y / 10, 0.5 + z / 4, np.full(len(x), 1.0)], -1)
    face_color = np.tile([0.2, 0.6, 0.4, 1.0], (len(triangles), 1))
    ms = mesh_set(positions, triangles, v_color_matrix=color, f_color_matrix=face_color, v_scalar_array=2 * x + y,
                  f_scalar_array=np.arange(len(triangles), dtype=np.float64))
    mesh = ms.current_mesh()
    mesh.add_vertex_custom_scalar_attribute(x - 3 * z, "height")
    mesh.add_face_custom_scalar_attribute(np.full(len(triangles), 7.0), "region")
    if HAS_POINT_ATTRIBUTES:
        mesh.add_vertex_custom_point_attribute(positions * [1, 2, 3], "place")
        mesh.add_face_custom_point_attribute(np.tile([1.0, 2.0, 3.0], (len(triangles), 1)), "axis")
    ms.compute_texcoord_by_function_per_vertex(u="x / 10 + 0.5", v="y / 10 + 0.5")
    ms.compute_texcoord_by_function_per_wedge(**wedge_functions(ms))
    select_faces(ms, "fi < 100 && fi > 20")
    return ms


def wedge_functions(ms):
    names = ms.filter_parameter_values("compute_texcoord_by_function_per_wedge")
    values = {"u0": "x0 / 10 + 0.5", "v0": "z0 / 4 + 0.5", "u1": "x1 / 10 + 0.5", "v1": "z1 / 4 + 0.5",
              "u2": "x2 / 10 + 0.5", "v2": "z2 / 4 + 0.5"}
    return {name: value for name, value in values.items() if name in names}


def values_of(mesh):
    values = {
        "vertex": mesh.vertex_matrix(),
        "face": mesh.face_matrix(),
        "vertex color": mesh.vertex_color_matrix(),
        "face color": mesh.face_color_matrix(),
        "vertex quality": mesh.vertex_scalar_array(),
        "face quality": mesh.face_scalar_array(),
        "vertex texture": mesh.vertex_tex_coord_matrix(),
        "wedge texture": mesh.wedge_tex_coord_matrix(),
        "vertex selection": mesh.vertex_selection_array(),
        "face selection": mesh.face_selection_array(),
        "face normal": mesh.face_normal_matrix(),
        "height": mesh.vertex_custom_scalar_attribute_array("height"),
        "region": mesh.face_custom_scalar_attribute_array("region"),
    }
    if HAS_POINT_ATTRIBUTES:
        values["place"] = mesh.vertex_custom_point_attribute_matrix("place")
        values["axis"] = mesh.face_custom_point_attribute_matrix("axis")
    return values


class Values(unittest.TestCase):
    def test_existing_values_stay(self):
        ms = rich_mesh()
        before, normals = values_of(ms.current_mesh()), ms.current_mesh().vertex_normal_matrix()
        rim = np.unique([v for v in self.rim(ms)])
        ms.apply_filter(FILL, selected=False, newfaceselected=False)
        after = values_of(ms.current_mesh())
        for name, value in before.items():
            with self.subTest(value=name):
                self.assertGreater(len(after[name]), len(value))
                np.testing.assert_array_equal(after[name][:len(value)], value)
        # Normals follow the faces round a vertex: those at the rims get new ones.
        changed = np.flatnonzero((ms.current_mesh().vertex_normal_matrix()[:len(normals)] != normals).any(axis=1))
        self.assertTrue(set(changed) <= set(rim))
        self.assertGreater(len(changed), 0)

    @staticmethod
    def rim(ms):
        triangles = ms.current_mesh().face_matrix()
        edges = {(int(f[k]), int(f[(k + 1) % 3])) for f in triangles for k in range(3)}
        return [a for a, b in edges if (b, a) not in edges]

    def test_new_elements_go_on_from_the_rim(self):
        ms = rich_mesh()
        vertices, faces = ms.current_mesh().vertex_number(), ms.current_mesh().face_number()
        ms.apply_filter(FILL, selected=False)
        mesh = ms.current_mesh()
        after = values_of(mesh)
        x, y, z = mesh.vertex_matrix()[vertices:].T
        # These are linear in the position. So are the interpolated values, except for rounding to a byte.
        np.testing.assert_allclose(after["vertex quality"][vertices:], 2 * x + y, atol=1e-3)
        np.testing.assert_allclose(after["height"][vertices:], x - 3 * z, atol=1e-3)
        if HAS_POINT_ATTRIBUTES:
            np.testing.assert_allclose(after["place"][vertices:], np.stack([x, 2 * y, 3 * z], -1), atol=1e-3)
            self.assertTrue((after["axis"][faces:] == [1, 2, 3]).all())
        np.testing.assert_allclose(after["vertex color"][vertices:, 0], 0.5 + x / 10, atol=1.5 / 255)
        np.testing.assert_allclose(after["vertex texture"][vertices:, 0], 0.5 + x / 10, atol=1e-4)
        # Copies of the nearest face's.
        self.assertTrue((after["region"][faces:] == 7).all())
        np.testing.assert_array_equal(after["face color"][faces:], np.tile(after["face color"][0], (len(after["face"]) - faces, 1)))
        self.assertTrue((np.isin(after["face quality"][faces:], np.arange(faces))).all())
        # The coordinates of a corner depend on its position.
        corners = after["face"][faces:].reshape(-1)
        places = mesh.vertex_matrix()[corners]
        wedges = after["wedge texture"][3 * faces:]
        np.testing.assert_allclose(wedges[:, 0], places[:, 0] / 10 + 0.5, atol=1e-4)
        np.testing.assert_allclose(wedges[:, 1], places[:, 2] / 4 + 0.5, atol=1e-4)

    def test_normals_point_outward(self):
        ms = mesh_set(*torus())
        vertices, faces = ms.current_mesh().vertex_number(), ms.current_mesh().face_number()
        ms.apply_filter(FILL)
        mesh = ms.current_mesh()
        p = mesh.vertex_matrix()
        ring = p * [1, 1, 0]
        ring *= 3 / np.linalg.norm(ring, axis=1)[:, None]
        outward = p - ring
        outward /= np.linalg.norm(outward, axis=1)[:, None]
        normals = mesh.vertex_normal_matrix()
        normals = normals / np.linalg.norm(normals, axis=1)[:, None]
        self.assertGreater((normals * outward).sum(axis=1).min(), 0.9)
        corner = mesh.face_matrix()[faces:, 0]
        self.assertGreater((mesh.face_normal_matrix()[faces:] * outward[corner]).sum(axis=1).min(), 0.8)
        np.testing.assert_allclose(np.linalg.norm(mesh.face_normal_matrix(), axis=1), 1, atol=1e-9)
        self.assertEqual(len(normals), len(p))
        self.assertGreater(len(p), vertices)

    def test_values_that_are_not_carried_are_neutral(self):
        ms = rich_mesh()
        vertices, faces = ms.current_mesh().vertex_number(), ms.current_mesh().face_number()
        ms.apply_filter(FILL, selected=False, carrycolor=False, carryquality=False, carrytexture=False,
                        carryattributes=False)
        after = values_of(ms.current_mesh())
        self.assertTrue((after["vertex color"][vertices:] == 1).all())
        self.assertTrue((after["face color"][faces:] == 1).all())
        for name in {"vertex quality", "height", "place", "vertex texture"} & set(after):
            self.assertTrue((after[name][vertices:] == 0).all(), name)
        for name in {"face quality", "region", "axis"} & set(after):
            self.assertTrue((after[name][faces:] == 0).all(), name)
        self.assertTrue((after["wedge texture"][3 * faces:] == 0).all())

    def test_nothing_is_added_to_a_plain_mesh(self):
        ms = mesh_set(*torus())
        before = ms.current_mesh()
        have = ("has_face_color", "has_face_scalar", "has_vertex_tex_coord", "has_wedge_tex_coord", "has_vertex_color")
        state = [getattr(before, name)() for name in have]
        ms.apply_filter(FILL)
        self.assertEqual([getattr(ms.current_mesh(), name)() for name in have], state)

    def test_the_box_grows_with_the_patch(self):
        # Half a sphere: the cap that is missing is its top.
        ms = ml.MeshSet()
        ms.create_sphere(subdiv=4)
        ms.compute_selection_by_condition_per_face(condselect="z0 > 0.5 || z1 > 0.5 || z2 > 0.5")
        ms.meshing_remove_selected_faces()
        ms.meshing_remove_unreferenced_vertices()
        height = ms.current_mesh().bounding_box().max()[2]
        self.assertLess(height, 0.6)
        ms.apply_filter(FILL)
        self.assertGreater(ms.current_mesh().bounding_box().max()[2], 0.9)

    def test_deleted_elements_are_left_out(self):
        # Elements that other filters delete may stay in the host's lists.
        ms = mesh_set(*torus(blocks=()))
        select_faces(ms, "fi >= 100 && fi < 110")
        ms.meshing_remove_selected_faces()
        count = ms.current_mesh().face_number()
        result = ms.apply_filter(FILL)
        self.assertGreaterEqual(result["closed_holes"], 1)
        self.assertEqual(ms.current_mesh().face_number(), count + result["new_faces"])
        self.assertEqual(boundary_edges(ms.current_mesh().face_matrix()), 0)

    def test_new_elements_are_selected(self):
        ms = rich_mesh()
        vertices, faces = ms.current_mesh().vertex_number(), ms.current_mesh().face_number()
        ms.apply_filter(FILL, selected=False)
        mesh = ms.current_mesh()
        np.testing.assert_array_equal(np.flatnonzero(mesh.face_selection_array()), np.arange(faces, mesh.face_number()))
        np.testing.assert_array_equal(np.flatnonzero(mesh.vertex_selection_array()),
                                      np.arange(vertices, mesh.vertex_number()))

    def test_marks(self):
        ms = mesh_set(*torus())
        vertices, faces = ms.current_mesh().vertex_number(), ms.current_mesh().face_number()
        ms.apply_filter(FILL, mark="quality", markquality=5.0)
        mesh = ms.current_mesh()
        self.assertTrue((mesh.face_scalar_array()[faces:] == 5).all() and (mesh.vertex_scalar_array()[vertices:] == 5).all())
        self.assertTrue((mesh.face_scalar_array()[:faces] == 0).all() and (mesh.vertex_scalar_array()[:vertices] == 0).all())
        ms = mesh_set(*torus())
        ms.apply_filter(FILL, mark="color", markcolor=ml.Color(255, 0, 0))
        mesh = ms.current_mesh()
        self.assertTrue((mesh.face_color_matrix()[faces:] == [1, 0, 0, 1]).all())
        self.assertTrue((mesh.face_color_matrix()[:faces] == 1).all())
        self.assertTrue((mesh.vertex_color_matrix()[vertices:] == [1, 0, 0, 1]).all())
        self.assertTrue((mesh.vertex_color_matrix()[:vertices] == 1).all())


if __name__ == "__main__":
    unittest.main()
