#!/usr/bin/env python3
"""What the node tells of tissues that touch each other: a cube comes to rest on a bed."""
import os
import sys
import unittest

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import Point
from soft_tissue_sim.msg import SimStats, TissueContacts, TissueField, TissueMesh
from soft_tissue_sim.srv import QueryDistance
from visualization_msgs.msg import Marker, MarkerArray

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from sim_client import NODE, PATIENCE_S, SimClient, wait_until

GRAVITY_M_PER_S2 = 9.81
DENSITY_KG_PER_M3 = 1000.0
STEPS_TO_REST = 200
CUBE_AXIS = (-0.001, 0.001)  # m
RIM = 0.0005  # m: many times the depth and the bulge


def array(vectors):
    return np.array([(v.x, v.y, v.z) for v in vectors]).reshape(-1, 3)


def weight():
    """Weight of the cube, from its mesh."""
    mesh = rospy.wait_for_message(NODE + "/cube/mesh", TissueMesh, PATIENCE_S)
    corners = np.array(mesh.rest_positions).reshape(-1, 3)[np.array(mesh.tets).reshape(-1, 4)]
    volume = np.sum(np.linalg.det(corners[:, 1:] - corners[:, :1])) / 6.0
    return volume * DENSITY_KG_PER_M3 * GRAVITY_M_PER_S2


class TissueContactsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = SimClient({"stats": SimStats, "contacts": TissueContacts})

    def after(self, steps):
        """The contacts and the stats of the last of some steps."""
        moment = self.client.step(steps).time
        wait_until(lambda: self.client.complete_step_after(moment - 1e-6), "all messages of the step")
        found = self.client.complete_step_after(moment - 1e-6)
        return found["contacts"], found["stats"]

    def at_rest(self):
        self.client.reset()
        return self.after(STEPS_TO_REST)

    def test_the_bed_carries_the_cube(self):
        contacts, stats = self.at_rest()
        cube_weight = weight()
        force = array(contacts.forces).sum(axis=0)
        self.assertAlmostEqual(cube_weight, 0.02**3 * DENSITY_KG_PER_M3 * GRAVITY_M_PER_S2, places=6)
        self.assertLess(np.linalg.norm(force - (0.0, 0.0, cube_weight)), 1e-3 * cube_weight)
        # At the cube's rim the side is nearest to what is in it.
        off_axis = np.abs(array(contacts.points)[:, :2] - CUBE_AXIS).max(axis=1)
        under_it = off_axis < 0.01 - RIM
        self.assertGreater(np.count_nonzero(under_it), len(contacts.points) / 2)
        self.assertGreater(array(contacts.normals)[under_it, 2].min(), 0.99)
        in_tissue = np.array(contacts.tets) >= 0
        self.assertEqual(stats.contacts, np.count_nonzero(in_tissue))
        self.assertTrue(in_tissue.any())
        self.assertAlmostEqual(max(contacts.depths), stats.max_penetration, places=15)

    def test_points_tell_whose_they_are(self):
        contacts, _ = self.at_rest()
        names = list(contacts.tissue_names)
        self.assertEqual({names[i] for i in contacts.firsts}, {"cube"})
        self.assertEqual({names[i] for i in contacts.seconds}, {"bed"})
        self.assertEqual({names[i] for i in contacts.hosts}, {"cube", "bed"})
        friction = np.array(contacts.tets) == -1
        self.assertTrue(friction.any())
        self.assertEqual(np.array(contacts.depths)[friction].max(), 0.0)
        across = np.einsum("ij,ij->i", array(contacts.forces), array(contacts.normals))[friction]
        self.assertLess(np.abs(across).max(), 1e-12)
        self.assertEqual(contacts.header.frame_id, "world")
        forces, normals = array(contacts.forces), array(contacts.normals)
        areas = np.array(contacts.areas)
        pressed = areas > 0.0
        self.assertTrue(pressed.any())
        pressures = np.einsum("ij,ij->i", forces, normals)[pressed] / areas[pressed]
        np.testing.assert_allclose(np.array(contacts.pressures)[pressed], pressures, rtol=1e-12)

    def test_there_are_none_before_it_lands(self):
        self.client.reset()
        contacts, stats = self.after(1)
        self.assertEqual((len(contacts.points), stats.contacts), (0, 0))
        self.assertEqual(list(contacts.tissue_names), ["bed", "cube"])

    def test_depths_and_distances_know_both(self):
        self.at_rest()
        for name in ("bed", "cube"):
            field = rospy.wait_for_message(NODE + "/" + name + "/field", TissueField, PATIENCE_S)
            self.assertGreater(max(field.depths), 0.005)
        query = rospy.ServiceProxy(NODE + "/query_distance", QueryDistance)
        found = query(points=[Point(0.0, 0.0, 0.015), Point(0.0, 0.0, 0.04)], max_distance=0.01)
        self.assertEqual(list(found.tissues), ["bed", "cube"])

    def test_markers_show_them_and_go_on_reset(self):
        arrays = []
        subscriber = rospy.Subscriber(NODE + "/markers", MarkerArray, arrays.append)

        def arrows():
            markers = [m for m in arrays[-1].markers if m.ns == "tissue_pairs"] if arrays else []
            return [marker for marker in markers if marker.action == Marker.ADD]

        self.at_rest()
        wait_until(arrows, "arrows")
        upwards = [marker.points[1].z - marker.points[0].z for marker in arrows()]
        self.assertAlmostEqual(max(upwards), 0.015, places=3)  # the longest, on the cube
        self.client.reset()
        self.after(1)
        wait_until(lambda: any(a.markers[0].action == Marker.DELETEALL for a in arrays), "DELETEALL")
        wait_until(lambda: not arrows(), "no arrows")
        subscriber.unregister()


if __name__ == "__main__":
    rospy.init_node("tissue_contacts_test")
    rostest.rosrun("soft_tissue_sim", "tissue_contacts_test", TissueContactsTest)
