#!/usr/bin/env python3
"""run_scene where it can't write: it says which file, ends at once, and leaves what is there readable."""
import os
import resource
import signal
import subprocess
import tempfile
import time
import unittest

import rosbag

RUN_SCENE = os.environ["RUN_SCENE"]
SCENE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../ros/block.yaml")
PATIENCE_S = 120.0
LONG = ("--duration", "100000")


class RecordingTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def run_scene(self, *arguments, most_bytes=None):
        """@param most_bytes  that a file may have, as if the disk were full then"""
        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (most_bytes, most_bytes))

        return subprocess.run([RUN_SCENE, SCENE, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              universal_newlines=True, timeout=PATIENCE_S, restore_signals=False,
                              preexec_fn=limit if most_bytes is not None else None)

    def assert_told(self, run, what, path):
        self.assertEqual(run.returncode, 1, run.stderr)
        self.assertIn("run_scene: %s%s" % (what, path), run.stderr)
        self.assertIn("can't be written", run.stderr)
        self.assertNotIn("terminate", run.stderr)

    def test_a_disk_that_gets_full_ends_the_run(self):
        for option, what, most_bytes in (("--bag-out", "bag", 400000), ("--csv", "csv", 50000)):
            path = self.path(what)
            run = self.run_scene(*LONG, option, path, most_bytes=most_bytes)
            self.assert_told(run, what + " ", path)
            self.assertGreater(os.path.getsize(path), 0.8 * most_bytes)

    def test_what_a_full_disk_left_of_a_bag_can_be_read(self):
        path = self.path("run.bag")
        self.run_scene(*LONG, "--bag-out", path, most_bytes=400000)
        subprocess.run(["rosbag", "reindex", path], check=True, stdout=subprocess.DEVNULL)
        with rosbag.Bag(path) as bag:
            steps = [message.step for _, message, _ in bag.read_messages("/sim_node/stats")]
        self.assertEqual(steps, list(range(1, len(steps) + 1)))
        self.assertGreater(len(steps), 20)

    def test_two_files_on_a_full_disk_are_one_error(self):
        run = self.run_scene(*LONG, "--bag-out", self.path("bag"), "--csv", self.path("csv"), most_bytes=100000)
        self.assertEqual(run.returncode, 1, run.stderr)
        self.assertEqual(run.stderr.count("can't be written"), 1, run.stderr)

    def test_what_is_written_at_the_end_is_checked_as_well(self):
        run = self.run_scene("--duration", "0.05", "--json", self.path("json"), most_bytes=200)
        self.assert_told(run, "json ", self.path("json"))
        run = self.run_scene("--duration", "0.05", "--csv", self.path("csv"), most_bytes=200)
        self.assert_told(run, "csv ", self.path("csv"))
        run = self.run_scene("--duration", "0.05", "--bag-out", self.path("bag"), most_bytes=2000)
        self.assert_told(run, "bag ", self.path("bag"))
        run = self.run_scene("--duration", "0.05", "--save-state", self.path("state"), most_bytes=2000)
        self.assert_told(run, "", self.path("state"))
        self.assertEqual([name for name in os.listdir(self.folder) if name.startswith("state")], [])

    def test_places_where_nothing_can_be_written_cost_no_time(self):
        os.mkdir(self.path("folder"))
        for place in ("gone/file", "folder"):
            for option in ("--bag-out", "--csv", "--json", "--save-state"):
                begun = time.monotonic()
                run = self.run_scene(*LONG, option, self.path(place))
                self.assertEqual(run.returncode, 1, run.stderr)
                self.assertIn(self.path(place), run.stderr)
                self.assertLess(time.monotonic() - begun, PATIENCE_S / 2)
        self.assertEqual(os.listdir(self.folder), ["folder"])


if __name__ == "__main__":
    unittest.main()
