#!/usr/bin/env python3
"""The palpation scripts: heights, normals and way points against geometry, presses against made-up forces."""
import argparse
import math
import os
import sys
import unittest

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scripts"))
import palpate
import plot_palpation
import without_regions

# A roof over the unit square: z = 0.1 + 0.2 x, as two triangles of which one is wound the other way.
ROOF = np.array([[0.0, 0.0, 0.1], [1.0, 0.0, 0.3], [1.0, 1.0, 0.3], [0.0, 1.0, 0.1]])
ROOF_TRIANGLES = np.array([[0, 1, 2], [0, 3, 2]])


class Palpate(unittest.TestCase):
    def test_height_is_interpolated_and_minus_infinity_beside(self):
        found = palpate.height(ROOF, ROOF_TRIANGLES,
                                     np.array([[0.25, 0.5], [0.9, 0.1], [1.5, 0.5]]))
        self.assertAlmostEqual(found[0], 0.15)
        self.assertAlmostEqual(found[1], 0.28)
        self.assertEqual(found[2], -np.inf)

    def test_ball_touches_a_slope_beside_its_lowest_point(self):
        # On a plane of slope s the ball's centre is r sqrt(1 + s^2) above the plane.
        radius = 0.05
        exact = 0.2 + radius * (math.sqrt(1.0 + 0.2**2) - 1.0)
        found = palpate.touch_height(ROOF, ROOF_TRIANGLES, np.array([0.5, 0.5]), radius)
        self.assertAlmostEqual(found, exact, delta=0.01 * radius)
        self.assertLessEqual(found, exact + 1e-12)

    def test_normal_of_a_slope_and_the_point_on_it(self):
        point, normal = palpate.surface_point(ROOF, ROOF_TRIANGLES, np.array([0.5, 0.4]), 0.1)
        np.testing.assert_allclose(point, [0.5, 0.4, 0.2], atol=1e-12)
        np.testing.assert_allclose(normal, np.array([-0.2, 0.0, 1.0]) / math.sqrt(1.04), atol=1e-12)

    def test_turn_leads_the_z_axis_to_the_normal_the_short_way(self):
        normal = np.array([2.0, -3.0, 6.0]) / 7.0
        axes = palpate.matrix(palpate.turn_to(normal))
        np.testing.assert_allclose(axes[:, 2], normal, atol=1e-12)
        np.testing.assert_allclose(axes.T @ axes, np.eye(3), atol=1e-12)
        self.assertAlmostEqual(np.linalg.det(axes), 1.0)
        self.assertAlmostEqual(np.trace(axes), 1.0 + 2.0 * normal[2])  # of a turn by the angle between them

    def test_tip_that_comes_along_the_normal_touches_a_plane_with_its_foremost_point(self):
        tip, turn = palpate.touch(ROOF, ROOF_TRIANGLES, np.array([0.5, 0.5]), 0.05)
        np.testing.assert_allclose(tip, [0.5, 0.5, 0.2], atol=1e-9)
        np.testing.assert_allclose(palpate.matrix(turn)[:, 2], np.array([-0.2, 0.0, 1.0]) / math.sqrt(1.04), atol=1e-9)

    def test_surface_of_two_tets_leaves_their_common_face_out(self):
        tets = np.array([[0, 1, 2, 3], [1, 2, 3, 4]])
        triangles = palpate.surface_triangles(tets)
        self.assertEqual(len(triangles), 6)
        self.assertNotIn([1, 2, 3], np.sort(triangles, axis=1).tolist())

    def test_raster_goes_there_and_back(self):
        self.assertEqual([xy.tolist() for xy in palpate.raster((0.0, 1.0, 0.0, 1.0), (2, 2))],
                         [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])

    @staticmethod
    def arguments(**changed):
        given = dict(region=(0.3, 0.7, 0.3, 0.7), grid=(3, 2), depth_m=0.004, radius_m=0.01, clearance_m=0.002,
                     press_s=0.3, hold_s=0.1, release_s=0.2, travel_m_per_s=0.1, rate_hz=100.0)
        return argparse.Namespace(**{**given, **changed})

    def test_every_press_goes_its_depth_below_the_slope_and_is_held(self):
        way = palpate.palpation_path(self.arguments(), ROOF, ROOF_TRIANGLES)
        self.assertTrue((np.diff(way[:, 0]) > 0.0).all())
        above = (way[:, 3] - 0.1 - 0.2 * way[:, 1]) / math.sqrt(1.04)  # distance from the roof's plane
        self.assertAlmostEqual(above.min(), -0.004)
        deep = np.flatnonzero(np.isclose(above, -0.004))
        self.assertEqual(len(deep), 2 * 6)
        np.testing.assert_allclose(np.diff(way[deep, 0])[::2], 0.1)
        np.testing.assert_allclose(way[deep[::2], 0] - way[deep[::2] - 1, 0], 0.3)
        np.testing.assert_allclose(above[deep[::2] - 1], 0.002)

    def test_path_can_be_repeated_without_a_jump(self):
        way = palpate.palpation_path(self.arguments(), ROOF, ROOF_TRIANGLES)
        np.testing.assert_allclose(way[0, 1:], way[-1, 1:])
        self.assertGreater(way[0, 3], ROOF[:, 2].max())

    def test_poses_stay_on_the_straight_way_and_their_turns_are_unit(self):
        upright, tilted = [0.0, 0.0, 0.0, 1.0], palpate.turn_to(np.array([0.6, 0.0, 0.8])).tolist()
        way = np.array([[0.0, 0.0, 0.0, 0.0] + upright, [1.0, 0.1, 0.2, 0.4] + tilted])
        sent = list(palpate.poses(self.arguments(), way))
        self.assertEqual(len(sent), 100)
        time, message = sent[50]
        self.assertAlmostEqual(time, 0.5)
        self.assertAlmostEqual(message.pose.position.z, 0.2)
        q = message.pose.orientation
        self.assertAlmostEqual(q.x**2 + q.y**2 + q.z**2 + q.w**2, 1.0)
        self.assertAlmostEqual(2.0 * math.asin(q.y), 0.5 * math.asin(0.6))

    def test_pressing_beside_the_tissue_is_an_error(self):
        with self.assertRaises(ValueError):
            palpate.palpation_path(self.arguments(region=(2.0, 3.0, 2.0, 3.0), grid=(1, 1)), ROOF, ROOF_TRIANGLES)


class PlotPalpation(unittest.TestCase):
    @staticmethod
    def columns(force, z):
        zero = np.zeros(len(force))
        return {"p_x_m": zero + 0.01, "p_y_m": zero, "p_z_m": np.array(z),
                "p_force_x_n": zero, "p_force_y_n": zero, "p_force_z_n": np.array(force)}

    def test_presses_are_told_apart_with_peak_and_depth(self):
        columns = self.columns([0, 1, 3, 2, 0, 0, 2, 5, 0],
                               [9, 8, 7, 8, 9, 9, 8, 6, 9])
        presses = plot_palpation.find_presses(columns, "p")
        self.assertEqual([press.peak_n for press in presses], [3.0, 5.0])
        self.assertEqual(presses[0].depth_m.tolist(), [0.0, 1.0, 2.0])
        self.assertEqual(presses[1].force_n.tolist(), [0.0, 2.0, 5.0])
        self.assertEqual(plot_palpation.first_tool(columns), "p")

    def test_depth_is_the_way_along_a_tilted_probe(self):
        columns = self.columns([0, 1, 2, 0], [4, 0, -4, 4])
        columns["p_x_m"] = np.array([3.0, 0.0, -3.0, 3.0])
        press, = plot_palpation.find_presses(columns, "p")
        np.testing.assert_allclose(press.depth_m, [0.0, 5.0, 10.0])
        self.assertEqual(press.x_m, 3.0)

    SQUARE = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]], dtype=float)

    @staticmethod
    def press(x, peak):
        return plot_palpation.Press(x, 0.0, peak, np.zeros(1), np.zeros(1))

    def test_figures_compare_the_strongest_press_over_the_region_with_the_same_press_without_it(self):
        presses = [self.press(0.0, 6.0), self.press(0.5, 8.0), self.press(3.0, 9.0)]
        others = [self.press(0.0, 5.0), self.press(0.5, 4.0), self.press(3.0, 9.0)]
        found = plot_palpation.figures(presses, others, [self.SQUARE])
        self.assertEqual(found["strongest_over_stiff_region"],
                         {"x_m": 0.5, "y_m": 0.0, "peak_n": 8.0, "peak_without_n": 4.0, "ratio": 2.0})
        self.assertEqual(found["strongest_elsewhere"]["peak_n"], 9.0)
        alone = plot_palpation.figures(presses, None, [])
        self.assertIsNone(alone["strongest_over_stiff_region"])
        self.assertNotIn("ratio", alone["strongest_elsewhere"])

    def test_presses_at_other_places_are_not_compared(self):
        presses = [self.press(0.0, 1.0), self.press(0.5, 1.0)]
        plot_palpation.need_same_places(presses, [self.press(0.0, 2.0), self.press(0.5005, 3.0)])
        with self.assertRaises(ValueError):
            plot_palpation.need_same_places(presses, presses[:1])
        with self.assertRaises(ValueError):
            plot_palpation.need_same_places(presses, [self.press(0.0, 2.0), self.press(0.502, 3.0)])

    def test_a_probe_that_never_touches_is_an_error(self):
        with self.assertRaises(ValueError):
            plot_palpation.find_presses(self.columns([0, 0], [1, 1]), "p")

    def test_hull_of_a_square_with_points_inside(self):
        points = np.array([[0, 0], [1, 0], [0.5, 0.5], [1, 1], [0, 1], [0.2, 0.7]], dtype=float)
        outline = plot_palpation.hull(points)
        self.assertEqual(outline[0].tolist(), outline[-1].tolist())
        self.assertEqual(sorted(map(tuple, outline[:-1])), [(0, 0), (0, 1), (1, 0), (1, 1)])


class WithoutRegions(unittest.TestCase):
    def test_only_the_regions_go(self):
        scene = {"time_step_s": 0.01, "tissues": [{"name": "a", "regions": [{"tag": 2}]}, {"name": "b"}]}
        self.assertEqual(without_regions.without_regions(scene),
                         {"time_step_s": 0.01, "tissues": [{"name": "a"}, {"name": "b"}]})

    def test_a_scene_without_any_is_an_error(self):
        with self.assertRaises(ValueError):
            without_regions.without_regions({"tissues": [{"name": "a"}]})


if __name__ == "__main__":
    unittest.main()
