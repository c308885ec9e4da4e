#!/usr/bin/env python3
"""Pauses a running simulation at the moment a tool is pushed by at least some force, so that it can be looked at."""
import argparse
import sys
import threading

import rospy
from geometry_msgs.msg import WrenchStamped
from std_srvs.srv import Empty


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--node", default="/sim_node", help="the simulation")
    parser.add_argument("--tool", default="probe", help="the tool")
    parser.add_argument("--force_n", type=float, default=0.1, help="force to wait for")
    parser.add_argument("--patience_s", type=float, default=30.0, help="how long to wait")
    arguments = parser.parse_args(rospy.myargv()[1:])

    rospy.init_node("pause_in_contact", anonymous=True)
    pause = rospy.ServiceProxy(arguments.node + "/pause_physics", Empty)
    pause.wait_for_service(arguments.patience_s)
    pressed = threading.Event()

    def look_at(message):
        force = message.wrench.force
        if not pressed.is_set() and force.x**2 + force.y**2 + force.z**2 >= arguments.force_n**2:
            pause()
            pressed.set()

    rospy.Subscriber("%s/%s/body/measured_cf" % (arguments.node, arguments.tool), WrenchStamped, look_at,
                     queue_size=1)
    if not pressed.wait(arguments.patience_s):
        sys.exit("pause_in_contact.py: no force of %g N in %g s" % (arguments.force_n, arguments.patience_s))


if __name__ == "__main__":
    main()
