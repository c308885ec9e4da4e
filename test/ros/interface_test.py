#!/usr/bin/env python3
"""docs/interface.md and what the node really offers: neither has a topic or a service that the other lacks."""
import os
import re
import sys
import unittest

import rosgraph
import rospy
import rosservice
import rostest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from sim_client import NODE, PATIENCE_S

PAGE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../docs/interface.md")
TISSUES = ("block", "cube")
TOOLS = ("probe", "follower", "flyer", "dragged", "grasper")
# What every node of roscpp has, and what interactive markers have of their own.
NOT_OURS = ("/rosout", "get_loggers", "set_logger_level", "tools/update_full")


def rows(heading):
    """First two cells of each row of the table below a heading."""
    with open(PAGE) as stream:
        section = stream.read().split("\n## %s\n" % heading)[1].split("\n## ")[0].split("\n### ")[0]
    return [[cell.strip() for cell in line.split("|")[1:3]] for line in section.splitlines() if line.startswith("| `")]


def names_in(heading):
    """The names that a table has, with the types that its second column says."""
    named = {}
    for cell, second in rows(heading):
        for name in re.findall(r"`([^`]+)`", cell):
            named[name] = second.split(":")[0].strip()
    return named


def general(name):
    """As the page writes it: below the node, with <tissue> and <tool>."""
    name = name[len(NODE) + 1:] if name.startswith(NODE + "/") else name
    first, slash, rest = name.partition("/")
    kind = "<tissue>" if first in TISSUES else "<tool>" if first in TOOLS else first
    return kind + slash + rest


class InterfaceTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.wait_for_service(NODE + "/grasper/detach", PATIENCE_S)  # the last to be offered
        master = rosgraph.Master(rospy.get_name())
        publications, subscriptions, services = master.getSystemState()
        cls.types = {general(name): kind for name, kind in master.getTopicTypes()}
        cls.published = cls.ours(publications)
        cls.subscribed = cls.ours(subscriptions)
        cls.services = {general(name): rosservice.get_service_type(name) for name, nodes in services
                        if NODE in nodes and general(name) not in NOT_OURS}

    @staticmethod
    def ours(topics):
        return {general(name) for name, nodes in topics if NODE in nodes} - set(NOT_OURS)

    def test_what_is_published(self):
        named = names_in("What the node publishes")
        markers = {"tools/update"}  # told of with the input
        self.assertEqual(self.published - markers, set(named))
        for name, kind in named.items():
            self.assertIn(self.types[name], (kind, "tf2_msgs/TFMessage") if name == "/tf" else (kind,), name)

    def test_what_is_taken(self):
        named = names_in("What the node takes")
        named.pop("<topic>")
        self.assertEqual(self.subscribed - {"/tf", "/tf_static", "octomap_in"}, set(named))
        for name, kind in named.items():
            if "/" in kind:
                self.assertEqual(self.types[name], kind.split()[0], name)

    def test_services(self):
        named = names_in("Services")
        self.assertEqual(set(self.services), set(named))
        for name, kind in named.items():
            self.assertEqual(self.services[name], kind, name)


if __name__ == "__main__":
    rospy.init_node("interface_test")
    rostest.rosrun("soft_tissue_sim", "interface_test", InterfaceTest)
