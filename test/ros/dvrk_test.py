#!/usr/bin/env python3
"""An arm that speaks CRTK's names moves the simulated tool and hears its force, by the launch file's remapping alone."""
import math
import os
import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import JointState
from soft_tissue_sim.msg import SimStats

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from sim_client import SimClient, wait_until

TOPICS = {"stats": SimStats, "psm/measured_cp": PoseStamped, "psm/jaw/measured_js": JointState}
ABOVE = (-0.012, 0.0, 0.055)
PRESSED = (-0.012, 0.0, 0.036)  # some mm into the lobe


class DvrkTest(unittest.TestCase):
    def test_the_arm_moves_the_tool_and_hears_its_force(self):
        client = SimClient(TOPICS)
        pose = rospy.Publisher("/PSM1/setpoint_cp", PoseStamped, queue_size=1)
        jaw = rospy.Publisher("/PSM1/jaw/setpoint_js", JointState, queue_size=1)
        forces = []
        subscriber = rospy.Subscriber("/PSM1/simulated/spatial/measured_cf", WrenchStamped,
                                      lambda message: forces.append(message.wrench.force.z), queue_size=1)

        def at(position, angle):
            def there():
                message = PoseStamped()
                message.header.stamp = rospy.Time.now()
                message.header.frame_id = "world"
                message.pose.position.x, message.pose.position.y, message.pose.position.z = position
                message.pose.orientation.x = 1.0
                pose.publish(message)
                opening = JointState(name=["jaw"], position=[angle])
                opening.header.stamp = rospy.Time.now()
                jaw.publish(opening)
                p = client.newest["psm/measured_cp"].pose.position
                return (math.dist((p.x, p.y, p.z), position) < 1e-9 and
                        abs(client.newest["psm/jaw/measured_js"].position[0] - angle) < 1e-9)

            wait_until(there, "the tool is at %s, its jaw at %g" % (position, angle))

        at(ABOVE, 0.6)
        at(PRESSED, 0.2)
        wait_until(lambda: forces and forces[-1] > 0.01, "the arm hears tissue push the tool up")
        at(ABOVE, 0.6)
        wait_until(lambda: forces[-1] == 0.0, "and nothing when it is away")
        subscriber.unregister()


if __name__ == "__main__":
    rospy.init_node("dvrk_test")
    rostest.rosrun("soft_tissue_sim", "dvrk_test", DvrkTest)
