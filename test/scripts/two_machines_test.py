#!/usr/bin/env python3
"""two_machines.launch: what it starts where, and that it runs on one machine that is both; its environment script."""
import os
import re
import subprocess
import tempfile
import time
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
PAGE = os.path.join(HERE, "../../docs/interface.md")
SCENES = ["left_scene:=" + os.path.join(HERE, "../ros/pulled_cube.yaml"),
          "right_scene:=" + os.path.join(HERE, "../ros/octomap.yaml")]
PATIENCE_S = 120.0


def roslaunch(*arguments):
    return subprocess.run(["roslaunch", *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def free_port():
    import socket
    with socket.socket() as one:
        one.bind(("localhost", 0))
        return one.getsockname()[1]


class TwoMachinesTest(unittest.TestCase):
    def test_it_has_a_node_on_each_side(self):
        said = roslaunch("--nodes", "soft_tissue_sim", "two_machines.launch", *SCENES)
        self.assertEqual((said.returncode, said.stdout.split()), (0, ["/left/sim_node", "/right/sim_node"]), said.stdout)

    def test_its_machines_are_those_it_is_told(self):
        from roslaunch.config import load_config_default
        from roslaunch.rlutil import resolve_launch_arguments
        path = resolve_launch_arguments(["soft_tissue_sim", "two_machines.launch"])[0]
        config = load_config_default([(path, SCENES + ["left_address:=192.0.2.1", "right_address:=192.0.2.2",
                                                       "right_env_loader:=/home/me/env.sh", "user:=me"])], None,
                                     assign_machines=False)
        found = {name: (machine.address, machine.user) for name, machine in config.machines.items()}
        self.assertEqual((found["left"], found["right"]), (("192.0.2.1", "me"), ("192.0.2.2", "me")))
        self.assertEqual(config.machines["right"].env_loader, "/home/me/env.sh")
        nodes = {node.namespace + node.name: node for node in config.nodes}
        self.assertEqual({name: node.machine_name for name, node in nodes.items()},
                         {"/left/sim_node": "left", "/right/sim_node": "right"})
        self.assertIn(["/right/sim_node/octomap_in", "/left/sim_node/octomap_binary"],
                      [list(pair) for pair in nodes["/right/sim_node"].remap_args])

    def test_both_run_on_this_machine(self):
        port = str(free_port())
        environment = dict(os.environ, ROS_MASTER_URI="http://localhost:" + port, ROS_HOSTNAME="localhost")
        launch = subprocess.Popen(["roslaunch", "-p", port, "soft_tissue_sim", "two_machines.launch", "threads:=1", *SCENES],
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        try:
            self.wait_for_map(environment, launch)
        finally:
            launch.terminate()
            launch.communicate(timeout=PATIENCE_S)

    def wait_for_map(self, environment, launch):
        """The right one has taken a map of the left one: it says so in its diagnostics."""
        deadline_s = time.monotonic() + PATIENCE_S
        while time.monotonic() < deadline_s:
            self.assertIsNone(launch.poll(), "roslaunch ended")
            said = subprocess.run(["timeout", "20", "rostopic", "echo", "-n", "4", "/diagnostics"], env=environment,
                                  stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout
            if re.search(r"name: \"right/sim_node: plate maps\"\s+message: \"maps come in\"", said):
                return
        self.fail("no map came: " + said)

    def test_the_environment_script_of_the_page_does_what_it_says(self):
        with open(PAGE) as stream:
            script = re.search(r"```bash\n(#!/bin/bash\n.*?)```", stream.read(), re.DOTALL).group(1)
        with tempfile.TemporaryDirectory() as folder:
            setup, loader = os.path.join(folder, "setup.bash"), os.path.join(folder, "env.sh")
            with open(setup, "w") as stream:
                stream.write("export SOURCED=yes\n")
            with open(loader, "w") as stream:
                stream.write(re.sub(r"source \S+", "source " + setup, script))
            os.chmod(loader, 0o755)
            environment = dict(os.environ, SSH_CONNECTION="192.0.2.1 40000 192.0.2.2 22", ROS_HOSTNAME="wrong")
            said = subprocess.run([loader, "env"], env=environment, stdout=subprocess.PIPE, text=True, check=True).stdout
        self.assertIn("SOURCED=yes\n", said)
        self.assertIn("ROS_IP=192.0.2.2\n", said)
        self.assertNotIn("ROS_HOSTNAME", said)


if __name__ == "__main__":
    unittest.main(warnings="ignore")  # roslaunch leaves sockets open
