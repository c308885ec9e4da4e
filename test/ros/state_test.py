#!/usr/bin/env python3
"""States saved and loaded, materials set and time begun again, in a paused node that makes /clock."""
import os
import shutil
import sys
import tempfile
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Clock
from soft_tissue_sim.srv import LoadState, SaveState, SetMaterial, SetMaterialRequest
from std_srvs.srv import Empty

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from sim_client import NODE, PATIENCE_S, SimClient, wait_until

PRESSED = (0.0, 0.0, 0.035)
NAN = float("nan")


def service(name, kind):
    rospy.wait_for_service(NODE + "/" + name, PATIENCE_S)
    return rospy.ServiceProxy(NODE + "/" + name, kind)


class StateTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = SimClient()
        cls.client.wait_for_commands_to_arrive()
        cls.save = service("save_state", SaveState)
        cls.load = service("load_state", LoadState)
        cls.set = service("set_material", SetMaterial)
        cls.folder = tempfile.mkdtemp()

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def stepped(self, steps):
        """Hash after so many steps."""
        moment = self.client.step(steps).time
        wait_until(lambda: abs(self.client.sim_time() - moment) < 1e-9, "stats of the last step")
        return self.client.newest["stats"].state_hash

    def press(self):
        def pressed():
            self.client.command(PRESSED)
            self.client.step(1)
            return abs(self.client.position()[2] - PRESSED[2]) < 1e-9

        wait_until(pressed, "the probe obeys")

    def set_material(self, tissue="block", **values):
        request = SetMaterialRequest(tissue=tissue, young_modulus=NAN, poisson_ratio=NAN, density=NAN, stiffening=NAN)
        for name, value in values.items():
            setattr(request, name, value)
        return self.set(request)

    def force(self):
        return self.client.newest["probe/spatial/measured_cf"].wrench.force.z

    def test_1_steps_after_loading_are_those_after_saving(self):
        self.press()
        self.stepped(5)
        path = os.path.join(self.folder, "state")
        saved = self.save(path)
        self.assertTrue(saved.success, saved.message)
        self.assertEqual(saved.state_hash, self.client.newest["stats"].state_hash)
        expected = self.stepped(15)
        self.client.reset()
        self.stepped(3)
        loaded = self.load(path)
        self.assertTrue(loaded.success, loaded.message)
        self.assertEqual((loaded.step, loaded.time, loaded.state_hash), (saved.step, saved.time, saved.state_hash))
        wait_until(lambda: self.client.sim_time() == loaded.time, "the loaded state is published")
        self.assertEqual(self.stepped(15), expected)

    def test_2_what_can_not_be_loaded_changes_nothing(self):
        path, bad = os.path.join(self.folder, "state"), os.path.join(self.folder, "bad")
        self.assertTrue(self.save(path).success)
        content = open(path, "rb").read()
        after = self.stepped(4)
        self.assertTrue(self.load(path).success)
        for damaged in (content[:-100], content[:500] + bytes([content[500] ^ 1]) + content[501:], b"no state"):
            with open(bad, "wb") as stream:
                stream.write(damaged)
            answer = self.load(bad)
            self.assertFalse(answer.success)
            self.assertIn("state " + bad, answer.message)
        self.assertIn("can't be read", self.load(os.path.join(self.folder, "gone")).message)
        self.assertIn("must be absolute", self.load("state").message)
        self.assertIn("must be absolute", self.save("state").message)
        self.assertIn("can't be written", self.save(os.path.join(self.folder, "no", "state")).message)
        self.assertEqual(self.stepped(4), after)

    def test_3_a_stiffer_material_presses_harder(self):
        self.press()
        self.stepped(200)
        soft = self.force()
        answer = self.set_material(young_modulus=60000.0)
        self.assertTrue(answer.success, answer.message)
        self.stepped(200)
        wait_until(lambda: self.force() > 2.0 * soft, "three times the modulus, nearly the force")
        self.assertLess(self.force(), 3.5 * soft)
        for values, words in ((dict(tissue="liver"), "must be one of: block"),
                              (dict(young_modulus=-1.0), "young_modulus_pa = -1, must be in (0, 1e+12]"),
                              (dict(poisson_ratio=0.5), "poisson_ratio = 0.5, must be in (-1, 0.5)"),
                              (dict(density=float("inf")), "density_kg_per_m3 = inf, must be in (0, 1e+05]"),
                              (dict(stiffening=2.0), "is for model exponential"),
                              (dict(has_region=True, region=7), "region = 7, must be none")):
            answer = self.set_material(**values)
            self.assertFalse(answer.success)
            self.assertIn(words, answer.message)

    def test_4_time_can_begin_again(self):
        clocks = []
        subscriber = rospy.Subscriber("/clock", Clock, lambda message: clocks.append(message.clock.to_sec()))
        self.stepped(3)
        service("reset_simulation", Empty)()
        wait_until(lambda: clocks and clocks[-1] == 0.0, "/clock is zero")
        self.assertAlmostEqual(self.client.step(2).time, 0.01, places=12)
        wait_until(lambda: self.client.newest["stats"].step == 2, "steps are counted anew")
        subscriber.unregister()


if __name__ == "__main__":
    rospy.init_node("state_test")
    rostest.rosrun("soft_tissue_sim", "state_test", StateTest)
