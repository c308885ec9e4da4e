#!/usr/bin/env python3
"""What goes wrong around the node: its master, its publishers, its tf; and how it ends itself."""
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import unittest

import rosgraph
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseStamped
from soft_tissue_sim.msg import TissueState
from soft_tissue_sim.srv import SaveState, SetMaterial
from visualization_msgs.msg import MarkerArray

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import tcpros
from node_process import memory_of, node_process
from sim_client import NODE, PATIENCE_S, SimClient, wait_until

NODE_PROGRAM = ("rosrun", "soft_tissue_sim", "sim_node")
SCENE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "block.yaml")
# Publishes as fast as it can: poses whose frame has a name of a megabyte, so that it dies within one.
HUGE_PUBLISHER = """
import rospy
from geometry_msgs.msg import PoseStamped
rospy.init_node("huge", disable_signals=True)
publisher = rospy.Publisher("/sim_node/probe/servo_cp", PoseStamped, queue_size=2)
message = PoseStamped()
message.header.frame_id = "x" * 1000000
while True:
    publisher.publish(message)
"""
LEADER = """
import rospy, tf2_ros
from geometry_msgs.msg import TransformStamped
rospy.init_node("leader", disable_signals=True)
broadcaster = tf2_ros.TransformBroadcaster()
transform = TransformStamped()
transform.header.frame_id, transform.child_frame_id = "world", "leader"
transform.transform.translation.z, transform.transform.rotation.w = 0.07, 1.0
while True:
    transform.header.stamp = rospy.Time.now()
    broadcaster.sendTransform(transform)
    rospy.rostime.wallsleep(0.02)
"""


class Processes:
    """Programs with logs, ended with the test."""

    def __init__(self, test, **environment):
        folder = tempfile.TemporaryDirectory()
        test.addCleanup(folder.cleanup)
        test.addCleanup(self.end)
        self.folder = folder.name
        self.environment = dict(os.environ, ROS_LOG_DIR=self.folder, **environment)
        self.all = []

    def start(self, name, *command):
        with open(self.log_path(name), "w") as log:
            process = subprocess.Popen(command, env=self.environment, stdout=log, stderr=log)
        self.all.append(process)
        return process

    def start_node(self, *parameters, scene=SCENE, name="sim_node"):
        return self.start(name, *NODE_PROGRAM, "_scene:=" + scene, *parameters)

    def log_path(self, name):
        return os.path.join(self.folder, name + ".log")

    def log(self, name):
        with open(self.log_path(name), errors="replace") as stream:
            return stream.read()

    def end(self):
        for process in self.all:
            if process.poll() is None:
                process.kill()
            process.wait()


class FaultsTest(unittest.TestCase):
    def start_node(self, *parameters, scene=SCENE):
        self.processes = Processes(self)
        self.node = self.processes.start_node(*parameters, scene=scene)
        self.client = SimClient()
        wait_until(lambda: "physics" in self.client.diagnostics, "diagnostics")

    def assert_time_goes_on(self):
        before = self.client.sim_time()
        wait_until(lambda: self.client.sim_time() > before + 0.05, "simulated time goes on")

    def test_a_publisher_killed_within_a_message_is_forgotten(self):
        self.start_node("_watchdog_s:=0.5")
        key = "rejected: quaternion not unit"
        for _ in range(3):
            before = self.client.count("probe commands", key)
            publisher = self.processes.start("huge", sys.executable, "-c", HUGE_PUBLISHER)
            wait_until(lambda: self.client.count("probe commands", key) > before, "its poses come in")
            publisher.kill()
            publisher.wait()
            self.assert_time_goes_on()
        self.client.move_to((0.0, 0.0, 0.05))

    def test_a_cut_tf_tree_holds_the_tool_and_is_told(self):
        self.start_node("_watchdog_s:=0.5")
        client = self.client
        client.listen("follower/measured_cp", PoseStamped)
        leader = self.processes.start("leader", sys.executable, "-c", LEADER)
        wait_until(lambda: client.levels["follower commands"] == DiagnosticStatus.OK
                   and client.count("follower commands", "accepted") > 0, "the follower follows")
        leader.kill()
        wait_until(lambda: client.levels["follower commands"] == DiagnosticStatus.WARN, "the follower is held")
        self.assert_time_goes_on()
        self.assertAlmostEqual(client.newest["follower/measured_cp"].pose.position.z, 0.07, places=9)

    def test_an_interrupted_node_ends_well(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            self.start_node("_real_time_factor:=0")  # always within a step
            self.node.send_signal(number)
            self.assertEqual(self.node.wait(timeout=PATIENCE_S), 0)
            self.assertNotIn("terminate called", self.processes.log("sim_node"))

    def test_a_new_master_does_not_stop_the_node(self):
        with socket.socket() as probe:
            probe.bind(("localhost", 0))
            port = probe.getsockname()[1]
        processes = Processes(self, ROS_MASTER_URI="http://localhost:%d" % port)
        handle = rosgraph.Master("/faults", master_uri=processes.environment["ROS_MASTER_URI"])

        def start_master():
            master = processes.start("master", "rosmaster", "--core", "-p", str(port))
            wait_until(handle.is_online, "the master answers")
            return master

        def assert_messages_come(when):
            lines = processes.log("listener").count("---")
            wait_until(lambda: processes.log("listener").count("---") > lines + 20, "messages " + when)

        master = start_master()
        node = processes.start_node()
        listener = processes.start("listener", "rostopic", "echo", "/sim_node/stats/sim_time")
        assert_messages_come("at first")
        master.kill()
        master.wait()
        assert_messages_come("without a master")
        start_master()
        assert_messages_come("with a new master")
        self.assertIsNone(node.poll())
        self.assertIsNone(listener.poll())

    def test_a_second_node_of_the_same_name_takes_its_place(self):
        self.start_node()
        first = self.node
        before = self.client.newest["stats"].step
        wait_until(lambda: self.client.newest["stats"].step > before + 200, "the first one steps")
        self.processes.start_node(name="second")
        self.assertEqual(first.wait(timeout=PATIENCE_S), 0)
        wait_until(lambda: self.client.newest["stats"].step < before + 200, "messages are those of the second")
        self.assert_time_goes_on()
        self.client.move_to((0.0, 0.0, 0.05))

    def test_files_that_change_while_it_runs_change_nothing(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        scene, mesh = (shutil.copy(os.path.join(os.path.dirname(SCENE), name), folder.name)
                       for name in ("block.yaml", "block.msh"))
        self.start_node(scene=scene)
        for path in (scene, mesh):
            with open(path, "w") as stream:
                stream.write("nothing of use")
        self.client.reset()
        self.assert_time_goes_on()

        def set_material():
            return rospy.ServiceProxy(NODE + "/set_material", SetMaterial)(
                tissue="block", young_modulus=3e4, poisson_ratio=0.4, density=1e3, stiffening=float("nan"))

        answer = set_material()
        self.assertFalse(answer.success)
        self.assertIn(mesh, answer.message)
        self.assert_time_goes_on()
        shutil.copy(os.path.join(os.path.dirname(SCENE), "block.msh"), mesh)
        self.assertTrue(set_material().success)
        self.assert_time_goes_on()

    def test_subscribers_that_never_read_take_no_memory(self):
        self.start_node("_real_time_factor:=0", "_state_rate_hz:=0", "_stats_rate_hz:=0")
        pid = node_process()
        silent = [tcpros.Subscriber(tcpros.topic_address(NODE, topic), topic, message_class)
                  for topic, message_class in ((NODE + "/block/state", TissueState), (NODE + "/markers", MarkerArray))]

        def pass_time(seconds):
            before = self.client.sim_time()
            wait_until(lambda: self.client.sim_time() > before + seconds, "simulated time goes on")

        pass_time(2.0)
        warm = memory_of(pid)
        pass_time(4.0)
        self.assertLess(memory_of(pid) - warm, 1 << 20)  # states alone are 800 times 5 KB
        for subscriber in silent:
            subscriber.close()

    def test_a_full_disk_is_told_to_who_saves_a_state(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.processes = Processes(self)
        limited = "trap '' XFSZ; ulimit -f 16; exec \"$@\" _scene:=" + SCENE
        self.processes.start("sim_node", "bash", "-c", limited, "bash", *NODE_PROGRAM)
        self.client = SimClient()
        path = os.path.join(folder.name, "state")
        answer = rospy.ServiceProxy(NODE + "/save_state", SaveState)(path)
        self.assertFalse(answer.success)
        self.assertEqual(answer.message, path + ": can't be written")
        self.assertEqual(os.listdir(folder.name), [])
        self.assert_time_goes_on()


if __name__ == "__main__":
    rospy.init_node("faults_test")
    rostest.rosrun("soft_tissue_sim", "faults_test", FaultsTest)
