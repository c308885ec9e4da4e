"""environment.sh: which build folders are made anew, and what the tests are told."""
import os
import pathlib
import subprocess
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "environment.sh"
CACHE = {"CMAKE_HOME_DIRECTORY:INTERNAL": "{root}", "CMAKE_GENERATOR:INTERNAL": "Ninja",
         "PYTHON_EXECUTABLE:FILEPATH": "/usr/bin/python3", "CATKIN_DEVEL_PREFIX:UNINITIALIZED": "{root}/devel"}


class Environment(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name).resolve() / "package"
        (self.root / "build").mkdir(parents=True)

    def shell(self, command, **environment):
        done = subprocess.run(["/usr/bin/bash", "-euc", f"source {SCRIPT}; {command}"], cwd=self.root, check=True,
                              capture_output=True, text=True, env={"PATH": "/opt/other/bin", **environment})
        return done.stdout.strip()

    def reason(self, configured=True, **changes):
        cache = {**CACHE, **{key.replace("__", ":"): value for key, value in changes.items()}}
        (self.root / "build/CMakeCache.txt").write_text(
            "".join(f"{key}={value.format(root=self.root)}\n" for key, value in cache.items()), encoding="utf-8")
        if configured:
            (self.root / "build/build.ninja").touch()
        return self.shell("why_stale")

    def test_no_build_folder_is_not_stale(self):
        self.assertEqual(self.shell("why_stale"), "")

    def test_its_own_build_folder_is_kept(self):
        self.assertEqual(self.reason(), "")

    def test_another_python_is_seen(self):
        self.assertEqual(self.reason(PYTHON_EXECUTABLE__FILEPATH="/opt/python/bin/python3"),
                         "it was configured with the python /opt/python/bin/python3")

    def test_another_devel_space_is_seen(self):
        self.assertEqual(self.reason(CATKIN_DEVEL_PREFIX__UNINITIALIZED="{root}/build/devel"),
                         "its devel space is not devel/")

    def test_a_moved_clone_is_seen(self):
        self.assertEqual(self.reason(CMAKE_HOME_DIRECTORY__INTERNAL="/elsewhere"), "it belongs to /elsewhere")

    def test_another_generator_is_seen(self):
        self.assertEqual(self.reason(CMAKE_GENERATOR__INTERNAL="Unix Makefiles"), "it is not built with Ninja")

    def test_an_unfinished_configuration_is_seen(self):
        self.assertEqual(self.reason(configured=False), "its configuration did not finish")

    def test_debian_python_comes_first_and_hosts_need_no_name(self):
        self.assertEqual(self.shell("echo ${PATH%%:*} $ROS_HOSTNAME $ROS_HOME", PYTHONPATH="/x"),
                         f"/usr/bin localhost {self.root}/.ros")
        self.assertEqual(self.shell("echo ${PYTHONPATH-unset}", PYTHONPATH="/x"), "unset")

    def test_finds_the_data_beside_the_repository(self):
        self.assertEqual(self.shell("echo ${SOFT_TISSUE_DATA-unset}"), "unset")
        data = self.root.parent / "shared/data"
        data.mkdir(parents=True)
        self.assertEqual(self.shell("echo $SOFT_TISSUE_DATA"), str(data))
        self.assertEqual(self.shell("echo $SOFT_TISSUE_DATA", SOFT_TISSUE_DATA=os.sep), os.sep)


if __name__ == "__main__":
    unittest.main()
