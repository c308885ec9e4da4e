#!/usr/bin/env python3
"""Maps in and out: what they do, what they say, and which are refused."""
import os
import sys
import time
import unittest

import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import TransformStamped
from octomap_msgs.msg import Octomap
from soft_tissue_sim.msg import SimStats, TissueState

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from octomap_codec import decode, encode_binary
from sim_client import NODE, PATIENCE_S, SimClient, wait_until

RESOLUTION = 0.005
TOP = 0.03
BLOCK = {(x, y, z) for x in range(-6, 6) for y in range(-6, 6) for z in range(6)}


def plate(low):
    """Cells above a height, wider than the block."""
    return {(x, y, z) for x in range(-8, 8) for y in range(-8, 8) for z in range(low, low + 4)}


def map_of(cells, frame="world"):
    message = Octomap()
    message.header.frame_id = frame
    message.header.stamp = rospy.Time.now()
    message.binary = True
    message.id = "OcTree"
    message.resolution = RESOLUTION
    message.data = encode_binary(cells)
    return message


class OctomapTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = SimClient({"stats": SimStats, "block/state": TissueState})
        cls.publisher = rospy.Publisher(NODE + "/octomap_in", Octomap, queue_size=1, latch=True)
        wait_until(lambda: cls.publisher.get_num_connections() > 0, "the node takes maps")

    def top(self):
        return max(self.client.newest["block/state"].positions[2::3])

    def count(self, key):
        return self.client.count("plate maps", key)

    def send(self, message):
        before = self.count("accepted") + self.count("rejected")
        self.publisher.publish(message)
        wait_until(lambda: self.count("accepted") + self.count("rejected") > before, "it was looked at")

    def test_1_nothing_is_computed_while_nobody_subscribes(self):
        wait_until(lambda: "octomaps built" in self.client.diagnostics.get("physics", {}), "diagnostics")
        time.sleep(1.5)
        self.assertEqual(self.client.count("physics", "octomaps built"), 0)

    def test_2_the_type_is_that_of_octomap_msgs(self):
        self.assertEqual(Octomap._type, "octomap_msgs/Octomap")
        self.assertEqual(Octomap._md5sum, "9a45536b45c5e409cd49f04bb2d9999f")

    def test_3_the_tissue_goes_out_as_its_cells(self):
        for topic, binary in (("octomap_full", False), ("octomap_binary", True)):
            message = rospy.wait_for_message(NODE + "/" + topic, Octomap, PATIENCE_S)
            self.assertEqual(message.header.frame_id, "world")
            self.assertEqual((message.binary, message.id, message.resolution), (binary, "OcTree", RESOLUTION))
            occupied, free = decode(message)
            self.assertEqual(occupied, BLOCK)
            self.assertEqual(free, set())

    def test_4_a_map_that_takes_tissue_in_pushes_it_out_and_a_free_one_lets_it_back(self):
        self.send(map_of(plate(5)))  # 5 mm deep
        wait_until(lambda: self.top() < 0.0258, "the plate pushes the block down")
        stats = self.client.newest["stats"]
        self.assertGreater(stats.min_det_f, 0.3)
        self.assertFalse(stats.held)
        occupied, free = decode(rospy.wait_for_message(NODE + "/octomap_binary", Octomap, PATIENCE_S))
        self.assertTrue(occupied)
        self.send(map_of(set()))
        wait_until(lambda: self.top() > TOP - 1e-4, "the block comes back")
        self.assertEqual(self.client.count("plate maps", "rejected"), 0)

    def test_5_a_map_is_where_its_frame_is(self):
        broadcaster = tf2_ros.StaticTransformBroadcaster()
        transform = TransformStamped()
        transform.header.frame_id, transform.child_frame_id = "world", "camera"
        transform.transform.translation.z = 0.025
        transform.transform.rotation.w = 1.0
        broadcaster.sendTransform(transform)
        self.send(map_of(plate(0), "camera"))
        wait_until(lambda: self.top() < 0.0258, "the plate pushes the block down")
        self.send(map_of(set()))
        wait_until(lambda: self.top() > TOP - 1e-4, "the block comes back")

    def test_6_what_can_not_be_used_is_refused_and_counted(self):
        accepted = self.count("accepted")
        other_tree, other_size, cut, longer, nowhere = (map_of(plate(5)) for _ in range(5))
        other_tree.id = "OcTreeStamped"
        other_size.resolution = 0.01
        cut.data = cut.data[:-3]
        longer.data = longer.data + (0, 0)
        nowhere.header.frame_id = "nowhere"
        before = self.client.newest["stats"].step
        for number, message in enumerate((other_tree, other_size, cut, longer), 1):
            self.send(message)
            self.assertEqual(self.count("rejected: not usable"), number)
        self.send(nowhere)
        self.assertEqual(self.count("tf failures"), 1)
        self.assertEqual(self.count("accepted"), accepted)
        wait_until(lambda: self.client.newest["stats"].step > before, "the simulation goes on")
        self.assertGreater(self.top(), TOP - 1e-4)

    def test_7_what_goes_out_can_come_back_in(self):
        accepted, rejected = self.count("accepted"), self.count("rejected")
        full = rospy.wait_for_message(NODE + "/octomap_full", Octomap, PATIENCE_S)
        occupied, free = decode(full)
        self.assertEqual(occupied, BLOCK)
        self.send(full)
        self.assertEqual((self.count("accepted"), self.count("rejected")), (accepted + 1, rejected))
        self.send(map_of(set()))


if __name__ == "__main__":
    rospy.init_node("octomap_test")
    rostest.rosrun("soft_tissue_sim", "octomap_test", OctomapTest)
