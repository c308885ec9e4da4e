#!/usr/bin/env python3
"""two_machines.launch between two machines: roslaunch starts the right node by ssh on the other one, a map of the left one
reaches it, and both end with roslaunch."""
import os
import re
import shutil
import signal
import subprocess
import tempfile
import unittest

import linked_machines


def is_real_root():
    """sshd takes on who logs in, which only root of all users can."""
    with open("/proc/self/uid_map") as stream:
        return os.getuid() == 0 and stream.read().split()[1:] == ["0", "4294967295"]


if not (os.path.exists("/usr/sbin/sshd") and shutil.which("ssh-keygen") and is_real_root()):
    linked_machines.skip("takes root, openssh-server and openssh-client")
try:
    import paramiko
except ImportError:
    linked_machines.skip("there is no python3-paramiko, by which roslaunch logs in")
linked_machines.enter()  # before anything of ROS looks for its master

import sys

import rosgraph

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "../ros"))
from sim_client import wait_until

PAGE = os.path.join(HERE, "../../docs/interface.md")
LEFT, RIGHT = "/left/sim_node", "/right/sim_node"


class RemoteLaunchTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.machines = linked_machines.LinkedMachines()
        cls.addClassCleanup(cls.machines.end)
        home = tempfile.TemporaryDirectory()
        cls.addClassCleanup(home.cleanup)
        cls.home = home.name
        cls.let_in()
        cls.write_environment_script()
        cls.machines.on_far("rosmaster", "--core", "-p", "11311")
        wait_until(rosgraph.is_master_online, "the master is there")

    @classmethod
    def let_in(cls):
        """The other machine lets in who has the key that lies where roslaunch looks."""
        folder = os.path.join(cls.home, ".ssh")
        os.mkdir(folder, 0o700)
        keys = {name: os.path.join(folder, name) for name in ("id_ed25519", "host_key")}
        for key in keys.values():
            subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", key], check=True)
        with open(keys["host_key"] + ".pub") as stream:
            kind, key = stream.read().split()[:2]
        with open(os.path.join(folder, "known_hosts"), "w") as stream:
            stream.write("%s %s %s\n" % (linked_machines.FAR, kind, key))
        settings = os.path.join(cls.home, "sshd_config")
        with open(settings, "w") as stream:
            stream.write("ListenAddress %s\nHostKey %s\nAuthorizedKeysFile %s.pub\nStrictModes no\nUsePAM no\nPidFile none\n"
                         "PasswordAuthentication no\n" % (linked_machines.FAR, keys["host_key"], keys["id_ed25519"]))
        os.makedirs("/run/sshd", exist_ok=True)  # sshd wants it, and the system's own service makes it at its start
        cls.machines.on_far("/usr/sbin/sshd", "-D", "-e", "-f", settings)

    @classmethod
    def write_environment_script(cls):
        """That of the documentation, for this build."""
        with open(PAGE) as stream:
            script = re.search(r"```bash\n(#!/bin/bash\n.*?)```", stream.read(), re.DOTALL).group(1)
        setup = os.path.join(os.environ["CMAKE_PREFIX_PATH"].split(":")[0], "setup.bash")
        cls.loader = os.path.join(cls.home, "env.sh")
        with open(cls.loader, "w") as stream:
            stream.write(re.sub(r"source \S+", "source " + setup, script))
        os.chmod(cls.loader, 0o755)

    def addresses(self):
        """Of the nodes that the master knows."""
        master = rosgraph.Master("/remote_launch_test")
        nodes = {node for kind in master.getSystemState() for _, names in kind for node in names}
        return {node: re.match(r"http://(.*):", master.lookupNode(node)).group(1) for node in nodes & {LEFT, RIGHT}}

    def test_the_other_machine_runs_its_node_until_roslaunch_ends(self):
        log = os.path.join(self.home, "roslaunch.log")
        with open(log, "w") as stream:
            launch = subprocess.Popen(
                ["roslaunch", "soft_tissue_sim", "two_machines.launch", "threads:=1", "user:=root",
                 "left_scene:=" + os.path.join(HERE, "../ros/pulled_cube.yaml"),
                 "right_scene:=" + os.path.join(HERE, "../ros/octomap.yaml"),
                 "left_address:=" + linked_machines.NEAR, "right_address:=" + linked_machines.FAR,
                 "right_env_loader:=" + self.loader],
                env=dict(linked_machines.machine_environment(linked_machines.NEAR), HOME=self.home), stdout=stream,
                stderr=subprocess.STDOUT)
        try:
            def both_run():
                self.assertIsNone(launch.poll(), "roslaunch ended")
                return self.addresses() == {LEFT: linked_machines.NEAR, RIGHT: linked_machines.FAR}

            wait_until(both_run, "each machine runs its node")

            def map_came():
                said = self.machines.ask_far("timeout", "20", "rostopic", "echo", "-n", "4", "/diagnostics")
                return re.search(r"name: \"right/sim_node: plate maps\"\s+message: \"maps come in\"", said)

            wait_until(map_came, "the right one takes a map")
            launch.send_signal(signal.SIGINT)
            self.assertEqual(launch.wait(120), 0)
            wait_until(lambda: self.addresses() == {}, "both ended")
        except BaseException:
            with open(log) as stream:
                print(stream.read())
            raise
        finally:
            launch.kill()


if __name__ == "__main__":
    unittest.main(warnings="ignore")  # roslaunch leaves sockets open
