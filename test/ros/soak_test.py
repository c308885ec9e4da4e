#!/usr/bin/env python3
"""The node at full rate for long: its memory stays flat and it opens nothing that it doesn't close.

SOAK_S tells for how many simulated seconds; an hour is 3600.
"""
import math
import os
import sys
import time
import unittest
import xmlrpc.client

import rosgraph
import rospy
import rostest
from geometry_msgs.msg import Point
from soft_tissue_sim.msg import TissueField, TissueState
from soft_tissue_sim.srv import QueryDistance
from visualization_msgs.msg import MarkerArray

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from sim_client import NODE, SimClient, wait_until

SOAK_S = float(os.environ.get("SOAK_S", 30))
WARM_UP = 0.25  # of it
MOST_GROWTH = 4 << 20  # bytes: what allocators keep of short-lived subscribers and messages


def node_process():
    node = xmlrpc.client.ServerProxy(rosgraph.Master(rospy.get_name()).lookupNode(NODE))
    code, message, pid = node.getPid(rospy.get_name())
    assert code == 1, message
    return pid


def memory_of(pid):
    with open("/proc/%d/statm" % pid) as stream:
        return int(stream.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def files_of(pid):
    return len(os.listdir("/proc/%d/fd" % pid))


class SoakTest(unittest.TestCase):
    def test_memory_and_files_stay_flat(self):
        client = SimClient()
        client.wait_for_commands_to_arrive()
        pid = node_process()
        query = rospy.ServiceProxy(NODE + "/query_distance", QueryDistance)
        listeners = {"markers": MarkerArray, "block/state": TissueState, "block/field": TissueField}
        for topic, message_type in listeners.items():
            rospy.Subscriber(NODE + "/" + topic, message_type, lambda message: None, queue_size=1)
        start = client.sim_time()
        warm = None
        while client.sim_time() < start + SOAK_S:
            t = client.sim_time()
            client.command((0.01 * math.cos(t), 0.01 * math.sin(t), 0.037 + 0.003 * math.cos(3.0 * t)))
            comes_and_goes = rospy.Subscriber(NODE + "/markers", MarkerArray, lambda message: None)
            query(points=[Point(0.0, 0.0, 0.01)], max_distance=0.1)
            time.sleep(0.02)
            comes_and_goes.unregister()
            client.forget_messages()
            if warm is None and t > start + WARM_UP * SOAK_S:
                warm = (memory_of(pid), files_of(pid))
        wait_until(lambda: files_of(pid) <= warm[1] + 1, "files are closed again")
        growth = memory_of(pid) - warm[0]
        print("  %.0f s simulated: %.1f MB, grown by %.2f MB since %.0f s; %d files, were %d" % (
            SOAK_S, memory_of(pid) / 1e6, growth / 1e6, WARM_UP * SOAK_S, files_of(pid), warm[1]))
        self.assertLess(growth, MOST_GROWTH)
        self.assertEqual(client.newest["stats"].held, False)


if __name__ == "__main__":
    rospy.init_node("soak_test")
    rostest.rosrun("soft_tissue_sim", "soak_test", SoakTest)
