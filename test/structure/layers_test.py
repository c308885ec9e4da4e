"""The layers include each other in one direction only, and the core knows no ROS."""
import pathlib
import tempfile
import unittest

import layers

ROOT = pathlib.Path(__file__).resolve().parents[2]


class Repository(unittest.TestCase):
    def test_has_sources_in_every_layer_it_names(self):
        seen = {layer for _, layer in layers.source_files(ROOT)}
        self.assertLessEqual({"base", "geometry", "mesh", "field", "energy", "contact", "solver", "scene", "node",
                              "apps"}, seen)

    def test_layers_are_in_order_and_ros_stays_outside(self):
        self.assertEqual(layers.violations(ROOT), [])

    def test_cmake_builds_the_layers_in_this_order(self):
        for line in (ROOT / "CMakeLists.txt").read_text(encoding="utf-8").splitlines():
            if line.startswith("set(CORE_LAYERS "):
                built = line[len("set(CORE_LAYERS "):-1].split()
        self.assertEqual(built, [layer for layer in layers.LAYERS if layer in built])


class Checker(unittest.TestCase):
    """The checker itself sees what it is there for."""

    def violations_of(self, name, text):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "src").mkdir()
            for other in ("src/scene/scene_impl.h", name):
                (root / other).parent.mkdir(parents=True, exist_ok=True)
            (root / "src/scene/scene_impl.h").write_text("#pragma once\n", encoding="utf-8")
            (root / name).write_text(text, encoding="utf-8")
            return layers.violations(root)

    def test_earlier_layers_and_other_libraries_are_fine(self):
        self.assertEqual(self.violations_of(
            "src/mesh/a.cpp", '#include "soft_tissue_sim/base/types.h"\n#include <Eigen/Core>\n#include <vector>\n'), [])
        self.assertEqual(self.violations_of("src/node/a.cpp", '#include <ros/ros.h>\n#include "soft_tissue_sim/Step.h"\n'), [])

    def test_a_later_layer_is_seen(self):
        self.assertEqual(self.violations_of("src/mesh/a.cpp", '#include "soft_tissue_sim/solver/newton.h"\n'),
                         ["src/mesh/a.cpp: layer mesh includes soft_tissue_sim/solver/newton.h of the later layer solver"])
        self.assertEqual(self.violations_of("src/mesh/a.cpp", '#include "../scene/scene_impl.h"\n'),
                         ["src/mesh/a.cpp: layer mesh includes ../scene/scene_impl.h of the later layer scene"])

    def test_ros_in_the_core_is_seen(self):
        for header in ("ros/ros.h", "geometry_msgs/Pose.h", "tf2_ros/buffer.h", "soft_tissue_sim/TissueMesh.h"):
            self.assertEqual(self.violations_of("include/soft_tissue_sim/scene/a.h", f"#  include <{header}>\n"),
                             [f"include/soft_tissue_sim/scene/a.h: layer scene includes {header}, which is ROS"])

    def test_an_unknown_layer_is_seen(self):
        self.assertEqual(self.violations_of("src/utils/a.cpp", ""), ["src/utils/a.cpp: 'utils' is no layer"])


if __name__ == "__main__":
    unittest.main()
