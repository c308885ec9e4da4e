#!/usr/bin/env python3
"""The node under somebody else's /clock."""
import contextlib
import glob
import math
import os
import signal
import sys
import time
import unittest
import xmlrpc.client

import rospy
import rostest
from rosgraph_msgs.msg import Clock

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from sim_client import NODE, SimClient, wait_until

STEP_S = 0.005
ABOVE = (0.0, 0.0, 0.05)


def thread_states(pid):
    """What the threads of a process do, as the letters of proc(5); a signal to stop takes a while."""
    states = set()
    for path in glob.glob("/proc/%d/task/*/stat" % pid):
        with open(path) as stat:
            states.add(stat.read().rpartition(")")[2].split()[0])
    return states


class ForeignClockTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.clock = rospy.Publisher("/clock", Clock, queue_size=10)
        cls.client = SimClient()
        cls.client.wait_for_commands_to_arrive()
        wait_until(lambda: cls.clock.get_num_connections() > 0, "the node hears the clock")
        cls.now = 1000.0
        wait_until(cls.first_step_seen, "the node starts with the clock")

    @classmethod
    def first_step_seen(cls):
        cls.tick(1)
        return cls.client.newest["stats"].step > 0

    @classmethod
    def set_clock(cls, seconds):
        cls.now = seconds
        cls.clock.publish(Clock(rospy.Time.from_sec(seconds)))

    @classmethod
    def tick(cls, steps):
        cls.set_clock(cls.now + steps * STEP_S)

    def setUp(self):
        self.tick(1)
        wait_until(lambda: abs(self.client.newest["stats"].header.stamp.to_sec() - self.now) < 1e-6,
                   "the node is where the clock is")
        self.start = self.client.sim_time()

    def assert_simulated(self, steps):
        """So many steps are simulated since the test started, and for some time no more."""
        expected = self.start + steps * STEP_S
        wait_until(lambda: self.client.sim_time() > expected - 0.5 * STEP_S,
                   "%d steps from %f s on" % (steps, self.start))
        time.sleep(0.2)
        self.assertAlmostEqual(self.client.sim_time(), expected, places=6)

    def assert_counted(self, key, count):
        wait_until(lambda: self.client.count("physics", key) >= count, key)
        self.assertEqual(self.client.count("physics", key), count)

    def jump_back(self, seconds):
        """Sets the clock back and waits until the node noticed: a clock's ticks may be skipped."""
        jumps = self.client.count("physics", "clock jumps back")
        self.set_clock(self.now - seconds)
        self.assert_counted("clock jumps back", jumps + 1)

    def test_steps_follow_the_clock(self):
        for _ in range(20):
            self.tick(2)
            time.sleep(0.01)
        self.tick(100)
        self.assert_simulated(140)
        stamp = self.client.newest["stats"].header.stamp.to_sec()
        self.assertAlmostEqual(stamp, self.now, places=6)

    def test_a_node_that_was_held_up_catches_up(self):
        with self.stopped_node():
            for _ in range(20):
                self.tick(2)
            self.tick(100)
            time.sleep(0.3)
            self.assertEqual(self.client.sim_time(), self.start)
        self.assert_simulated(140)

    @contextlib.contextmanager
    def stopped_node(self):
        _, _, uri = rospy.get_master().lookupNode(NODE)
        _, _, pid = xmlrpc.client.ServerProxy(uri).getPid(rospy.get_name())
        os.kill(pid, signal.SIGSTOP)
        try:
            wait_until(lambda: thread_states(pid) == {"T"}, "every thread of the node stops")
            yield
        finally:
            os.kill(pid, signal.SIGCONT)

    def test_without_the_clock_nothing_moves(self):
        time.sleep(0.5)
        self.assertEqual(self.client.sim_time(), self.start)

    def test_a_clock_that_jumps_back_is_followed_from_there(self):
        self.jump_back(500.0)
        for _ in range(10):
            self.tick(1)
            time.sleep(0.01)
        self.assert_simulated(10)

    def test_commands_are_obeyed_after_the_clock_jumped_back(self):
        def obeyed(position):
            self.tick(1)
            self.client.command(position, stamp=rospy.Time.from_sec(self.now))
            return math.dist(self.client.position(), position) < 1e-9

        wait_until(lambda: obeyed(ABOVE), "a command before the jump")
        before = self.now
        self.jump_back(500.0)
        wait_until(lambda: obeyed((0.0, 0.0, 0.055)), "a command after the jump")
        self.assertLess(self.now, before)

    def test_a_clock_that_jumps_far_ahead_is_not_caught_up_with(self):
        self.set_clock(self.now + 1.0e6)
        self.assert_simulated(1)
        for _ in range(10):
            self.tick(1)
            time.sleep(0.01)
        self.assert_simulated(11)


if __name__ == "__main__":
    rospy.init_node("foreign_clock_test", disable_rostime=True)
    rostest.rosrun("soft_tissue_sim", "foreign_clock_test", ForeignClockTest)
