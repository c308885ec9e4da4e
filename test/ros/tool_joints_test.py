#!/usr/bin/env python3
"""Joints of tools from a URDF: commanded by name, by the jaw, and told by tf; what is beyond their limits."""
import math
import os
import sys
import unittest

import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import JointState
from soft_tissue_sim.msg import SimStats
from visualization_msgs.msg import Marker, MarkerArray

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from sim_client import NODE, SimClient, wait_until

TOPICS = {"stats": SimStats, "grasper/measured_js": JointState, "grasper/jaw/measured_js": JointState,
          "mirror/measured_js": JointState, "standing/measured_js": JointState}


class ToolJointsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = SimClient(TOPICS)
        cls.markers = {}
        cls.marker_subscriber = rospy.Subscriber(NODE + "/markers", MarkerArray, cls.keep_markers, queue_size=1)
        cls.publishers = {}

    @classmethod
    def keep_markers(cls, array):
        cls.markers = {(marker.ns, marker.id): marker for marker in array.markers}

    def send(self, topic, names, positions):
        if topic not in self.publishers:
            self.publishers[topic] = rospy.Publisher(NODE + "/" + topic, JointState, queue_size=1)
        message = JointState(name=names, position=positions)
        message.header.stamp = rospy.Time.now()
        self.publishers[topic].publish(message)

    def joint(self, tool, name):
        state = self.client.newest[tool + "/measured_js"]
        return dict(zip(state.name, state.position))[name]

    def jaw(self):
        state = self.client.newest["grasper/jaw/measured_js"]
        self.assertEqual(state.name, ["jaw"])
        return state.position[0]

    def send_until(self, condition, what, *command):
        def sent():
            self.send(*command)
            return condition()

        wait_until(sent, what)

    def test_the_jaw_follows_its_own_command_and_says_where_it_is(self):
        self.send_until(lambda: abs(self.jaw() - 0.8) < 1e-9, "the jaw opens", "grasper/jaw/servo_jp", ["jaw"], [0.8])
        wait_until(lambda: abs(self.joint("grasper", "jaw_1_joint") - 0.4) < 1e-9, "each finger by half of it")

    def test_other_joints_follow_joint_states_that_leave_the_jaw_alone(self):
        self.send_until(lambda: abs(self.jaw() - 0.2) < 1e-9, "the jaw opens", "grasper/jaw/servo_jp", ["jaw"], [0.2])
        self.send_until(lambda: abs(self.joint("grasper", "wrist") + 0.5) < 1e-9, "the wrist bends",
                        "grasper/joint_states", ["jaw_1_joint", "wrist", "elsewhere"], [0.6, -0.5, 7.0])
        self.assertAlmostEqual(self.jaw(), 0.2)

    def test_limits_hold_and_are_reported(self):
        self.send_until(lambda: abs(self.jaw() - 1.4) < 1e-9, "the jaw is open as far as it goes",
                        "grasper/jaw/servo_jp", ["jaw"], [3.0])
        wait_until(lambda: self.client.count("grasper jaw commands", "beyond joint limits") > 0, "that is reported")
        self.send_until(lambda: self.client.count("grasper joint commands", "rejected: no such joint") > 0,
                        "unknown joints are reported", "grasper/joint_states", ["nose"], [0.1])
        self.send_until(lambda: self.client.count("grasper jaw commands", "rejected: not finite") > 0,
                        "NaN is refused", "grasper/jaw/servo_jp", ["jaw"], [math.nan])
        self.assertAlmostEqual(self.jaw(), 1.4)

    def test_tf_tells_joints(self):
        broadcaster = tf2_ros.TransformBroadcaster()

        def told():
            now = rospy.Time.now()
            transforms = []
            for parent, child, axis, angle in (("shaft", "palm", (0, 1, 0), 0.6), ("palm", "jaw_1", (-1, 0, 0), 0.3)):
                transform = TransformStamped()
                transform.header.stamp = now
                transform.header.frame_id = "mirrored_" + parent
                transform.child_frame_id = "mirrored_" + child
                rotation = transform.transform.rotation
                rotation.x, rotation.y, rotation.z = (math.sin(0.5 * angle) * a for a in axis)
                rotation.w = math.cos(0.5 * angle)
                transforms.append(transform)
            broadcaster.sendTransform(transforms)
            return (abs(self.joint("mirror", "wrist") - 0.6) < 1e-6 and
                    abs(self.joint("mirror", "jaw_1_joint") - 0.3) < 1e-6)

        wait_until(told, "the mirror does as the frames do")

    def test_each_link_is_shown_where_its_joints_have_it(self):
        self.send_until(lambda: abs(self.joint("standing", "jaw_1_joint") - 0.5) < 1e-9 and
                        abs(self.joint("standing", "wrist") + 0.2) < 1e-9, "the joints move",
                        "standing/joint_states", ["wrist", "jaw_1_joint"], [-0.2, 0.5])

        def shown():
            marker = self.markers.get(("standing", 0))
            if marker is None or marker.type != Marker.CUBE:
                return False
            # The middle of the jaw, (0, -0.0015, 0.01), turned about x by 0.5 and about y by -0.2, on the base.
            y = -0.0015 * math.cos(0.5) - 0.01 * math.sin(0.5)
            z = -0.0015 * math.sin(0.5) + 0.01 * math.cos(0.5)
            expected = (0.4 + z * math.sin(-0.2), y, 0.2 + z * math.cos(-0.2))
            p = marker.pose.position
            return math.dist((p.x, p.y, p.z), expected) < 1e-6

        wait_until(shown, "the jaw's visual is where the kinematics have it")
        self.assertEqual(len([key for key in self.markers if key[0] == "grasper"]), 3)


if __name__ == "__main__":
    rospy.init_node("tool_joints_test")
    rostest.rosrun("soft_tissue_sim", "tool_joints_test", ToolJointsTest)
