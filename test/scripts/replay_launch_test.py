#!/usr/bin/env python3
"""replay.launch: what a bag has for a scene's tools and obstacles reaches the node, as run_scene reads it."""
import math
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

import rosbag
import rospy
from geometry_msgs.msg import PoseStamped, TransformStamped, TwistStamped
from octomap_msgs.msg import Octomap
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "../ros"))
from octomap_codec import encode_binary

SCENE = os.path.join(HERE, "../ros/everything.yaml")
PATIENCE_S = 120.0
LENGTH_S, RATE_HZ = 4.0, 100
END = rospy.Time(1000) + rospy.Duration(LENGTH_S)


def pose_at(time_s):
    message = PoseStamped()
    message.header.frame_id = "world"
    message.pose.orientation.w = 1.0
    message.pose.position.x, message.pose.position.z = 0.01 * math.sin(time_s), 0.05 + 0.002 * time_s
    return message


def beside_at(time_s):
    message = pose_at(time_s)
    message.pose.position.x, message.pose.position.y, message.pose.position.z = 0.1, 0.1, 0.1 + 0.002 * time_s
    return message


def twist_at(_):
    message = TwistStamped()
    message.twist.linear.x = 0.01
    return message


def joints_at(time_s, name="wrist", share=0.05):
    message = JointState()
    message.name, message.position = [name], [share * time_s]
    return message


def transform_at(time_s):
    one = TransformStamped()
    one.header.frame_id, one.child_frame_id = "world", "leader"
    one.transform.translation.x, one.transform.translation.z = 0.005 * time_s, 0.08
    one.transform.rotation.w = 1.0
    return one


def free_port():
    with socket.socket() as one:
        one.bind(("localhost", 0))
        return one.getsockname()[1]


class ReplayLaunchTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.bag = os.path.join(self.folder, "everything.bag")

    def record(self):
        """One of each stream, on the topics of nodes with other names; and what is none of the scene's business."""
        with rosbag.Bag(self.bag, "w") as bag:
            floor = Octomap(binary=True, id="OcTree", resolution=0.005)
            floor.data = encode_binary({(x, y, -4) for x in range(4) for y in range(4)})
            floor.header.stamp = rospy.Time(1000)
            bag.write("/map_server/octomap_in", floor, rospy.Time(1000))
            for i in range(int(LENGTH_S * RATE_HZ) + 1):
                time_s, stamp = i / RATE_HZ, rospy.Time(1000) + rospy.Duration(i / RATE_HZ)
                streams = (("/robot/probe/measured_cp", pose_at(time_s)), ("/hand/flyer/servo_cv", twist_at(time_s)),
                           ("/arm/grasper/servo_cp", beside_at(time_s)), ("/arm/grasper/joint_states", joints_at(time_s)),
                           ("/arm/grasper/jaw/measured_js", joints_at(time_s, "jaw")),
                           ("/elsewhere/other/servo_cp", pose_at(0.0)))
                for topic, message in streams:
                    message.header.stamp = stamp
                    bag.write(topic, message, stamp)
                transform = transform_at(time_s)
                transform.header.stamp = stamp
                bag.write("/tf", TFMessage(transforms=[transform]), stamp)

    def replayed(self):
        """{topic: last message} of run_scene on the same bag."""
        out = os.path.join(self.folder, "out.bag")
        subprocess.run(["rosrun", "soft_tissue_sim", "run_scene", SCENE, "--bag-in", self.bag, "--bag-out", out,
                        "--quiet"], check=True)
        with rosbag.Bag(out) as bag:
            return {topic: message for topic, message, _ in bag.read_messages()}

    def launch(self, *arguments):
        """Plays the bag to its end. @return ({topic: newest message of it before the clock stopped}, diagnostics)"""
        port = str(free_port())
        environment = dict(os.environ, ROS_MASTER_URI="http://localhost:" + port, ROS_HOSTNAME="localhost",
                           ROSCONSOLE_STDOUT_LINE_BUFFERED="1")
        heard = os.path.join(self.folder, "heard.bag")
        launch = subprocess.Popen(["roslaunch", "-p", port, "soft_tissue_sim", "replay.launch", "bag:=" + self.bag,
                                   "scene:=" + SCENE, "threads:=1", "delay:=8", *arguments])
        try:
            topics = ["/sim_node/" + name for name in ("probe/measured_cp", "flyer/measured_cp", "follower/measured_cp",
                                                       "grasper/measured_js", "grasper/jaw/measured_js", "stats")]
            self.wait_until(lambda: {"/sim_node", "/play"} <= self.nodes(environment), launch, "all nodes are there")
            record = subprocess.Popen(["rosbag", "record", "--quiet", "-O", heard, "/diagnostics", *topics], env=environment)
            self.wait_until(lambda: "/play" not in self.nodes(environment), launch, "the bag has ended")
            time.sleep(2.0)  # of /diagnostics there is one a second
            record.send_signal(signal.SIGINT)
            record.wait(timeout=PATIENCE_S)
        finally:
            launch.terminate()
            launch.wait(timeout=PATIENCE_S)
        with rosbag.Bag(heard) as bag:
            newest = {topic: message for topic, message, _ in bag.read_messages() if topic != "/diagnostics"}
            statuses = {status.name.split(": ")[1]: {pair.key: pair.value for pair in status.values}
                        for _, array, _ in bag.read_messages("/diagnostics") for status in array.status
                        if "sim_node: " in status.name}
        return newest, statuses

    def wait_until(self, condition, launch, what):
        deadline_s = time.monotonic() + PATIENCE_S
        while not condition():
            self.assertLess(time.monotonic(), deadline_s, "waited in vain until " + what)
            self.assertIsNone(launch.poll(), "roslaunch ended before " + what)
            time.sleep(0.2)

    @staticmethod
    def nodes(environment):
        return set(subprocess.run(["rosnode", "list"], env=environment, stdout=subprocess.PIPE,
                                  stderr=subprocess.DEVNULL, universal_newlines=True).stdout.split())

    def test_every_stream_reaches_the_node(self):
        self.record()
        offline = self.replayed()
        live, statuses = self.launch()
        for stream in ("probe commands", "flyer commands", "follower commands", "grasper commands",
                       "grasper joint commands", "grasper jaw commands", "plate maps"):
            self.assertGreater(int(statuses[stream]["accepted"]), 0, stream)
            # A frame that is missing before the bag begins counts once.
            self.assertEqual(int(statuses[stream]["rejected"]),
                             int(statuses[stream].get("tf failures: unknown frame", 0)), stream)
        print("  played as long as: %.3f s of %.3f s" % (live["/sim_node/stats"].header.stamp.to_sec() - 1000, LENGTH_S))
        for topic in ("probe/measured_cp", "follower/measured_cp", "flyer/measured_cp"):
            there, here = (messages["/sim_node/" + topic].pose.position for messages in (live, offline))
            # The node reads poses as late as they are apart; velocities begin when the first one came.
            self.assertLess(math.dist((there.x, there.y, there.z), (here.x, here.y, here.z)), 1e-3, topic)
        for topic in ("grasper/measured_js", "grasper/jaw/measured_js"):
            there, here = (messages["/sim_node/" + topic] for messages in (live, offline))
            self.assertEqual(there.name, here.name)
            for a, b in zip(there.position, here.position):
                self.assertAlmostEqual(a, b, delta=0.01, msg=topic)
        self.assertAlmostEqual(offline["/sim_node/grasper/jaw/measured_js"].position[0], 0.05 * LENGTH_S, delta=1e-9)

    def test_a_bag_with_nothing_for_the_scene_is_refused(self):
        with rosbag.Bag(self.bag, "w") as bag:
            bag.write("/elsewhere/other/servo_cp", pose_at(0.0), rospy.Time(1))
        said = subprocess.run(["rosrun", "soft_tissue_sim", "replay_bag.py", "--scene", SCENE, "--bag", self.bag],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        self.assertEqual(said.returncode, 1)
        self.assertIn("has nothing that moves a tool", said.stdout)
        self.assertIn("it has nothing for probe/servo_cp", said.stdout)

    def test_more_topics_are_renamed_as_told(self):
        sys.path.insert(0, os.path.join(HERE, "../../scripts"))
        import replay_bag
        command = replay_bag.play_command([["/PSM1/setpoint_cp", "psm/servo_cp"], ["/tf", "/tf"]], "/sim_node", "a.bag",
                                          ["--rate=2"])
        self.assertEqual(command[-6:], ["--rate=2", "--topics", "/PSM1/setpoint_cp", "/tf", "--bags=a.bag",
                                        "/PSM1/setpoint_cp:=/sim_node/psm/servo_cp"])


if __name__ == "__main__":
    unittest.main()
