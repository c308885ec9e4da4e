#!/usr/bin/env python3
"""What takes long tells how far it has come, and steps that were asked for can be called off."""
import os
import sys
import threading
import unittest

import rospy
import rostest
from soft_tissue_sim.msg import Progress
from soft_tissue_sim.srv import LoadState, SaveState
from std_srvs.srv import Trigger

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from sim_client import NODE, PATIENCE_S, SimClient, wait_until

ENDLESS = 4000000000  # steps, of 5 ms each


class ProgressTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = SimClient()
        cls.heard = []
        cls.subscriber = rospy.Subscriber(NODE + "/progress", Progress, cls.heard.append, queue_size=1000)
        wait_until(lambda: cls.heard, "late subscribers hear of the newest")
        rospy.wait_for_service(NODE + "/cancel", PATIENCE_S)
        cls.cancel = rospy.ServiceProxy(NODE + "/cancel", Trigger)

    def setUp(self):
        self.heard.clear()

    def wait_for_end(self, state):
        wait_until(lambda: self.heard and self.heard[-1].state == state, "it ends as it should")
        return self.heard[-1]

    def ask(self, steps):
        """Asks for steps without waiting for them. @return (thread, list that their answer will be in)"""
        answers = []
        thread = threading.Thread(target=lambda: answers.append(self.client.step(steps)))
        thread.start()
        return thread, answers

    def test_1_loading_ends_when_all_is_there(self):
        newest = rospy.wait_for_message(NODE + "/progress", Progress, PATIENCE_S)
        self.assertEqual((newest.task, newest.state), ("load", Progress.DONE))
        self.assertEqual(newest.done, newest.total)
        self.assertGreater(newest.elapsed, 0.0)

    def test_2_steps_are_counted_and_called_off(self):
        before = self.client.newest["stats"].step
        thread, answers = self.ask(ENDLESS)
        wait_until(lambda: len(self.heard) > 10, "it tells how far it is, again and again")
        while not self.cancel().success:  # it may be the first step that is on its way
            pass
        thread.join(PATIENCE_S)
        self.assertFalse(answers[0].success)
        end = self.wait_for_end(Progress.CANCELLED)
        self.assertEqual({(message.task, message.total) for message in self.heard}, {("step", ENDLESS)})
        self.assertEqual([message.state for message in self.heard[:-1]], [Progress.RUNNING] * (len(self.heard) - 1))
        done = [message.done for message in self.heard]
        self.assertEqual(done, sorted(done))
        self.assertEqual(done[0], 0)
        elapsed = [message.elapsed for message in self.heard]
        self.assertEqual(elapsed, sorted(elapsed))
        self.assertEqual(answers[0].message, "cancelled after %d of %d steps" % (end.done, ENDLESS))
        wait_until(lambda: self.client.newest["stats"].step == before + end.done, "as many were done")
        self.assertAlmostEqual(self.client.sim_time(), answers[0].time, delta=1e-9)
        gaps = [b.elapsed - a.elapsed for a, b in zip(self.heard[1:-1], self.heard[2:-1])]
        self.assertGreaterEqual(min(gaps), 0.0999, "ten times a second at most")

    def test_3_what_is_not_under_way_can_not_be_called_off(self):
        answer = self.cancel()
        self.assertFalse(answer.success)
        self.assertIn("no steps are under way", answer.message)
        self.assertTrue(self.client.step(3).success, "and calls nothing off that comes later")
        end = self.wait_for_end(Progress.DONE)
        self.assertEqual((end.task, end.done, end.total), ("step", 3, 3))

    def test_4_states_are_tasks_too(self):
        rospy.ServiceProxy(NODE + "/save_state", SaveState)(path="/tmp/progress_test_%d" % os.getpid())
        self.assertEqual(self.wait_for_end(Progress.DONE).task, "save_state")
        self.heard.clear()
        os.remove("/tmp/progress_test_%d" % os.getpid())
        answer = rospy.ServiceProxy(NODE + "/load_state", LoadState)(path="/tmp/progress_test_%d" % os.getpid())
        end = self.wait_for_end(Progress.FAILED)
        self.assertEqual((end.task, end.message), ("load_state", answer.message))
        self.assertTrue(end.message)

    def test_5_steps_of_a_running_simulation_are_refused(self):
        self.client.unpause()
        self.assertFalse(self.client.step(5).success)
        self.assertIn("pause_physics", self.wait_for_end(Progress.FAILED).message)
        self.client.pause()


if __name__ == "__main__":
    rospy.init_node("progress_test")
    rostest.rosrun("soft_tissue_sim", "progress_test", ProgressTest)
