#!/usr/bin/env python3
"""The node as the source of /clock, paused from the start."""
import os
import sys
import time
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Clock

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from sim_client import SimClient, wait_for_state, wait_until


class OwnClockTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.clocks = []
        cls.subscriber = rospy.Subscriber("/clock", Clock, lambda m: cls.clocks.append(m.clock))
        cls.client = SimClient()

    def test_clock_moves_by_whole_steps_and_survives_reset(self):
        client = self.client
        first = client.step(1).time
        wait_until(lambda: self.clocks and abs(self.clocks[-1].to_sec() - first) < 1e-8, "/clock")
        last = client.step(40).time
        self.assertAlmostEqual(last - first, 40 * 0.005, places=9)
        wait_until(lambda: abs(self.clocks[-1].to_sec() - last) < 1e-8, "/clock moves on")
        client.reset()
        time.sleep(0.2)
        self.assertAlmostEqual(self.clocks[-1].to_sec(), last, places=8)
        self.assertEqual(self.clocks, sorted(self.clocks))
        self.assertAlmostEqual(client.step(1).time, last + 0.005, places=9)

    def test_messages_carry_simulated_time(self):
        client = self.client
        moment = client.step(3).time
        wait_until(lambda: abs(client.newest["stats"].header.stamp.to_sec() - moment) < 1e-8,
                   "stats with simulated time")
        self.assertAlmostEqual(wait_for_state().header.stamp.to_sec(), moment, places=8)

    def test_unpaused_it_runs(self):
        client = self.client
        before = client.step(1).time
        client.unpause()
        wait_until(lambda: client.sim_time() > before + 0.2, "time goes by")
        client.pause()


if __name__ == "__main__":
    rospy.init_node("own_clock_test")
    rostest.rosrun("soft_tissue_sim", "own_clock_test", OwnClockTest)
