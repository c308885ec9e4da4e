"""Two machines with a cable between them, as far as a network stack can tell: network namespaces of Linux.

This process and all it starts are one of them; what it starts `far` is the other. Neither has a way to the outside or to
the other but the cable. Namespaces have no names and live as long as a process in them, and all processes die with this
one, however it ends: nothing is left behind.
"""
import os
import shutil
import subprocess
import sys

NEAR, FAR = "192.0.2.2", "192.0.2.1"
CABLE = "to_far", "to_near"  # its ends
CTEST_SKIPPED = 77
MARK = "IN_OWN_NETWORK_NAMESPACE"


def enter():
    """Starts this program again in a network namespace of its own; ends it as skipped where that can't be."""
    if MARK in os.environ:
        return
    missing = [program for program in ("ip", "nsenter", "setpriv", "unshare") if not shutil.which(program)]
    if missing:
        skip("there is no " + ", no ".join(missing))
    own = next((way for way in (["unshare", "--net"], ["unshare", "--map-root-user", "--net"])
                if subprocess.run(way + ["ip", "link", "add", "name", "end_a", "type", "veth", "peer", "name", "end_b"],
                                  stderr=subprocess.DEVNULL).returncode == 0), None)
    if own is None:
        skip("network namespaces can't be made here: that needs root, or users' own namespaces")
    os.environ[MARK] = "yes"
    os.execvp(own[0], own + [sys.executable, "-B"] + sys.argv)


def skip(reason):
    print("SKIPPED: " + reason)
    sys.exit(CTEST_SKIPPED)


def machine_environment(address):
    environment = dict(os.environ, ROS_IP=address, ROS_MASTER_URI="http://%s:11311" % FAR)
    environment.pop("ROS_HOSTNAME", None)  # it would go before ROS_IP
    return environment


class LinkedMachines:
    def __init__(self):
        self.started = []
        self.far = self._start(["unshare", "--net", "sleep", "infinity"])
        ours = os.readlink("/proc/self/ns/net")
        while os.readlink("/proc/%d/ns/net" % self.far.pid) == ours:
            pass  # not there yet
        ip("link", "add", "name", CABLE[0], "type", "veth", "peer", "name", CABLE[1], "netns", str(self.far.pid))
        for run, address, end in ((ip, NEAR, CABLE[0]), (self._far_ip, FAR, CABLE[1])):
            run("address", "add", address + "/30", "dev", end)
            run("link", "set", "lo", "up")
            run("link", "set", end, "up")
        os.environ.update(machine_environment(NEAR))
        os.environ.pop("ROS_HOSTNAME", None)

    def near(self, *command, **options):
        return self._start(list(command), env=machine_environment(NEAR), **options)

    def on_far(self, *command, **options):
        return self._start(self._inside(command), env=machine_environment(FAR), **options)

    def ask_far(self, *command):
        """What a command says that runs there to its end."""
        return subprocess.run(self._inside(command), env=machine_environment(FAR), check=True, text=True,
                              stdout=subprocess.PIPE).stdout

    def cut(self):
        ip("link", "set", CABLE[0], "down")

    def mend(self):
        ip("link", "set", CABLE[0], "up")

    @staticmethod
    def received_bytes():
        """What came over the cable so far."""
        with open("/proc/self/net/dev") as counters:  # of this process's namespace
            return next(int(line.split(":")[1].split()[0]) for line in counters if line.strip().startswith(CABLE[0]))

    def end(self):
        for process in reversed(self.started):
            process.kill()
            process.wait()

    def _inside(self, command):
        return ["nsenter", "--target", str(self.far.pid), "--net", *command]

    def _far_ip(self, *arguments):
        subprocess.run(self._inside(("ip",) + arguments), check=True)

    def _start(self, command, **options):
        process = subprocess.Popen(["setpriv", "--pdeathsig", "KILL"] + command, **options)
        self.started.append(process)
        return process


def ip(*arguments):
    subprocess.run(("ip",) + arguments, check=True)
