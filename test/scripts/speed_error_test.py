#!/usr/bin/env python3
"""speed_error in its quick form: what it writes, and that the exact field is exact in it."""
import csv
import os
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../scripts"))
import plot_speed_error

PROGRAM = os.environ["SPEED_ERROR"]


class SpeedError(unittest.TestCase):
    def test_fields(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([PROGRAM, "field", "--out", folder, "--quick"], check=True, stdout=subprocess.DEVNULL)
            with open(os.path.join(folder, "field.csv")) as stream:
                rows = list(csv.DictReader(stream))
            self.assertEqual(list(rows[0]), ["case", "dim", "elements", "nodes", "method", "order", "resolution", "ms",
                                             "max_err", "median_err", "wrong_fraction", "evaluations"])
            exact = [row for row in rows if row["method"].startswith("exact_marching")]
            self.assertGreaterEqual(len({(row["case"], row["elements"]) for row in exact}), 6)
            for row in exact:
                self.assertEqual(float(row["max_err"]), 0.0, row)
            wrong = {row["method"]: float(row["wrong_fraction"]) for row in rows if row["case"] == "ball"}
            self.assertGreater(wrong["cffm"], 0.0)
            self.assertGreater(wrong["cpfm"], wrong["cffm"])
            plot_speed_error.plot_error(plot_speed_error.read(os.path.join(folder, "field.csv")),
                                        os.path.join(folder, "error.png"))
            self.assertGreater(os.path.getsize(os.path.join(folder, "error.png")), 1000)

    def test_stability(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([PROGRAM, "stability", "--out", folder, "--quick"], check=True,
                           stdout=subprocess.DEVNULL)
            with open(os.path.join(folder, "stability.csv")) as stream:
                rows = list(csv.DictReader(stream))
            self.assertGreaterEqual(len(rows), 4)
            for row in rows:
                self.assertEqual((row["finite"], row["ended_so"]), ("1", "1"), row)

    def test_features(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([PROGRAM, "features", "--out", folder, "--quick"], check=True, stdout=subprocess.DEVNULL)
            path = os.path.join(folder, "features.csv")
            with open(path) as stream:
                rows = list(csv.DictReader(stream))
            self.assertEqual(list(rows[0]), ["feature", "state", "threads", "ms", "ratio", "wall_ms", "wall_ratio",
                                             "newton", "linear", "contacts", "held"])
            features = {}
            for row in rows:
                features.setdefault(row["feature"], {})[row["state"]] = row
                self.assertEqual(row["held"], "0", row)
            self.assertGreaterEqual(len(features), 25)
            for name, states in features.items():
                self.assertIn("off", states, name)
                self.assertEqual(states["off"]["ratio"], "1", name)
                self.assertGreaterEqual(len(states), 2, name)
                if "idle" in states:  # what is idle changes no iteration
                    for key in ("newton", "linear", "contacts"):
                        self.assertEqual(states["idle"][key], states["off"][key], name)
            for name in ("contact with a tool", "octomap obstacle"):
                self.assertGreater(float(features[name]["in use"]["contacts"]), 0.0, name)
            # A body that sleeps does nothing.
            self.assertEqual(features["sleep, at rest"]["in use"]["newton"], "0")
            plot_speed_error.plot_features(plot_speed_error.read_features(path), os.path.join(folder, "features.png"))
            self.assertGreater(os.path.getsize(os.path.join(folder, "features.png")), 1000)

    def test_contact(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([PROGRAM, "contact", "--out", folder, "--quick"], check=True, stdout=subprocess.DEVNULL)
            with open(os.path.join(folder, "contact.csv")) as stream:
                rows = list(csv.DictReader(stream))
            self.assertEqual({row["response"] for row in rows}, {"segment", "point"})
            for row in rows:
                error = float(row["force_n"]) / float(row["reference_n"]) - 1
                self.assertAlmostEqual(error, float(row["error"]), places=3)
                self.assertGreater(error, 0.1, "so coarse a mesh is too stiff: %s" % row)

            with open(os.path.join(folder, "detection.csv")) as stream:
                rows = list(csv.DictReader(stream))
            self.assertEqual(list(rows[0]), ["scene", "tets", "edges", "method", "found", "touching", "missed",
                                             "find_ms", "ms", "mean_ms", "worst_ms"])
            self.assertGreaterEqual(len({row["scene"] for row in rows}), 4)
            for row in rows:
                self.assertIn(row["missed"], ["0"] if row["method"][:3] != "FCL" else [""], row)
                self.assertEqual(int(row["touching"]) > 0, row["scene"].startswith("overlapping"), row)

            with open(os.path.join(folder, "contact_cost.csv")) as stream:
                rows = list(csv.DictReader(stream))
            self.assertEqual({(row["case"], row["contact"]) for row in rows},
                             {("overlapping", "segment"), ("overlapping", "point"),
                              ("apart", "segment"), ("apart", "point"), ("apart", "none")})
            for row in rows:
                self.assertEqual(int(row["samples"]) > 0, row["case"] == "overlapping", row)

    def test_fem(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([PROGRAM, "fem", "--out", folder, "--quick"], check=True, stdout=subprocess.DEVNULL)
            with open(os.path.join(folder, "fem_race.csv")) as stream:
                rows = {(row["method"], row["threads"]): row for row in csv.DictReader(stream)}
            self.assertLess(float(rows["converged", "2"]["worst_residual"]), 1e-8)
            self.assertEqual(float(rows["scene", "2"]["tip_off_scene_mm"]), 0.0)
            for method, tolerance in (("scene", 1e-3), ("scene 1e-2", 1e-2), ("scene 1e-1", 1e-1),
                                      ("plain newton", 1e-3)):
                row = rows[method, "1"]
                self.assertLess(float(row["worst_residual"]), 1.001 * tolerance, row)
            # Two programs that share nothing but the law go the same way.
            self.assertLess(float(rows["plain newton", "1"]["tip_off_converged_mm"]), 0.01)
            self.assertGreater(float(rows["plain", "1"]["worst_residual"]), 0.01)

            with open(os.path.join(folder, "fem_bullet.csv")) as stream:
                rows = list(csv.DictReader(stream))
            self.assertLessEqual({"scene", "scene 1e-2", "scene 1e-1", "converged"}, {row["engine"] for row in rows})
            for row in rows:  # falls freely yet, five steps of 10 ms: 15 g h^2
                fall = -1.5 * float(row["gravity"])
                self.assertAlmostEqual(float(row["tip_y_mm"]), fall, delta=-0.1 * fall, msg=row)
                self.assertLess(float(row["farthest_off_mm"]), 0.3 if row["engine"] == "scene 1e-1" else 0.1, row)

            if os.cpu_count() > 1:
                with open(os.path.join(folder, "fem_threads.csv")) as stream:
                    rows = list(csv.DictReader(stream))
                self.assertEqual([int(row["step"]) for row in rows], [0, 10])
                for row in rows:
                    self.assertAlmostEqual(float(row["ratio"]), float(row["one_ms"]) / float(row["two_ms"]),
                                           delta=0.01 * float(row["ratio"]), msg=row)

            with open(os.path.join(folder, "fem_roofline.csv")) as stream:
                rows = {row["loop"]: row for row in csv.DictReader(stream)}
            self.assertEqual(list(rows), ["product single", "product double", "forces", "stiffness"])
            single, double = (float(rows["product " + real]["mbytes"]) for real in ("single", "double"))
            self.assertTrue(1.8 < double / single < 2.0, "columns have one size, numbers half the size")

            with open(os.path.join(folder, "fem.csv")) as stream:
                rows = list(csv.DictReader(stream))
            self.assertEqual(list(rows[0]), ["case", "method", "element", "law", "linear", "tolerance", "tets", "nodes",
                                             "ms", "found", "error", "converged", "pareto",
                                             "pareto_of_mesh", "default"])
            self.assertEqual({row["converged"] for row in rows}, {"1"})
            for case in {row["case"] for row in rows}:
                of_case = [row for row in rows if row["case"] == case]
                self.assertIn("1", {row["default"] for row in of_case})
                self.assertEqual({row["pareto_of_mesh"] for row in of_case if row["pareto"] == "1"}, {"1"})
                fastest = min(of_case, key=lambda row: float(row["ms"]))
                self.assertEqual(fastest["pareto"], "1")
                if case == "heavy":
                    continue
                error = {element: min(float(row["error"]) for row in of_case if row["element"] == element)
                         for element in ("tet4", "tet10")}
                self.assertLess(error["tet10"], 0.5 * error["tet4"], case)
            # What the solvers differ by is where they stop.
            found = {}
            for row in rows:
                if row["method"] == "scene" and row["tolerance"] == "0.001":
                    found.setdefault((row["case"], row["element"], row["law"], row["nodes"]), []).append(
                        float(row["found"]))
            for key, ways in found.items():
                self.assertLess(max(ways) / min(ways), 1.003, key)
            # Less exact steps end farther off.
            for law in ("neo_hookean", "corotated"):
                errors = [float(row["error"]) for row in rows if row["case"] == "heavy" and row["method"] == "scene"
                          and row["law"] == law and row["linear"] == "pcg"]
                self.assertEqual(errors, sorted(errors, reverse=True))
            plot_speed_error.plot_all_fem(folder)
            for name in ("sag", "heavy", "fall", "cook_0.4999"):
                self.assertGreater(os.path.getsize(os.path.join(folder, "fem_%s.png" % name)), 1000)

    def test_bad_calls(self):
        for arguments in ([], ["field"], ["magic", "--out", "x"], ["field", "--out"]):
            result = subprocess.run([PROGRAM] + arguments, stderr=subprocess.PIPE, check=False)
            self.assertEqual(result.returncode, 2)
            self.assertIn(b"usage", result.stderr)
        result = subprocess.run([PROGRAM, "field", "--out", "/nowhere/at/all"], stderr=subprocess.PIPE, check=False)
        self.assertEqual(result.returncode, 1)
        self.assertIn(b"/nowhere/at/all/field.csv", result.stderr)


if __name__ == "__main__":
    unittest.main()
