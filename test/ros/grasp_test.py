#!/usr/bin/env python3
"""A grasper that lifts tissue, which is tied to it or held between its jaws, and lets it go."""
import math
import os
import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import JointState
from soft_tissue_sim.msg import SimStats, TissueState, ToolContacts
from soft_tissue_sim.srv import Attach, Detach

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from sim_client import NODE, PATIENCE_S, SimClient, wait_until

TOPICS = {"stats": SimStats, "grasper/measured_cp": PoseStamped, "grasper/spatial/measured_cf": WrenchStamped,
          "grasper/contacts": ToolContacts, "grasper/jaw/measured_js": JointState}
TIP = (0.0, 0.0, 0.032)  # where it starts, 2 mm above the block
WIDE, HOLDING = 1.0, 0.26  # rad, angles between the jaws: clear of the strip, 2 to 2.6 mm off its middle
SLIP_M = 0.0005  # the strip bends a little where it is held


class GraspTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = SimClient(TOPICS)
        cls.jaw = rospy.Publisher(NODE + "/grasper/jaw/servo_jp", JointState, queue_size=1)
        cls.poses = rospy.Publisher(NODE + "/grasper/servo_cp", PoseStamped, queue_size=1)
        for service in ("attach", "detach"):
            rospy.wait_for_service(NODE + "/grasper/" + service, PATIENCE_S)
        cls.attach = rospy.ServiceProxy(NODE + "/grasper/attach", Attach)
        cls.detach = rospy.ServiceProxy(NODE + "/grasper/detach", Detach)

    def setUp(self):
        self.client.reset()
        self.client.unpause()

    def move_to(self, z, x=0.0):
        def there():
            message = PoseStamped()
            message.header.frame_id = "world"
            message.header.stamp = rospy.Time.now()
            message.pose.position.x, message.pose.position.z = x, z
            message.pose.orientation.x = 1.0
            self.poses.publish(message)
            position = self.client.newest["grasper/measured_cp"].pose.position
            return abs(position.x - x) < 1e-9 and abs(position.z - z) < 1e-9

        wait_until(there, "the grasper goes to x = %g, z = %g" % (x, z))

    def open_to(self, angle):
        def there():
            message = JointState(name=["jaw"], position=[angle])
            message.header.stamp = rospy.Time.now()
            self.jaw.publish(message)
            return abs(self.client.newest["grasper/jaw/measured_js"].position[0] - angle) < 1e-9

        wait_until(there, "the jaw is at %g" % angle)

    def middle_of_strip(self):
        state = rospy.wait_for_message(NODE + "/strip/state", TissueState, PATIENCE_S)
        heights = state.positions[2::3]
        return sum(heights) / len(heights)

    def force(self):
        f = self.client.newest["grasper/spatial/measured_cf"].wrench.force
        return (f.x, f.y, f.z)

    def highest(self):
        state = rospy.wait_for_message(NODE + "/block/state", TissueState, PATIENCE_S)
        return max(state.positions[2::3])

    def test_tissue_is_lifted_and_let_go(self):
        answer = self.attach(reach=0.004)
        self.assertTrue(answer.success, answer.message)
        self.assertGreater(answer.nodes, 0)
        self.assertFalse(self.attach(reach=0.004).success, "all of it is tied already")
        self.move_to(TIP[2] + 0.005)
        wait_until(lambda: self.force()[2] < -0.01, "tissue draws the grasper down")
        self.assertGreater(self.highest(), 0.0325)
        contacts = self.client.newest["grasper/contacts"]
        self.assertEqual(contacts.part_names, ["shaft", "jaw_1", "jaw_2"])
        tied = [i for i, tet in enumerate(contacts.tets) if tet == -1 and contacts.areas[i] == 0]
        self.assertGreaterEqual(len(tied), answer.nodes)
        self.assertTrue(all(contacts.parts[i] in (1, 2) for i in tied), "the jaws hold it")
        released = self.detach()
        self.assertTrue(released.success)
        self.assertEqual(released.nodes, answer.nodes)
        wait_until(lambda: self.force() == (0.0, 0.0, 0.0), "nothing holds the grasper")
        wait_until(lambda: abs(self.highest() - 0.03) < 1e-4, "the block has its old shape")
        self.assertEqual(self.detach().nodes, 0)

    def test_jaws_hold_by_friction_and_let_go(self):
        self.move_to(0.05, x=0.1)
        self.open_to(WIDE)
        self.move_to(0.02, x=0.1)
        self.assertEqual(self.force(), (0.0, 0.0, 0.0), "both jaws are beside the strip")
        self.open_to(HOLDING)
        wait_until(lambda: self.client.newest["grasper/contacts"].points, "the jaws touch the strip")
        held = self.middle_of_strip()
        self.move_to(0.04, x=0.1)
        lifted = self.middle_of_strip()
        self.assertAlmostEqual(lifted - held, 0.02, delta=SLIP_M)
        self.open_to(WIDE)
        wait_until(lambda: not self.client.newest["grasper/contacts"].points, "nothing touches any more")
        self.assertEqual(self.force(), (0.0, 0.0, 0.0))
        self.move_to(0.08, x=0.1)
        self.assertLess(self.middle_of_strip(), 0.045, "the strip stays behind")

    def test_one_jaw_may_hold_alone(self):
        answer = self.attach(part="jaw_2", tissue="block", reach=0.008, stiffness=1e6)
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(self.detach(part="jaw_1").nodes, 0)
        self.assertEqual(self.detach(part="jaw_2").nodes, answer.nodes)

    def test_a_reset_lets_go(self):
        self.assertTrue(self.attach(reach=0.004).success)
        self.client.reset()
        self.assertEqual(self.detach().nodes, 0)

    def test_what_is_not_there_is_told(self):
        cases = ((dict(part="thumb", reach=0.01), "part = 'thumb', must be one of: shaft, jaw_1, jaw_2"),
                 (dict(tissue="liver", reach=0.01), "tissue = 'liver', must be one of: block, strip"),
                 (dict(reach=-1.0), "reach = -1 m, must be finite and >= 0"),
                 (dict(reach=math.nan), "reach = nan m, must be finite and >= 0"),
                 (dict(reach=0.01, stiffness=-1.0), "stiffness = -1 Pa/m, must be in [1, 1e+15]"),
                 (dict(reach=0.0), "no free node within reach that is not tied already"))
        for request, message in cases:
            answer = self.attach(**request)
            self.assertFalse(answer.success)
            self.assertEqual(answer.message, message)
        self.assertFalse(self.detach(part="thumb").success)


if __name__ == "__main__":
    rospy.init_node("grasp_test")
    rostest.rosrun("soft_tissue_sim", "grasp_test", GraspTest)
