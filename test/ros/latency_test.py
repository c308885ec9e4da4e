#!/usr/bin/env python3
"""How late a wrench is after the pose that made it, at a kilohertz of commands; what subscribers cost the physics.

The times are printed, not asserted: they are the machine's. LATENCY_S tells for how many seconds each is measured.
"""
import bisect
import os
import signal
import statistics
import subprocess
import sys
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped, WrenchStamped
from soft_tissue_sim.msg import SimStats

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from sim_client import NODE, SimClient, wait_until

LATENCY_S = float(os.environ.get("LATENCY_S", 4))
PERIOD_S = 0.001
SPEED_M_PER_S = 1e-3
TOP_Z = 0.0375  # the ball's centre where it touches, less what it is pressed down
TOPICS = ("block/state", "block/field", "markers", "probe/contacts", "stats")


def percentile(values, fraction):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(fraction * len(ordered)))]


class LatencyTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = SimClient({"stats": SimStats})
        cls.client.wait_for_commands_to_arrive()

    def command_for(self, seconds, place):
        """Commands at a kilohertz; when each was sent, and where to."""
        sent = []
        start = time.monotonic()
        for i in range(int(seconds / PERIOD_S)):
            due = start + i * PERIOD_S
            while time.monotonic() < due:
                time.sleep(max(0.0, min(due - time.monotonic(), 2e-4)))
            position = place(i * PERIOD_S)
            sent.append((time.monotonic(), position))
            self.client.command(position)
        return sent

    def test_wrench_follows_pose(self):
        # The ball sinks at an even pace: where it is when a wrench comes tells which command that wrench answers.
        seen = []

        def take(message):
            seen.append((time.monotonic(), message.header.stamp.to_nsec()))

        poses = {}
        wrenches = rospy.Subscriber(NODE + "/probe/spatial/measured_cf", WrenchStamped, take, queue_size=1000,
                                    tcp_nodelay=True)
        where = rospy.Subscriber(NODE + "/probe/measured_cp", PoseStamped,
                                 lambda m: poses.__setitem__(m.header.stamp.to_nsec(), m.pose.position.z),
                                 queue_size=1000, tcp_nodelay=True)
        wait_until(lambda: len(seen) > 10 and len(poses) > 10, "poses and wrenches")
        newest = lambda: poses[max(poses)]
        self.client.command_until(lambda: abs(newest() - TOP_Z) < 1e-9, "the ball is at the top", (0.0, 0.0, TOP_Z))
        seen.clear()
        sent = self.command_for(LATENCY_S, lambda t: (0.0, 0.0, TOP_Z - SPEED_M_PER_S * t))
        time.sleep(0.2)
        wrenches.unregister()
        where.unregister()
        depths = [TOP_Z - position[2] for _, position in sent]
        latencies = []
        for arrived, stamp in seen:
            depth = TOP_Z - poses.get(stamp, TOP_Z)
            command = bisect.bisect_left(depths, depth - 1e-9)
            if depth > 1e-6 and 0 < command < len(depths) - 1 and depth < depths[-1] - 1e-6:
                before, after = depths[command - 1], depths[command]
                share = (depth - before) / (after - before)
                when = sent[command - 1][0] + share * (sent[command][0] - sent[command - 1][0])
                latencies.append(arrived - when)
        print("  pose in, wrench out at 1 kHz, %d wrenches: median %.2f ms, 99 %% %.2f ms" % (
            len(latencies), 1e3 * statistics.median(latencies), 1e3 * percentile(latencies, 0.99)))
        self.assertGreater(len(latencies), 0.2 * len(sent))
        self.assertGreater(min(latencies), 0.0)  # no answer before its question

    def step_ms(self):
        """Median time of a step while commands come in."""
        times = []

        def place(t):
            times.append(self.client.newest["stats"].step_ms)
            return (0.0, 0.0, TOP_Z - 1e-3)

        self.command_for(LATENCY_S / 8, place)
        return statistics.median(times)

    def test_subscribers_do_not_slow_the_physics(self):
        alone, with_listeners = [], []
        self.step_ms()
        for _ in range(4):
            alone.append(self.step_ms())
            listeners = [subprocess.Popen(["rostopic", "echo", NODE + "/" + topic], stdout=subprocess.PIPE)
                         for topic in TOPICS]
            try:
                for listener in listeners:
                    listener.stdout.readline()  # it listens
                listeners[0].send_signal(signal.SIGSTOP)
                with_listeners.append(self.step_ms())
            finally:
                for listener in listeners:
                    listener.kill()
                    listener.communicate()
        ratio = statistics.median(b / a for a, b in zip(alone, with_listeners))
        print("  a step takes %.3f ms alone, %.3f ms with %d subscribers of which one is stopped: %.3f times" % (
            statistics.median(alone), statistics.median(with_listeners), len(TOPICS), ratio))
        self.assertFalse(self.client.newest["stats"].held)


if __name__ == "__main__":
    rospy.init_node("latency_test")
    rostest.rosrun("soft_tissue_sim", "latency_test", LatencyTest)
