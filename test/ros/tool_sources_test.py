#!/usr/bin/env python3
"""Tools that follow velocities or an interactive marker, and one that is no faster than it may be."""
import math
import os
import sys
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped, TwistStamped
from soft_tissue_sim.msg import SimStats
from visualization_msgs.msg import InteractiveMarkerFeedback, InteractiveMarkerInit

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from sim_client import NODE, PATIENCE_S, SimClient, wait_until

TOPICS = {"stats": SimStats, "grasper/measured_cp": PoseStamped, "cruiser/measured_cp": PoseStamped,
          "dragged/measured_cp": PoseStamped}
WATCHDOG_S = 3.0


class ToolSourcesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = SimClient(TOPICS)
        cls.velocities = rospy.Publisher(NODE + "/cruiser/servo_cv", TwistStamped, queue_size=1)
        cls.poses = rospy.Publisher(NODE + "/grasper/servo_cp", PoseStamped, queue_size=1)
        cls.feedback = rospy.Publisher(NODE + "/tools/feedback", InteractiveMarkerFeedback, queue_size=1)

    def position(self, tool):
        p = self.client.newest[tool + "/measured_cp"].pose.position
        return (p.x, p.y, p.z)

    def cruise(self, linear, frame="world"):
        message = TwistStamped()
        message.header.stamp = rospy.Time.now()
        message.header.frame_id = frame
        message.twist.linear.x, message.twist.linear.y, message.twist.linear.z = linear
        self.velocities.publish(message)

    def test_a_velocity_is_integrated_until_commands_stop(self):
        start = self.position("cruiser")

        def gone():
            self.cruise((0.02, 0.0, 0.0))
            return self.position("cruiser")[0] > start[0] + 0.01

        wait_until(gone, "the cruiser cruises")
        self.assertAlmostEqual(self.position("cruiser")[1], start[1])
        self.assertAlmostEqual(self.position("cruiser")[2], start[2])
        with self.client.lock:  # its velocity is the one commanded, of steps that are in a row
            places = sorted((messages["stats"].step, messages["cruiser/measured_cp"].pose.position.x)
                            for messages in self.client.by_stamp.values()
                            if "stats" in messages and "cruiser/measured_cp" in messages)
        moves = [b[1] - a[1] for a, b in zip(places, places[1:]) if b[0] == a[0] + 1 and b[1] != a[1]]
        self.assertTrue(moves)
        for move in moves:
            self.assertAlmostEqual(move, 0.02 * 0.005, delta=1e-12)
        wait_until(lambda: "held" in self.held("cruiser commands"), "the watchdog bites")
        still = self.position("cruiser")
        time.sleep(0.5)
        self.assertEqual(self.position("cruiser"), still)

    def held(self, status):
        return "held" if self.client.levels.get(status, 0) == 1 else ""

    def test_bad_velocities_are_refused(self):
        def refused():
            self.cruise((math.nan, 0.0, 0.0))
            return self.client.count("cruiser commands", "rejected: not finite") > 0

        wait_until(refused, "NaN is refused")

        def unknown():
            self.cruise((0.01, 0.0, 0.0), frame="nowhere")
            return self.client.count("cruiser commands", "tf failures: unknown frame") > 0

        wait_until(unknown, "a frame that tf does not know is refused")

    def test_a_marker_is_there_and_its_tool_follows_it(self):
        shown = rospy.wait_for_message(NODE + "/tools/update_full", InteractiveMarkerInit, PATIENCE_S)
        self.assertEqual([marker.name for marker in shown.markers], ["dragged"])
        marker = shown.markers[0]
        self.assertEqual(marker.header.frame_id, "world")
        self.assertAlmostEqual(marker.pose.position.y, -0.2)
        self.assertEqual(len(marker.controls), 6)

        def dragged():
            message = InteractiveMarkerFeedback()
            message.header.frame_id = "world"
            message.client_id = "/rviz"
            message.marker_name = "dragged"
            message.event_type = InteractiveMarkerFeedback.POSE_UPDATE
            message.pose.position.x, message.pose.position.y, message.pose.position.z = 0.05, -0.2, 0.25
            message.pose.orientation.w = 1.0
            self.feedback.publish(message)
            return math.dist(self.position("dragged"), (0.05, -0.2, 0.25)) < 1e-9

        wait_until(dragged, "the tool is where the marker was dragged")

        def put_back():
            self.client.reset()  # again, should the last drag still be on its way
            return math.dist(self.position("dragged"), (0.0, -0.2, 0.2)) < 1e-9

        wait_until(put_back, "a reset puts the tool back")

        def marker_is_back():
            update = rospy.wait_for_message(NODE + "/tools/update_full", InteractiveMarkerInit, PATIENCE_S)
            return abs(update.markers[0].pose.position.z - 0.2) < 1e-6

        wait_until(marker_is_back, "and its marker")

    def test_a_tool_is_no_faster_than_it_may_be(self):
        start = self.position("grasper")
        goal = (start[0], start[1], start[2] + 0.1)
        self.client.forget_messages()

        def there():
            message = PoseStamped()
            message.header.frame_id = "world"
            message.header.stamp = rospy.Time.now()
            message.pose.position.x, message.pose.position.y, message.pose.position.z = goal
            message.pose.orientation.x = 1.0
            self.poses.publish(message)
            return math.dist(self.position("grasper"), goal) < 1e-9

        wait_until(there, "the grasper gets there in the end")
        with self.client.lock:
            places = sorted((messages["stats"].step, messages["grasper/measured_cp"].pose.position.z)
                            for messages in self.client.by_stamp.values()
                            if "stats" in messages and "grasper/measured_cp" in messages)
        for a, b in zip(places, places[1:]):
            self.assertLessEqual(b[1] - a[1], (b[0] - a[0]) * 0.2 * 0.005 + 1e-12)


if __name__ == "__main__":
    rospy.init_node("tool_sources_test")
    rostest.rosrun("soft_tissue_sim", "tool_sources_test", ToolSourcesTest)
