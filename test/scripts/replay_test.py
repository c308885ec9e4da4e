#!/usr/bin/env python3
"""run_scene from outside: long bags replay to the same bits, and what ends it early leaves readable files."""
import json
import math
import os
import signal
import subprocess
import tempfile
import time
import unittest

import rosbag
import rospy
from geometry_msgs.msg import PoseStamped

RUN_SCENE = os.environ["RUN_SCENE"]
BLOCK = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../ros/block.msh")
PATIENCE_S = 300.0
SCENE = """time_step_s: 0.005
tissues:
  - name: block
    mesh: {file: %s, length_unit: m}
    material: {model: neo_hookean, young_modulus_pa: 20000, poisson_ratio: 0.4, density_kg_per_m3: 1000}
    fixed: [{box_m: [[-1, -1, -0.001], [1, 1, 0.001]]}]
tools:
  - name: probe
    shape: {sphere: {radius_m: 0.008}}
    pose_source: {topic: servo_cp}
contacts: [{between: [block, probe]}]
"""


def stroke(time_s):
    """The probe's way: up and down, and round about."""
    return (0.01 * math.cos(0.7 * time_s), 0.01 * math.sin(0.9 * time_s), 0.037 + 0.003 * math.cos(2.0 * time_s))


class ReplayTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        with open(self.path("scene.yaml"), "w") as stream:
            stream.write(SCENE % BLOCK)

    def path(self, name):
        return os.path.join(self.folder, name)

    def record(self, length_s, rate_hz):
        message = PoseStamped()
        message.header.frame_id = "world"
        message.pose.orientation.w = 1.0
        with rosbag.Bag(self.path("poses.bag"), "w", compression="lz4") as bag:
            for i in range(int(length_s * rate_hz) + 1):
                message.header.stamp = rospy.Time(1000) + rospy.Duration(i / rate_hz)
                message.pose.position.x, message.pose.position.y, message.pose.position.z = stroke(i / rate_hz)
                bag.write("/probe/servo_cp", message, message.header.stamp)

    def start(self, *arguments):
        return subprocess.Popen([RUN_SCENE, self.path("scene.yaml"), "--bag-in", self.path("poses.bag"), "--quiet",
                                 *arguments], stderr=subprocess.PIPE, universal_newlines=True)

    def wait_for_size(self, path, size):
        for _ in range(int(PATIENCE_S / 0.01)):
            if os.path.exists(path) and os.path.getsize(path) > size:
                return
            time.sleep(0.01)
        self.fail("%s does not grow" % path)

    def steps_in(self, path):
        with rosbag.Bag(path) as bag:
            return [message.step for _, message, _ in bag.read_messages("/sim_node/stats")]

    def test_a_minute_at_a_kilohertz_ends_in_the_same_bits(self):
        self.record(60.0, 1000)
        hashes = []
        for threads in ("1", "2", "2"):
            run = self.start("--threads", threads, "--json", self.path("run.json"))
            _, said = run.communicate(timeout=PATIENCE_S)
            self.assertEqual(run.returncode, 0, said)
            self.assertEqual(said, "")
            with open(self.path("run.json")) as stream:
                summary = json.load(stream)
            self.assertEqual(summary["steps"], 12000)
            self.assertEqual(summary["steps_held"], 0)
            self.assertGreater(summary["tools"][0]["peak_force_n"], 0.05)
            self.assertEqual(summary["tools"][0]["inputs"], [
                {"of": "pose", "topic": "/probe/servo_cp", "messages": 60001, "used": 60001, "out_of_order": 0,
                 "beyond_limits": 0, "rejected": []}])
            hashes.append(summary["state_hash"])
        print("  60 s of poses at 1 kHz: %s" % ", ".join(hashes))
        self.assertEqual(len(set(hashes)), 1)

    def test_what_is_lost_of_a_spoilt_bag_is_told(self):
        message = PoseStamped()
        message.pose.orientation.w = 1.0
        stamps = list(range(100, 200)) + [150, 150, 199, 120.5, 200]
        with rosbag.Bag(self.path("poses.bag"), "w") as bag:
            for number, stamp in enumerate(stamps):
                message.header.stamp = rospy.Time(stamp)
                message.pose.position.z = math.nan if stamp in (110, 120) else 0.06
                bag.write("/probe/servo_cp", message, rospy.Time(1000 + number))
        run = self.start("--duration", "0.01", "--json", self.path("run.json"))
        _, said = run.communicate(timeout=PATIENCE_S)
        self.assertEqual(run.returncode, 0, said)
        with open(self.path("run.json")) as stream:
            told, = json.load(stream)["tools"][0]["inputs"]
        rejected = {one["reason"]: one["messages"] for one in told.pop("rejected")}
        self.assertEqual(told, {"of": "pose", "topic": "/probe/servo_cp", "messages": 105, "used": 100,
                                "out_of_order": 3, "beyond_limits": 0})
        self.assertEqual(rejected, {"NaN or infinity in it": 2, "another one after it has the same stamp": 3})
        for reason, count in rejected.items():
            self.assertIn("/probe/servo_cp (pose): %d of 105 left out: %s" % (count, reason), said)

    def test_a_killed_run_leaves_a_bag_to_reindex(self):
        self.record(60.0, 50)
        bag = self.path("out.bag")
        run = self.start("--bag-out", bag)
        self.wait_for_size(bag, 600000)
        run.send_signal(signal.SIGKILL)
        run.communicate(timeout=PATIENCE_S)
        with self.assertRaises(rosbag.ROSBagUnindexedException):
            rosbag.Bag(bag)
        subprocess.run(["rosbag", "reindex", "--quiet", bag], check=True, stdout=subprocess.DEVNULL)
        steps = self.steps_in(bag)
        print("  killed: %d steps of the bag are left" % len(steps))
        self.assertGreater(len(steps), 50)
        self.assertEqual(steps, list(range(1, len(steps) + 1)))

    def test_an_interrupted_run_closes_its_files(self):
        self.record(60.0, 50)
        bag, table = self.path("out.bag"), self.path("out.csv")
        for number in (signal.SIGINT, signal.SIGTERM):
            run = self.start("--bag-out", bag, "--csv", table, "--json", self.path("run.json"))
            self.wait_for_size(bag, 300000)
            run.send_signal(number)
            _, said = run.communicate(timeout=PATIENCE_S)
            self.assertEqual(run.returncode, 130)
            self.assertIn("interrupted", said)
            steps = self.steps_in(bag)
            with open(table) as stream:
                rows = stream.read().splitlines()[1:]
            with open(self.path("run.json")) as stream:
                self.assertEqual(json.load(stream)["steps"], len(steps))
            self.assertEqual([int(row.split(",")[0]) for row in rows], steps)
            os.remove(bag)


if __name__ == "__main__":
    unittest.main()
