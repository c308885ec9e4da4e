#!/usr/bin/env python3
"""The node on wall time: what it publishes, what it refuses, what cannot slow it down."""
import math
import os
import signal
import subprocess
import sys
import time
import unittest

import rospy
import rostest
import tf2_ros
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import Point, TransformStamped
from soft_tissue_sim.msg import TissueField
from soft_tissue_sim.srv import QueryDistance
from visualization_msgs.msg import Marker, MarkerArray

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from sim_client import NODE, PATIENCE_S, SimClient, wait_for_mesh, wait_for_state, wait_until

ABOVE = (0.0, 0.0, 0.05)
PRESSED = (0.0, 0.0, 0.035)  # 3 mm into the block
QUARTER_TURN_ABOUT_X = (math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))


class SimNodeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = SimClient()
        cls.client.wait_for_commands_to_arrive()

    def setUp(self):
        self.client.unpause()
        self.client.reset()

    def pressed_messages(self, rotation):
        """Messages of one step in which the probe rests, pressed into the block."""
        client = self.client
        client.move_to(ABOVE, rotation=rotation)
        client.forget_messages()
        client.move_to(PRESSED, rotation=rotation)
        settled = client.sim_time() + 0.5
        client.command_until(lambda: client.complete_step_after(settled), "all messages of a step",
                             PRESSED, rotation=rotation)
        return client.complete_step_after(settled)

    def test_force_pushes_the_tool_out_and_turns_with_its_axes(self):
        for rotation, out_of_tissue in (((0, 0, 0, 1), "z"), (QUARTER_TURN_ABOUT_X, "y")):
            found = self.pressed_messages(rotation)
            body = found["probe/body/measured_cf"]
            spatial = found["probe/spatial/measured_cf"]
            self.assertEqual(body.header.frame_id, "probe")
            self.assertEqual(spatial.header.frame_id, "world")
            self.assertGreater(spatial.wrench.force.z, 0.02)
            self.assertAlmostEqual(getattr(body.wrench.force, out_of_tissue),
                                   spatial.wrench.force.z, places=9)

    def test_distances_are_those_of_the_tissue_as_it_is(self):
        rospy.wait_for_service(NODE + "/query_distance", PATIENCE_S)
        query = rospy.ServiceProxy(NODE + "/query_distance", QueryDistance)
        client = self.client
        nan = float("nan")
        points = [Point(0.03 - 0.005, 0.0, 0.012), Point(0.0, 0.0, 0.003), Point(0.0, 0.0, -0.02),
                  Point(0.0, 0.0, -0.05), Point(nan, 0.0, 0.0)]
        self.pressed_messages((0, 0, 0, 1))
        for name in ("", "block"):
            found = query(tissue=name, points=points, max_distance=0.03)
            self.assertTrue(found.success, found.message)
            self.assertEqual(found.header.frame_id, "world")
            self.assertGreater(found.step, 0)
            self.assertAlmostEqual(found.depths[0], 0.005, delta=0.001)  # its side, bulged a little
            self.assertGreater(found.gradients[0].x, -1.01)
            self.assertLess(found.gradients[0].x, -0.9)
            self.assertAlmostEqual(found.depths[1], 0.003, places=9)  # above its fixed bottom
            self.assertAlmostEqual(found.gradients[1].z, 1.0, places=9)
            self.assertAlmostEqual(found.depths[2], -0.02, places=9)
            self.assertAlmostEqual(found.gradients[2].z, 1.0, places=9)
            self.assertEqual(found.depths[3], -float("inf"))
            self.assertTrue(math.isnan(found.depths[4]))
            self.assertEqual(list(found.tissues), ["block"] * 4 + [""])
        # Beside the pressed probe the top lies lower than at rest.
        tip = [Point(0.0, 0.0, 0.03 - 0.0005)]
        self.assertLess(query(points=tip).depths[0], 0.0)
        client.move_to(ABOVE)
        client.reset()
        wait_until(lambda: query(points=tip).depths[0] > 0.0, "the top is back")
        self.assertIn("block", query(tissue="liver", points=points).message)
        self.assertIn("max_distance", query(points=points, max_distance=-1.0).message)

    def test_contacts_add_up_to_force_and_moment_about_the_tools_origin(self):
        found = self.pressed_messages((0, 0, 0, 1))
        contacts = found["probe/contacts"]
        origin = found["probe/measured_cp"].pose.position
        force = [0.0, 0.0, 0.0]
        moment = [0.0, 0.0, 0.0]
        self.assertGreater(len(contacts.points), 0)
        for point, f, normal, area, depth in zip(contacts.points, contacts.forces, contacts.normals,
                                                 contacts.areas, contacts.depths):
            r = (point.x - origin.x, point.y - origin.y, point.z - origin.z)
            if area > 0.0:
                self.assertGreaterEqual(f.x * normal.x + f.y * normal.y + f.z * normal.z, 0.0)
            else:  # where an edge is clipped
                self.assertEqual(depth, 0.0)
            for axis, value in enumerate((f.x, f.y, f.z)):
                force[axis] += value
            moment[0] += r[1] * f.z - r[2] * f.y
            moment[1] += r[2] * f.x - r[0] * f.z
            moment[2] += r[0] * f.y - r[1] * f.x
        self.assertGreater(force[2], 0.02)
        wrench = found["probe/spatial/measured_cf"].wrench
        for axis, name in enumerate("xyz"):
            self.assertAlmostEqual(force[axis], getattr(wrench.force, name), places=9)
            self.assertAlmostEqual(moment[axis], getattr(wrench.torque, name), places=9)

    def test_late_subscriber_gets_mesh_state_and_field(self):
        mesh = wait_for_mesh()
        state = wait_for_state()
        field = rospy.wait_for_message(NODE + "/block/field", TissueField, PATIENCE_S)
        self.assertEqual(len(mesh.rest_positions), 3 * 196)
        self.assertEqual(len(mesh.tets), 4 * 648)
        self.assertEqual(len(mesh.fixed_nodes), 49)
        self.assertEqual(mesh.topology_id, state.topology_id)
        self.assertEqual(mesh.topology_id, field.topology_id)
        self.assertEqual(len(state.positions), 3 * 196)
        self.assertEqual(len(field.depths), 196)
        self.assertAlmostEqual(max(field.depths), 0.01, places=3)  # the middle of 3 cells

    def test_a_scene_without_pairs_of_tissues_has_no_topic_for_them(self):
        topics = [name for name, _ in rospy.get_published_topics(NODE)]
        self.assertIn(NODE + "/probe/contacts", topics)
        self.assertNotIn(NODE + "/contacts", topics)

    def test_bad_commands_are_refused_and_the_simulation_goes_on(self):
        client = self.client
        client.move_to(ABOVE)
        old = rospy.Time.now() - rospy.Duration(5.0)
        bad = {"rejected: not finite": dict(position=(float("nan"), 0, 0.03)),
               "rejected: quaternion not unit": dict(position=PRESSED, rotation=(0, 0, 0, 1.01)),
               "rejected: too far": dict(position=(0, 0, 10.5)),
               "tf failures: unknown frame": dict(position=PRESSED, frame="nowhere"),
               # After a silence it would be accepted, and a stalled machine makes silences: it must do no harm.
               "rejected: stamp went back": dict(position=ABOVE, stamp=old)}
        for key, command in bad.items():
            before = client.count("probe commands", key)
            step = client.newest["stats"].step

            def refused():
                client.command(ABOVE)  # keeps the stream of stamps alive
                time.sleep(0.02)
                client.command(**command)
                return client.count("probe commands", key) > before

            wait_until(refused, key)
            wait_until(lambda: client.newest["stats"].step > step, "steps go on")
            self.assertTrue(math.dist(client.position(), ABOVE) < 1e-9, key)
        client.move_to((0.0, 0.0, 0.055))

    def test_watchdog_warns_and_holds_the_pose(self):
        client = self.client

        def warns():
            return client.levels.get("probe commands") == DiagnosticStatus.WARN

        client.move_to(ABOVE)
        client.command_until(lambda: not warns(), "diagnostics are content", ABOVE)
        wait_until(warns, "diagnostics warn of silence")
        self.assertLess(math.dist(client.position(), ABOVE), 1e-9)
        client.command_until(lambda: not warns(), "diagnostics are content again", ABOVE)

    def test_pause_step_and_reset_keep_time(self):
        client = self.client
        refused = client.step(1)
        self.assertFalse(refused.success)
        self.assertIn("pause_physics", refused.message)
        client.pause()
        self.assertFalse(client.step(0).success)
        start = client.step(1).time
        time.sleep(0.3)
        after = client.step(20)
        self.assertTrue(after.success)
        self.assertAlmostEqual(after.time, start + 20 * 0.005, places=9)
        wait_until(lambda: abs(client.sim_time() - after.time) < 1e-9, "the last step is published")
        client.reset()
        self.assertAlmostEqual(client.step(1).time, after.time + 0.005, places=9)

    def test_reset_restores_rest_shape_and_initial_pose(self):
        client = self.client
        rest = wait_for_mesh().rest_positions
        self.pressed_messages((0, 0, 0, 1))
        deformed = wait_for_state().positions
        self.assertGreater(max(abs(a - b) for a, b in zip(deformed, rest)), 1e-3)
        client.pause()
        client.reset()
        wait_until(lambda: wait_for_state().positions == rest, "the block is back")
        wait_until(lambda: abs(client.position()[2] - 0.06) < 1e-9, "the probe is back")

    def test_markers_cost_nothing_unless_somebody_looks(self):
        client = self.client
        key = "marker arrays built"
        wait_until(lambda: client.count("physics", "steps") > 0, "diagnostics")
        idle = client.count("physics", key)
        steps = client.count("physics", "steps")
        wait_until(lambda: client.count("physics", "steps") > steps + 100, "steps without markers")
        self.assertEqual(client.count("physics", key), idle)
        arrays = []
        subscriber = rospy.Subscriber(NODE + "/markers", MarkerArray, arrays.append)
        wait_until(lambda: len(arrays) > 3, "markers")
        namespaces = {marker.ns for marker in arrays[-1].markers}
        self.assertLessEqual({"block", "block/fixed", "block/distance/slice",
                              "block/distance/nodes", "probe", "probe/contacts"}, namespaces)
        names = [(marker.ns, marker.id) for marker in arrays[-1].markers]
        self.assertEqual(len(names), len(set(names)))
        client.reset()
        wait_until(lambda: any(array.markers[0].action == Marker.DELETEALL for array in arrays),
                   "markers are deleted on reset")
        subscriber.unregister()

    def test_a_stopped_subscriber_does_not_hold_up_the_physics(self):
        listener = subprocess.Popen(["rostopic", "echo", NODE + "/markers"], stdout=subprocess.PIPE)
        try:
            listener.stdout.readline()  # it listens
            os.kill(listener.pid, signal.SIGSTOP)
            self.assert_time_goes_on(3.0)  # more than what fits into the sockets' buffers
        finally:
            os.kill(listener.pid, signal.SIGKILL)
            listener.communicate()

    def test_a_flood_of_commands_does_not_hold_up_the_physics(self):
        def flood():
            for _ in range(500):
                self.client.command(ABOVE)

        self.assert_time_goes_on(1.0, meanwhile=flood)
        wait_until(lambda: math.dist(self.client.position(), ABOVE) < 1e-9, "the flood is obeyed")

    def assert_time_goes_on(self, simulated_s, meanwhile=lambda: None):
        """Simulated time moves on, be it ever so slowly; if something blocked it, it would stand still."""
        goal = self.client.sim_time() + simulated_s

        def reached():
            meanwhile()
            return self.client.sim_time() > goal

        wait_until(reached, "simulated time goes on")

    def test_a_tool_follows_a_tf_frame(self):
        broadcaster = tf2_ros.TransformBroadcaster()
        buffer = tf2_ros.Buffer()
        tf2_ros.TransformListener(buffer)

        def follower_arrived():
            transform = TransformStamped()
            transform.header.stamp = rospy.Time.now()
            transform.header.frame_id = "world"
            transform.child_frame_id = "leader"
            transform.transform.translation.z = 0.07
            transform.transform.rotation.w = 1.0
            broadcaster.sendTransform(transform)
            try:
                found = buffer.lookup_transform("world", "follower", rospy.Time()).transform
            except tf2_ros.TransformException:
                return False
            return abs(found.translation.z - 0.07) < 1e-9 and abs(found.translation.x) < 1e-9

        wait_until(follower_arrived, "the follower reaches its leader")

    def test_commands_in_another_frame_are_transformed(self):
        broadcaster = tf2_ros.TransformBroadcaster()

        def arrived():
            transform = TransformStamped()
            transform.header.stamp = rospy.Time.now()
            transform.header.frame_id = "world"
            transform.child_frame_id = "base"
            transform.transform.translation.x = 0.01
            transform.transform.rotation.x, _, _, transform.transform.rotation.w = \
                QUARTER_TURN_ABOUT_X
            self.client.command((0.0, 0.055, 0.0), frame="base", stamp=transform.header.stamp)
            broadcaster.sendTransform(transform)  # the command has to wait for it
            time.sleep(0.02)
            return math.dist(self.client.position(), (0.01, 0.0, 0.055)) < 1e-9

        wait_until(arrived, "the probe is where the command means")


if __name__ == "__main__":
    rospy.init_node("sim_node_test")
    rostest.rosrun("soft_tissue_sim", "sim_node_test", SimNodeTest)
