#!/usr/bin/env python3
"""Spoilt messages on every topic and service of the node: it goes on, and nothing it tells is NaN.

FUZZ_MESSAGES tells how many go to each topic and service; the short form is for every day.
"""
import math
import os
import sys
import tempfile
import threading
import time
import unittest

import roscpp.srv
import roslib.message
import rosgraph
import rospy
import rosservice
import rostest
from soft_tissue_sim.msg import TissueState
from soft_tissue_sim.srv import SaveState, SetMaterial
from std_srvs.srv import Empty

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import tcpros
from honest_messages import honest_messages, honest_requests
from raw_messages import Spoiler
from sim_client import NODE, PATIENCE_S, SimClient, wait_until

MESSAGES = int(os.environ.get("FUZZ_MESSAGES", 2000))
ALONE = MESSAGES // 10  # of them to each alone, the rest to all in turns
PAUSE_S = 1e-3          # between messages on a topic: its queue holds one, and those it never reads are no test
BATCH = 50              # requests on their way at once
LOOK_AFTER = 10000      # the node, that is: what ends it is then among few
# roscpp's own, and what writes to any path it is told
LEFT_OUT = ("get_loggers", "set_logger_level", "save_state")


def inputs():
    """Topics the node subscribes to with their classes, and its services with theirs."""
    master = rosgraph.Master(rospy.get_name())
    _, subscriptions, services = master.getSystemState()
    types = dict(master.getTopicTypes())
    topics = {topic: roslib.message.get_message_class(types[topic]) for topic, nodes in subscriptions
              if NODE in nodes}
    ours = [name for name, nodes in services if NODE in nodes and name.split("/")[-1] not in LEFT_OUT]
    return topics, {name: roslib.message.get_service_class(rosservice.get_service_type(name)) for name in ours}


def is_finite(vector):
    return all(math.isfinite(getattr(vector, axis)) for axis in "xyz")


class TopicLane:
    most_at_once, pause_s = 1, PAUSE_S

    def __init__(self, publisher, topic, message_class, seed):
        self.spoiler = Spoiler(message_class, seed, honest_messages(topic, message_class))
        self.connection = publisher.connect(topic, message_class)

    def send(self, count):
        self.connection.sendall(tcpros.framed(self.spoiler.next()))

    def receive(self):
        pass


class ServiceLane:
    most_at_once, pause_s = BATCH, 0.0

    def __init__(self, name, service_class, seed, state_path):
        request_class = service_class._request_class
        self.spoiler = Spoiler(request_class, seed, honest_requests(name, request_class, state_path))
        self.service = tcpros.Service(name, service_class)
        self.understood = 0

    def send(self, count):
        self.service.send([self.spoiler.next() for _ in range(count)])

    def receive(self):
        self.understood += sum(understood for understood, _ in self.service.receive())


def send_in_turns(lanes, count):
    """So many to each."""
    pause_s = lanes[0].pause_s
    for begin in range(0, count, lanes[0].most_at_once):
        for lane in lanes:
            lane.send(min(lane.most_at_once, count - begin))
        for lane in lanes:
            lane.receive()
        time.sleep(pause_s)


class EndOfSteps:
    """Ends steps that were asked for, which may take years."""

    def __init__(self, client):
        self.client, self.done = client, threading.Event()
        self.thread = threading.Thread(target=self.run)

    def run(self):
        while not self.done.wait(0.02):
            self.client.unpause()

    def __enter__(self):
        self.thread.start()

    def __exit__(self, *error):
        self.done.set()
        self.thread.join()


class FuzzTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = SimClient()
        cls.client.wait_for_commands_to_arrive()
        # Each message that can't be read has a line in the log.
        rospy.ServiceProxy(NODE + "/set_logger_level", roscpp.srv.SetLoggerLevel)("ros.roscpp", "fatal")
        cls.topics, cls.services = inputs()
        cls.publisher = tcpros.Publisher("/fuzzer")
        cls.folder = tempfile.TemporaryDirectory()
        cls.state_path = os.path.join(cls.folder.name, "state")
        assert rospy.ServiceProxy(NODE + "/save_state", SaveState)(cls.state_path).success

    @classmethod
    def tearDownClass(cls):
        cls.publisher.close()
        cls.folder.cleanup()

    def check_goes_on(self, after):
        client = self.client
        client.unpause()
        time_before = client.sim_time()
        wait_until(lambda: abs(client.sim_time() - time_before) > 0.05, "steps after " + after)
        wrench = client.newest["probe/spatial/measured_cf"].wrench
        pose = client.newest["probe/measured_cp"].pose
        self.assertTrue(is_finite(wrench.force) and is_finite(wrench.torque) and is_finite(pose.position), after)
        self.assertTrue(math.isfinite(client.newest["stats"].min_det_f), after)
        state = rospy.wait_for_message(NODE + "/block/state", TissueState, PATIENCE_S)
        self.assertTrue(all(math.isfinite(c) for c in state.positions), after)
        client.forget_messages()

    def make_good(self):
        """Undoes what requests that were taken have done."""
        for tissue in ("block", "cube"):
            answer = rospy.ServiceProxy(NODE + "/set_material", SetMaterial)(
                tissue=tissue, young_modulus=20000.0, poisson_ratio=0.4, density=1000.0, stiffening=math.nan)
            self.assertTrue(answer.success, answer.message)
        self.client.reset()

    def send(self, lanes):
        """@param lanes  by the names of what they lead to"""
        for name, lane in lanes.items():
            send_in_turns([lane], ALONE)
            self.check_goes_on(name)
        for begin in range(ALONE, MESSAGES, LOOK_AFTER):
            send_in_turns(list(lanes.values()), min(LOOK_AFTER, MESSAGES - begin))
            self.check_goes_on("message %d" % begin)

    def test_inputs_are_found(self):
        for topic in ("probe/servo_cp", "flyer/servo_cv", "grasper/joint_states", "grasper/jaw/servo_jp", "octomap_in",
                      "tools/feedback"):
            self.assertIn(NODE + "/" + topic, self.topics)
        self.assertIn("/tf", self.topics)
        for service in ("query_distance", "grasper/attach", "set_material", "load_state"):
            self.assertIn(NODE + "/" + service, self.services)

    def counted(self):
        """Commands of the probe that the node has looked at."""
        wait_until(lambda: "probe commands" in self.client.diagnostics, "diagnostics")
        return sum(self.client.count("probe commands", key) for key in ("accepted", "rejected"))

    def test_topics(self):
        begun = time.monotonic()
        lanes = {topic: TopicLane(self.publisher, topic, message_class, number)
                 for number, (topic, message_class) in enumerate(sorted(self.topics.items()))}
        self.send(lanes)
        for topic, lane in lanes.items():
            lane.connection.close()
            self.publisher.withdraw(topic)
        print("  %d spoilt messages on each of %d topics in %.0f s" % (MESSAGES, len(lanes), time.monotonic() - begun))
        time.sleep(1.5)  # diagnostics come once a second
        looked_at = self.counted()
        print("  the node looked at %d of those that tell the probe where to go" % looked_at)
        self.assertGreater(looked_at, 0.1 * MESSAGES)

    def test_services(self):
        begun = time.monotonic()
        lanes = {name: ServiceLane(name, service_class, number, self.state_path)
                 for number, (name, service_class) in enumerate(sorted(self.services.items()))}
        with EndOfSteps(self.client):
            self.send(lanes)
        self.make_good()
        print("  %d spoilt requests to each of %d services in %.0f s; of them in good form:" % (
            MESSAGES, len(lanes), time.monotonic() - begun))
        for name, lane in lanes.items():
            print("    %6d to %s" % (lane.understood, name))
            lane.service.close()

    def test_commands_still_count_afterwards(self):
        self.client.reset()
        time.sleep(3.5)  # the watchdog: a new stream may start anywhere
        self.client.move_to((0.0, 0.0, 0.05))


if __name__ == "__main__":
    rospy.init_node("fuzz_test")
    rostest.rosrun("soft_tissue_sim", "fuzz_test", FuzzTest)
