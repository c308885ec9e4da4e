#!/usr/bin/env python3
"""The node at full rate for long: its memory stays flat and it opens nothing that it doesn't close.

SOAK_S tells for how many simulated seconds; an hour is 3600. SOAK_GUESTS tells how many subscribers come and go.
"""
import math
import os
import statistics
import sys
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import Point
from soft_tissue_sim.msg import SimStats, TissueField, TissueState
from soft_tissue_sim.srv import QueryDistance, QueryDistanceRequest
from visualization_msgs.msg import MarkerArray

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import tcpros
from node_process import files_of, memory_of, node_process
from raw_messages import serialized
from sim_client import NODE, SimClient, wait_until

SOAK_S = float(os.environ.get("SOAK_S", 30))
GUESTS = int(os.environ.get("SOAK_GUESTS", 4000))
WARM_UP = 0.25         # of the time
KNOWN_GUESTS = 0.5     # of the guests: until then the allocator takes more, be it for them or for the steps beside them
MOST_GROWTH = 4 << 20  # bytes: what allocators keep of messages, however long it takes
WINDOWS = 20
MOST_A_GUEST = 512     # bytes, in the median of those of so many windows that come after warming up


class SoakTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = SimClient()
        cls.client.wait_for_commands_to_arrive()
        cls.pid = node_process()

    def move(self):
        t = self.client.sim_time()
        self.client.command((0.01 * math.cos(t), 0.01 * math.sin(t), 0.037 + 0.003 * math.cos(3.0 * t)))
        self.client.forget_messages()

    def check_guests(self, what, visit):
        """Those who come and go leave less behind than the least that could be forgotten of each.

        An allocator takes a megabyte more now and then, whoever comes; what is forgotten of each grows all the time.
        """
        memory, files = [], None
        for number in range(GUESTS):
            visit()
            if number == int(KNOWN_GUESTS * GUESTS):
                files = files_of(self.pid)
            if number >= KNOWN_GUESTS * GUESTS and number % (GUESTS // WINDOWS) == 0:
                memory.append(memory_of(self.pid))
            if number % 100 == 0:
                self.move()
        wait_until(lambda: files_of(self.pid) <= files, "files are closed again")
        each = statistics.median(b - a for a, b in zip(memory, memory[1:])) / (GUESTS // WINDOWS)
        print("  %d %s came and went: %.1f MB, %+.2f MB after warming up, %+.0f bytes for each" % (
            GUESTS, what, memory[-1] / 1e6, (memory[-1] - memory[0]) / 1e6, each))
        self.assertLess(each, MOST_A_GUEST)

    def test_subscribers_leave_nothing(self):
        def visit():
            address = tcpros.topic_address(NODE, NODE + "/stats")
            subscriber = tcpros.Subscriber(address, NODE + "/stats", SimStats)
            subscriber.read()  # the header
            subscriber.read()  # the newest step
            subscriber.close()

        self.check_guests("subscribers", visit)

    def test_callers_leave_nothing(self):
        request = serialized(QueryDistanceRequest(max_distance=0.1))

        def visit():
            service = tcpros.Service(NODE + "/query_distance", QueryDistance)
            service.send([request])
            (understood, _), = service.receive()
            self.assertTrue(understood)
            service.close()

        self.check_guests("callers of a service", visit)

    def test_memory_and_files_stay_flat(self):
        client, pid = self.client, self.pid
        query = rospy.ServiceProxy(NODE + "/query_distance", QueryDistance)
        listeners = {"markers": MarkerArray, "block/state": TissueState, "block/field": TissueField}
        for topic, message_type in listeners.items():
            rospy.Subscriber(NODE + "/" + topic, message_type, lambda message: None, queue_size=1)
        start = client.sim_time()
        warm, told, end = None, 0, start + SOAK_S
        while warm is None or client.sim_time() < end:
            self.move()
            comes_and_goes = rospy.Subscriber(NODE + "/markers", MarkerArray, lambda message: None)
            query(points=[Point(0.0, 0.0, 0.01)], max_distance=0.1)
            time.sleep(0.02)
            comes_and_goes.unregister()
            done = (client.sim_time() - start) / SOAK_S
            if warm is None and done > WARM_UP:
                warm = (memory_of(pid), files_of(pid))
                end = client.sim_time() + (1.0 - WARM_UP) * SOAK_S
            if done > told:
                told += 0.05
                print("  %.0f s: %.2f MB, %d files" % (done * SOAK_S, memory_of(pid) / 1e6, files_of(pid)), flush=True)
        wait_until(lambda: files_of(pid) <= warm[1] + 1, "files are closed again")
        growth = memory_of(pid) - warm[0]
        print("  %.0f s simulated: %.1f MB, grown by %.2f MB since %.0f s; %d files, were %d" % (
            end - start, memory_of(pid) / 1e6, growth / 1e6, end - start - (1.0 - WARM_UP) * SOAK_S, files_of(pid), warm[1]))
        self.assertLess(growth, MOST_GROWTH)
        self.assertEqual(client.newest["stats"].held, False)


if __name__ == "__main__":
    rospy.init_node("soak_test")
    rostest.rosrun("soft_tissue_sim", "soak_test", SoakTest)
