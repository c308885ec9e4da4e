#!/usr/bin/env python3
"""The node ends with status 1 and says why, if it is started with what it cannot use."""
import subprocess
import unittest

import roslib.packages
import rospkg
import rospy
import rostest

NODE = roslib.packages.find_node("soft_tissue_sim", "sim_node")[0]
SCENE = rospkg.RosPack().get_path("soft_tissue_sim") + "/test/ros/block.yaml"


def start(**params):
    """Status and output of a node that is expected to end by itself."""
    arguments = ["_%s:=%s" % pair for pair in params.items()]
    done = subprocess.run([NODE, "__name:=refused"] + arguments,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=60, text=True)
    for name in params:
        rospy.delete_param("/refused/" + name)
    return done.returncode, done.stdout


class BadParamsTest(unittest.TestCase):
    def assert_refused(self, reasons, **params):
        status, output = start(**params)
        self.assertEqual(status, 1, output)
        for reason in reasons:
            self.assertIn(reason, output)

    def test_a_scene_is_needed(self):
        self.assert_refused(["/refused/scene", "must name a scene file"], threads=1)

    def test_a_scene_that_is_not_there_is_named(self):
        self.assert_refused(["/nowhere.yaml"], scene="/nowhere.yaml")

    def test_numbers_are_checked_with_their_range(self):
        for name, value, allowed in (("marker_rate_hz", 100, "[0.1, 20]"), ("threads", -1, "[0, 1024]"),
                                     ("slice_fraction", 1.5, "[0, 1]"),
                                     ("real_time_factor", -1.0, "[0, 1000]"),
                                     ("watchdog_s", 0.0, "[0.001, inf]")):
            self.assert_refused(["/refused/" + name, "must be in " + allowed],
                                **{"scene": SCENE, name: value})

    def test_words_are_checked(self):
        self.assert_refused(["marker_colour", "displacement, stress"], scene=SCENE,
                            marker_colour="pretty")

    def test_types_are_checked(self):
        self.assert_refused(["/refused/threads", "wrong type"], scene=SCENE, threads="many")


if __name__ == "__main__":
    rospy.init_node("bad_params_test")
    rostest.rosrun("soft_tissue_sim", "bad_params_test", BadParamsTest)
