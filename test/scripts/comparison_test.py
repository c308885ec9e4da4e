#!/usr/bin/env python3
"""The plot of measured and simulated forces, from made-up ones."""
import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np

SCRIPTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scripts")
sys.path.insert(0, SCRIPTS)
import plot_comparison

HEADER = "tool,time_s," + ",".join(
    "%s_%s" % (side, column) for side in ("measured", "simulated")
    for column in ("force_x_n", "force_y_n", "force_z_n", "torque_x_nm", "torque_y_nm", "torque_z_nm"))


class PlotComparison(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def write(self, lines):
        path = os.path.join(self.folder.name, "compare.csv")
        with open(path, "w") as stream:
            stream.write("\n".join([HEADER] + lines) + "\n")
        return path

    def run_on(self, path):
        picture = os.path.join(self.folder.name, "compare.png")
        done = subprocess.run([sys.executable, os.path.join(SCRIPTS, "plot_comparison.py"), path, picture],
                              stderr=subprocess.PIPE, universal_newlines=True)
        return done, picture

    def test_reads_forces_of_each_tool(self):
        tools = plot_comparison.read(self.write(["a,0.1,1,2,3,0,0,0,1,2,4,0,0,0", "b,0.1,0,0,0,0,0,0,5,6,7,0,0,0",
                                                 "a,0.2,1,2,3,0,0,0,1,2,5,0,0,0"]))
        self.assertEqual(list(tools), ["a", "b"])
        time, measured, simulated = tools["a"]
        np.testing.assert_array_equal(time, [0.1, 0.2])
        np.testing.assert_array_equal(measured, [[1, 2, 3], [1, 2, 3]])
        np.testing.assert_array_equal(simulated, [[1, 2, 4], [1, 2, 5]])
        self.assertAlmostEqual(plot_comparison.root_mean_square(simulated - measured), np.sqrt(2.5))

    def test_draws_them(self):
        done, picture = self.run_on(self.write(["a,0.1,1,2,3,0,0,0,1,2,4,0,0,0", "a,0.2,1,2,3,0,0,0,1,2,5,0,0,0"]))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater(os.path.getsize(picture), 10000)

    def test_complains_of_what_it_cannot_draw(self):
        for path in (self.write([]), os.path.join(self.folder.name, "none.csv")):
            done, _ = self.run_on(path)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn("plot_comparison: ", done.stderr)


if __name__ == "__main__":
    unittest.main()
