#!/usr/bin/env python3
"""The node under somebody else's /clock."""
import os
import sys
import time
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Clock

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from sim_client import SimClient, wait_until

STEP_S = 0.005


class ForeignClockTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.clock = rospy.Publisher("/clock", Clock, queue_size=10)
        cls.client = SimClient()
        wait_until(lambda: cls.clock.get_num_connections() > 0, "the node hears the clock")
        cls.now = 1000.0
        wait_until(cls.first_step_seen, "the node starts with the clock")

    @classmethod
    def first_step_seen(cls):
        cls.set_clock(cls.now + STEP_S)
        time.sleep(0.05)
        return "stats" in cls.client.newest and cls.client.newest["stats"].step > 0

    @classmethod
    def set_clock(cls, seconds):
        cls.now = seconds
        cls.clock.publish(Clock(rospy.Time.from_sec(seconds)))

    def settled_time(self):
        """Simulated time once it no longer changes."""
        last = [None]

        def still():
            before, last[0] = last[0], self.client.sim_time()
            time.sleep(0.1)
            return before == last[0]

        wait_until(still, "time stands still")
        return last[0]

    def test_steps_follow_the_clock(self):
        before = self.settled_time()
        for _ in range(20):
            self.set_clock(self.now + 2 * STEP_S)
            time.sleep(0.01)
        self.set_clock(self.now + 100 * STEP_S)
        self.assertAlmostEqual(self.settled_time() - before, 140 * STEP_S, places=6)
        stamp = self.client.newest["stats"].header.stamp.to_sec()
        self.assertAlmostEqual(stamp, self.now, delta=STEP_S)

    def test_without_the_clock_nothing_moves(self):
        before = self.settled_time()
        time.sleep(0.5)
        self.assertEqual(self.client.sim_time(), before)

    def test_a_clock_that_jumps_back_is_followed_from_there(self):
        before = self.settled_time()
        self.set_clock(self.now - 500.0)
        time.sleep(0.2)
        for _ in range(10):
            self.set_clock(self.now + STEP_S)
            time.sleep(0.01)
        self.assertAlmostEqual(self.settled_time() - before, 10 * STEP_S, places=6)

    def test_a_clock_that_jumps_far_ahead_is_not_caught_up_with(self):
        before = self.settled_time()
        self.set_clock(self.now + 1.0e6)
        time.sleep(0.2)
        for _ in range(10):
            self.set_clock(self.now + STEP_S)
            time.sleep(0.01)
        self.assertAlmostEqual(self.settled_time() - before, 11 * STEP_S, places=6)


if __name__ == "__main__":
    rospy.init_node("foreign_clock_test", disable_rostime=True)
    rostest.rosrun("soft_tissue_sim", "foreign_clock_test", ForeignClockTest)
