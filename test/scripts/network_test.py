#!/usr/bin/env python3
"""Two nodes on two machines under one master: tissue of one is an obstacle of the other, until the cable is cut, and
again when it is mended."""
import os
import sys
import time
import unittest
import xmlrpc.client

import linked_machines

linked_machines.enter()  # before anything of ROS looks for its master

import rosgraph
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from octomap_msgs.msg import Octomap
from soft_tissue_sim.msg import SimStats, TissueState

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "../ros"))
from octomap_codec import decode
from sim_client import PATIENCE_S, wait_until

SIM_NODE = os.environ["SIM_NODE"]
LEFT, RIGHT = "/left/sim_node", "/right/sim_node"
TOP = 0.03       # of the block on the right, m
CELL = 0.005     # m
HANGING = 0.036  # the lower face of the cube on the left, m
PULLED = 0.0262  # where steps pull it down to: into the block by most of a cell
STEPS = 100      # to pull it down, and to let it go


class NetworkTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.machines = linked_machines.LinkedMachines()
        cls.addClassCleanup(cls.machines.end)
        cls.machines.on_far("rosmaster", "--core", "-p", "11311")
        wait_until(rosgraph.is_master_online, "the master is there")
        cls.left = cls.machines.on_far(SIM_NODE, "__ns:=/left", "_paused:=true", "_state_rate_hz:=0",
                                       "_scene:=" + os.path.join(HERE, "../ros/pulled_cube.yaml"))
        cls.right = cls.machines.near(SIM_NODE, "__ns:=/right", "_state_rate_hz:=0", "_stats_rate_hz:=0",
                                      "_scene:=" + os.path.join(HERE, "../ros/octomap.yaml"),
                                      "%s/octomap_in:=%s/octomap_full" % (RIGHT, LEFT))
        rospy.init_node("listener")
        cls.newest = {}
        cls.subscribers = [cls.listen(*topic) for topic in (
            (LEFT + "/cube/state", TissueState), (LEFT + "/octomap_full", Octomap), (LEFT + "/octomap_binary", Octomap),
            (RIGHT + "/block/state", TissueState), (RIGHT + "/stats", SimStats))]
        wait_until(lambda: len(cls.newest) == len(cls.subscribers), "messages of both nodes come")
        cls.accepted = 0
        cls.subscribers.append(rospy.Subscriber("/diagnostics", DiagnosticArray, cls.note_maps))
        wait_until(lambda: cls.accepted > 0, "the right one takes a map")

    @classmethod
    def listen(cls, topic, kind):
        def keep(message):
            cls.newest[topic] = message

        return rospy.Subscriber(topic, kind, keep, queue_size=1, tcp_nodelay=True)

    @classmethod
    def note_maps(cls, array):
        for status in array.status:
            if "plate maps" in status.name:
                cls.accepted = int({pair.key: pair.value for pair in status.values}["accepted"])

    def lower_face(self):
        return min(self.newest[LEFT + "/cube/state"].positions[2::3])

    def tops(self):
        """Heights of the block's upper nodes: (below the cube, at the four corners)."""
        flat = self.newest[RIGHT + "/block/state"].positions
        nodes = list(zip(flat[0::3], flat[1::3], flat[2::3]))
        below = [z for x, y, z in nodes if abs(x) < 0.0065 and abs(y) < 0.0065]
        corners = [z for x, y, z in nodes if abs(x) > 0.025 and abs(y) > 0.025]
        return max(below), [max(z for x, y, z in nodes if abs(x) > 0.025 and abs(y) > 0.025 and (x > 0) == right
                                and (y > 0) == back) for right in (0, 1) for back in (0, 1)] if corners else []

    def steps(self):
        return self.newest[RIGHT + "/stats"].step

    def go_on_for(self, steps):
        """Waits until the node on the right has done so many. @return how many it did a second"""
        begun_s, before = time.monotonic(), self.steps()
        wait_until(lambda: self.steps() > before + steps, "the right one goes on")
        return (self.steps() - before) / (time.monotonic() - begun_s)

    def step_left(self):
        self.assertIn("success: True", self.machines.ask_far("rosservice", "call", LEFT + "/step", str(STEPS)))

    def test_1_they_are_on_two_machines(self):
        spaces = {os.readlink("/proc/%d/ns/net" % process.pid) for process in (self.left, self.right)}
        self.assertEqual(len(spaces), 2)
        self.assertIn(os.readlink("/proc/self/ns/net"), spaces)
        master = rosgraph.Master(rospy.get_name())
        for node, address in ((LEFT, linked_machines.FAR), (RIGHT, linked_machines.NEAR)):
            self.assertTrue(master.lookupNode(node).startswith("http://%s:" % address), master.lookupNode(node))

    def test_2_maps_come_over_the_cable(self):
        _, _, connections = xmlrpc.client.ServerProxy(
            rosgraph.Master(rospy.get_name()).lookupNode(RIGHT)).getBusInfo(rospy.get_name())
        maps = [entry for entry in connections if entry[4] == LEFT + "/octomap_full"]
        print("  %s" % maps)
        self.assertEqual(len(maps), 1)
        self.assertEqual(maps[0][2:4], ["i", "TCPROS"])
        self.assertIn("[%s:" % linked_machines.FAR, maps[0][6])

    def test_3_tissue_that_hangs_above_is_not_felt(self):
        self.assertAlmostEqual(self.lower_face(), HANGING, delta=1e-6)
        self.go_on_for(100)
        below, _ = self.tops()
        self.assertAlmostEqual(below, TOP, delta=1e-5)

    def test_4_tissue_that_is_pulled_down_is_felt(self):
        before = self.machines.received_bytes()
        self.step_left()
        wait_until(lambda: self.lower_face() < PULLED + 1e-6, "the shape of the left one comes")
        self.assertAlmostEqual(self.lower_face(), PULLED, delta=1e-6)
        wait_until(lambda: self.tops()[0] < TOP - 0.8 * CELL, "the right one feels it")
        self.go_on_for(200)
        below, corners = self.tops()
        print("  the block's top is at %.2f mm below the cube, at %.2f mm at its corners"
              % (1e3 * below, 1e3 * min(corners)))
        self.assertGreater(below, TOP - 1.2 * CELL)
        self.assertGreater(min(corners), TOP - 0.2 * CELL)
        full, binary = (decode(self.newest[LEFT + "/octomap_" + kind]) for kind in ("full", "binary"))
        self.assertEqual(full[0], binary[0])
        self.assertEqual(min(z for _, _, z in full[0]), round(TOP / CELL) - 1)
        print("  a map takes %d bytes, %d as binary" % tuple(len(self.newest[LEFT + "/octomap_" + kind].data)
                                                             for kind in ("full", "binary")))
        sent = sum(len(self.newest[LEFT + "/octomap_" + kind].data) for kind in ("full", "binary"))
        self.assertGreater(self.machines.received_bytes() - before, sent)

    def test_5_a_cut_cable_stops_no_step_and_what_was_felt_stays(self):
        rate = self.go_on_for(400)
        self.machines.cut()
        self.addCleanup(self.machines.mend)
        heard, received = self.newest[LEFT + "/cube/state"].step, self.machines.received_bytes()
        self.step_left()  # which is on the other side
        cut_rate = self.go_on_for(400)
        print("  %.0f steps a second with the cable, %.0f without" % (rate, cut_rate))
        self.assertEqual(self.newest[LEFT + "/cube/state"].step, heard)
        self.assertEqual(self.machines.received_bytes(), received)
        self.assertLess(self.tops()[0], TOP - 0.8 * CELL)
        self.machines.mend()
        mended_s = time.monotonic()
        wait_until(lambda: self.newest[LEFT + "/cube/state"].step == heard + STEPS, "the left one is heard again")
        print("  heard again after %.1f s" % (time.monotonic() - mended_s))
        wait_until(lambda: self.tops()[0] > TOP - 1e-4, "the right one feels that it is gone")


if __name__ == "__main__":
    unittest.main(warnings="ignore")  # rospy leaves sockets open
