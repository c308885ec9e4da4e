#!/usr/bin/env python3
"""The palpation scripts: heights and way points against geometry, presses against made-up forces."""
import argparse
import math
import os
import sys
import unittest

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scripts"))
import palpate
import plot_palpation

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
        found = palpate.touch_height(ROOF, ROOF_TRIANGLES, 0.5, 0.5, radius)
        self.assertAlmostEqual(found, exact, delta=0.01 * radius)
        self.assertLessEqual(found, exact + 1e-12)

    def test_surface_of_two_tets_leaves_their_common_face_out(self):
        tets = np.array([[0, 1, 2, 3], [1, 2, 3, 4]])
        triangles = palpate.surface_triangles(tets)
        self.assertEqual(len(triangles), 6)
        self.assertNotIn([1, 2, 3], np.sort(triangles, axis=1).tolist())

    def test_raster_goes_there_and_back(self):
        self.assertEqual(list(palpate.raster((0.0, 1.0, 0.0, 1.0), (2, 2))),
                         [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])

    def test_every_press_reaches_its_depth_and_times_ascend(self):
        flat = ROOF * np.array([1.0, 1.0, 0.0])
        arguments = argparse.Namespace(
            region=(0.3, 0.7, 0.3, 0.7), grid=(3, 2), depth_m=0.004, radius_m=0.01,
            clearance_m=0.002, press_s=0.3, hold_s=0.1, travel_m_per_s=0.1)
        way = palpate.palpation_path(arguments, flat, ROOF_TRIANGLES)
        self.assertTrue((np.diff(way[:, 0]) > 0.0).all())
        self.assertEqual(np.count_nonzero(np.isclose(way[:, 3], -0.004)), 2 * 6)
        self.assertAlmostEqual(way[:, 3].min(), -0.004)

    def test_pressing_beside_the_tissue_is_an_error(self):
        arguments = argparse.Namespace(region=(2.0, 3.0, 2.0, 3.0), grid=(1, 1), radius_m=0.01)
        with self.assertRaises(ValueError):
            palpate.palpation_path(arguments, ROOF, ROOF_TRIANGLES)


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

    def test_a_probe_that_never_touches_is_an_error(self):
        with self.assertRaises(ValueError):
            plot_palpation.find_presses(self.columns([0, 0], [1, 1]), "p")

    def test_hull_of_a_square_with_points_inside(self):
        points = np.array([[0, 0], [1, 0], [0.5, 0.5], [1, 1], [0, 1], [0.2, 0.7]], dtype=float)
        outline = plot_palpation.hull(points)
        self.assertEqual(outline[0].tolist(), outline[-1].tolist())
        self.assertEqual(sorted(map(tuple, outline[:-1])), [(0, 0), (0, 1), (1, 0), (1, 1)])


if __name__ == "__main__":
    unittest.main()
