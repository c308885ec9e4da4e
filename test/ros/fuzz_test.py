#!/usr/bin/env python3
"""Spoilt messages on every topic and service of the node: it goes on, and nothing it tells is NaN.

FUZZ_MESSAGES tells how many go to each topic and service; the short form is for every day.
"""
import math
import os
import sys
import time
import unittest

import rosgraph
import roslib.message
import rospy
import rosservice
import rostest
from soft_tissue_sim.msg import TissueState
from std_srvs.srv import Empty

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from raw_messages import random_message, random_source, raw_class, serialized, spoilt
from sim_client import NODE, PATIENCE_S, SimClient, wait_until

MESSAGES = int(os.environ.get("FUZZ_MESSAGES", 2000))
BURST = 50  # then the node may read
BURST_S = 0.01
# roscpp's own, and what writes to any path it is told
LEFT_OUT = ("get_loggers", "set_logger_level", "save_state")


def inputs():
    """Topics the node subscribes to with their types, and its services with theirs."""
    master = rosgraph.Master(rospy.get_name())
    _, subscriptions, services = master.getSystemState()
    types = dict(master.getTopicTypes())
    topics = {topic: types[topic] for topic, nodes in subscriptions if NODE in nodes}
    ours = [name for name, nodes in services if NODE in nodes and name.split("/")[-1] not in LEFT_OUT]
    return topics, {name: rosservice.get_service_type(name) for name in ours}


def is_finite(vector):
    return all(math.isfinite(getattr(vector, axis)) for axis in "xyz")


class FuzzTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = SimClient()
        cls.client.wait_for_commands_to_arrive()
        cls.topics, cls.services = inputs()

    def check_goes_on(self, after):
        client = self.client
        rospy.ServiceProxy(NODE + "/unpause_physics", Empty)()
        time_before = client.sim_time()
        wait_until(lambda: client.sim_time() > time_before + 0.05, "steps after " + after)
        wrench = client.newest["probe/spatial/measured_cf"].wrench
        pose = client.newest["probe/measured_cp"].pose
        self.assertTrue(is_finite(wrench.force) and is_finite(wrench.torque) and is_finite(pose.position), after)
        self.assertTrue(math.isfinite(client.newest["stats"].min_det_f), after)
        state = rospy.wait_for_message(NODE + "/block/state", TissueState, PATIENCE_S)
        self.assertTrue(all(math.isfinite(c) for c in state.positions), after)

    def test_inputs_are_found(self):
        for topic in ("probe/servo_cp", "flyer/servo_cv", "grasper/joint_states", "grasper/jaw/servo_jp", "octomap_in",
                      "tools/feedback"):
            self.assertIn(NODE + "/" + topic, self.topics)
        self.assertIn("/tf", self.topics)
        for service in ("query_distance", "grasper/attach", "set_material", "load_state"):
            self.assertIn(NODE + "/" + service, self.services)

    def test_topics(self):
        for number, (topic, type_name) in enumerate(sorted(self.topics.items())):
            message_class = roslib.message.get_message_class(type_name)
            publisher = rospy.Publisher(topic, raw_class(message_class), queue_size=MESSAGES)
            wait_until(lambda: publisher.get_num_connections() > 0, "the node listens to " + topic)
            source = random_source(number)
            for count in range(MESSAGES):
                message = publisher.data_class()
                message.data = spoilt(serialized(random_message(message_class, source)), source)
                publisher.publish(message)
                if count % BURST == 0:
                    time.sleep(BURST_S)
            self.check_goes_on(topic)
            publisher.unregister()
            print("  %d spoilt messages on %s (%s)" % (MESSAGES, topic, type_name))

    def test_services(self):
        for number, (name, type_name) in enumerate(sorted(self.services.items())):
            service_class = roslib.message.get_service_class(type_name)
            request_class = service_class._request_class
            raw = raw_class(request_class)
            raw_service = type("RawService", (), {
                "_type": service_class._type, "_md5sum": service_class._md5sum, "_request_class": raw,
                "_response_class": service_class._response_class})
            source = random_source(number)
            refused = 0
            call = rospy.ServiceProxy(name, raw_service, persistent=True)
            for _ in range(MESSAGES):
                request = raw()
                request.data = spoilt(serialized(random_message(request_class, source)), source)
                try:
                    call(request)
                except rospy.ServiceException:
                    refused += 1
                    call.close()
                    call = rospy.ServiceProxy(name, raw_service, persistent=True)
            call.close()
            self.check_goes_on(name)
            print("  %d spoilt requests to %s (%s), %d refused" % (MESSAGES, name, type_name, refused))

    def test_commands_still_count_afterwards(self):
        self.client.reset()
        time.sleep(3.5)  # the watchdog: a new stream may start anywhere
        self.client.move_to((0.0, 0.0, 0.05))


if __name__ == "__main__":
    rospy.init_node("fuzz_test")
    rostest.rosrun("soft_tissue_sim", "fuzz_test", FuzzTest)
