#!/usr/bin/env python3
"""Requests in good form but beyond all measure: none keeps the node from answering others."""
import math
import os
import sys
import tempfile
import threading
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import Point
from soft_tissue_sim.srv import Attach, LoadState, QueryDistance, SaveState, SetMaterial, Step

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from sim_client import NODE, SimClient, wait_until

MOST_STEPS = 2**32 - 1
LARGEST = sys.float_info.max


class ExtremesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = SimClient()
        cls.client.wait_for_commands_to_arrive()

    def tearDown(self):
        answer = self.set_material(young_modulus=20000.0, poisson_ratio=0.4, density=1000.0)
        self.assertTrue(answer.success, answer.message)
        self.client.reset()
        self.client.unpause()
        self.assert_time_goes_on()

    def assert_time_goes_on(self):
        before = self.client.sim_time()
        wait_until(lambda: self.client.sim_time() > before + 0.02, "simulated time goes on")
        self.client.forget_messages()

    def call(self, name, service_class, **fields):
        return rospy.ServiceProxy(NODE + "/" + name, service_class)(**fields)

    def set_material(self, **fields):
        unchanged = dict.fromkeys(("young_modulus", "poisson_ratio", "density", "stiffening"), math.nan)
        return self.call("set_material", SetMaterial, tissue="block", **dict(unchanged, **fields))

    def in_background(self, name, service_class, **fields):
        answers = []
        thread = threading.Thread(target=lambda: answers.append(self.call(name, service_class, **fields)))
        thread.start()
        return thread, answers

    def test_a_step_that_would_take_years_can_be_ended(self):
        for end in (self.client.pause, self.client.unpause):
            self.client.pause()
            thread, answers = self.in_background("step", Step, steps=MOST_STEPS)
            self.assert_time_goes_on()
            self.client.reset()
            self.assertTrue(self.set_material(young_modulus=3e4).success)
            self.assert_time_goes_on()
            end()
            thread.join()
            self.assertFalse(answers[0].success)
            self.assertIn("of %d steps" % MOST_STEPS, answers[0].message)

    def test_a_million_points_hold_up_nobody(self):
        points = [Point(1e-7 * i, 0.0, 0.01) for i in range(1000000)]
        begun = time.monotonic()
        thread, answers = self.in_background("query_distance", QueryDistance, points=points, max_distance=LARGEST)
        while thread.is_alive():
            self.client.pause()
            self.client.unpause()
            self.assert_time_goes_on()
        print("  a million points took %.1f s with their way there and back" % (time.monotonic() - begun))
        self.assertTrue(answers[0].success)
        self.assertEqual(len(answers[0].depths), len(points))
        self.assertTrue(all(math.isfinite(depth) for depth in answers[0].depths))

    def test_points_beyond_all_measure(self):
        numbers = (LARGEST, -LARGEST, 1e200, 5e-324, math.inf, -math.inf, math.nan)
        points = [Point(x, y, 0.0) for x in numbers for y in numbers]
        answer = self.call("query_distance", QueryDistance, points=points, max_distance=1.0)
        self.assertTrue(answer.success)
        for point, depth in zip(points, answer.depths):
            if math.isfinite(point.x) and math.isfinite(point.y):
                near = max(abs(point.x), abs(point.y)) < 0.01
                self.assertTrue(math.isfinite(depth) if near else depth == -math.inf, (point, depth))

    def test_a_reach_beyond_all_measure_ties_everything(self):
        self.client.pause()
        self.assertFalse(self.call("probe/attach", Attach, reach=math.inf).success)
        tied = self.call("probe/attach", Attach, tissue="block", reach=LARGEST)
        self.assertTrue(tied.success, tied.message)
        self.assertGreater(tied.nodes, 50)
        for stiffness in (1e308, -1.0, math.nan, math.inf):
            self.assertFalse(self.call("flyer/attach", Attach, reach=0.1, stiffness=stiffness).success)
        self.assertTrue(self.call("flyer/attach", Attach, tissue="block", reach=LARGEST, stiffness=1e15).success)
        self.client.unpause()
        self.assert_time_goes_on()

    def test_materials_at_the_ends_of_their_ranges(self):
        for fields in ({"young_modulus": 1e12}, {"young_modulus": 1e-300}, {"density": 1e5}, {"density": 1e-300},
                       {"poisson_ratio": 0.499999999}, {"poisson_ratio": -0.999999},
                       {"young_modulus": 1e12, "density": 1e-300}):
            answer = self.set_material(**fields)
            self.assertTrue(answer.success, answer.message)
            self.client.command((0.0, 0.0, 0.036))
            self.assert_time_goes_on()
            min_det_f = self.client.newest["stats"].min_det_f
            print("  %s: min det F %.3g, held: %s" % (fields, min_det_f, self.client.newest["stats"].held))
            self.assertTrue(math.isfinite(min_det_f))
            self.client.reset()
        for fields in ({"young_modulus": 0.0}, {"young_modulus": 2e12}, {"density": math.inf}, {"poisson_ratio": 0.5}):
            self.assertFalse(self.set_material(**fields).success, fields)

    def test_states_of_no_files(self):
        with tempfile.TemporaryDirectory() as folder:
            pipe = os.path.join(folder, "pipe")
            os.mkfifo(pipe)
            for path in ("/dev/zero", "/dev/stdin", pipe, folder, folder + "/gone", "/" + "x" * 100000, "/\0"):
                answer = self.call("load_state", LoadState, path=path)
                self.assertFalse(answer.success, path)
                self.assert_time_goes_on()
            for path in ("/dev/full", "/proc/state", folder, folder + "/gone/state", "/" + "x" * 100000):
                self.assertFalse(self.call("save_state", SaveState, path=path).success, path)
                self.assert_time_goes_on()


if __name__ == "__main__":
    rospy.init_node("extremes_test")
    rostest.rosrun("soft_tissue_sim", "extremes_test", ExtremesTest)
