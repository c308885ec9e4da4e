#!/usr/bin/env python3
"""Each scene that comes along has a configuration of rviz, which its launch files load and whose topics it publishes."""
import glob
import os
import sys
import unittest

import rosgraph
import rospy
import rostest
import yaml
from roslaunch.config import load_config_default
from visualization_msgs.msg import MarkerArray

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from sim_client import PATIENCE_S, wait_until

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../.."))
NODE = "/sim_node"
TOPIC_KEYS = {"Marker Topic": "visualization_msgs/MarkerArray", "Update Topic": "visualization_msgs/InteractiveMarkerUpdate"}


def names(folder, ending):
    return {os.path.basename(path)[:-len(ending)] for path in glob.glob(os.path.join(ROOT, folder, "*" + ending))}


SCENES = sorted(names("config/scenes", ".yaml"))


def displays(name):
    with open(os.path.join(ROOT, "config/rviz", name + ".rviz")) as stream:
        return yaml.safe_load(stream)["Visualization Manager"]


def shown_by(launch_file, *arguments):
    """The configuration that a launch file gives to rviz."""
    path = os.path.join(ROOT, "launch", launch_file)
    config = load_config_default([(path, ["rviz:=true", *arguments])], None, assign_machines=False)
    command, = [node.args.split() for node in config.nodes if node.type == "rviz"]
    return os.path.relpath(os.path.realpath(command[command.index("-d") + 1]), ROOT)


class RvizTest(unittest.TestCase):
    def test_each_scene_has_one(self):
        self.assertEqual(names("config/rviz", ".rviz"), set(SCENES) | {"sim"})

    def test_launch_files_load_that_of_the_scene(self):
        for name in SCENES:
            scene = "scene:=" + os.path.join(ROOT, "config/scenes", name + ".yaml")
            for launch_file, *more in (("sim.launch",), ("demo.launch",), ("dvrk.launch",), ("replay.launch", "bag:=a.bag")):
                self.assertEqual(shown_by(launch_file, scene, *more), "config/rviz/%s.rviz" % name, launch_file)
        self.assertEqual(shown_by("demo.launch", "fine:=true"), "config/rviz/palpation_20k.rviz")
        self.assertEqual(shown_by("sim.launch", "scene:=/home/me/mine.yaml"), "config/rviz/sim.rviz")
        self.assertTrue(shown_by("demo.launch", "rviz_config:=/home/me/mine.rviz").endswith("home/me/mine.rviz"))

    def test_a_node_of_another_name_is_shown(self):
        path = os.path.join(ROOT, "launch/sim.launch")
        config = load_config_default([(path, ["rviz:=true", "name:=other"])], None, assign_machines=False)
        rviz, = [node for node in config.nodes if node.type == "rviz"]
        self.assertIn(["/sim_node/markers", "other/markers"], [list(pair) for pair in rviz.remap_args])

    def test_topics_are_those_that_the_scene_publishes(self):
        for name in SCENES:
            topics = {key: display[key] for display in displays(name)["Displays"] for key in TOPIC_KEYS if key in display}
            self.assertIn("Marker Topic", topics)
            wait_until(lambda: "/%s%s/markers" % (name, NODE) in self.published(), name + " is there")
            published = self.published()
            for key, topic in topics.items():
                self.assertTrue(topic.startswith(NODE + "/"), topic)
                self.assertEqual(published.get("/" + name + topic), TOPIC_KEYS[key], "%s of %s.rviz" % (topic, name))
            dragged = "Update Topic" in topics
            self.assertEqual(dragged, "/%s%s/tools/update" % (name, NODE) in published, "handles of " + name)

    def test_namespaces_are_those_of_the_markers(self):
        for name in SCENES:
            array = rospy.wait_for_message("/%s%s/markers" % (name, NODE), MarkerArray, PATIENCE_S)
            there = {marker.ns for marker in array.markers}
            listed, = [display["Namespaces"] for display in displays(name)["Displays"] if "Namespaces" in display]
            self.assertEqual(there, set(listed), name)
            self.assertEqual({one for one, shown in listed.items() if not shown},
                             {one for one in there if "/distance/" in one}, name)

    def test_the_fixed_frame_is_the_world(self):
        for name in SCENES + ["sim"]:
            self.assertEqual(displays(name)["Global Options"]["Fixed Frame"], "world")

    @staticmethod
    def published():
        return dict(rosgraph.Master(rospy.get_name()).getTopicTypes())


if __name__ == "__main__":
    rospy.init_node("rviz_test")
    rostest.rosrun("soft_tissue_sim", "rviz_test", RvizTest)
