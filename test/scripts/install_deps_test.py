"""install_deps on machines of every kind, played by stand-ins for apt-get, dpkg-query, id and sudo."""
import os
import pathlib
import subprocess
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "install_deps"
DEBIAN_12 = 'PRETTY_NAME="Debian GNU/Linux 12 (bookworm)"\nID=debian\nVERSION_ID="12"\n'
UBUNTU = 'PRETTY_NAME="Ubuntu 22.04.4 LTS"\nID=ubuntu\nVERSION_ID="22.04"\n'
NEEDED_TOOLS = ["bash", "env", "sed", "sort", "comm", "tr", "cat"]


def run(*options, installed=(), release=DEBIAN_12, user=0, sudo=False, apt="exit 0", localhost=True):
    """Runs the script with only stand-ins on PATH; returns (exit status, output, calls of apt-get)."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "os-release").write_text(release, encoding="utf-8")
        calls = folder / "calls"
        calls.touch()
        stand_ins = {"id": f"echo {user}",
                     "getent": "exit 0" if localhost else "exit 2",
                     "dpkg-query": "\n".join(f"echo installed {name}" for name in installed) or "exit 1"}
        if apt is not None:
            stand_ins["apt-get"] = f'echo "$@" >> {calls}\n{apt}'
        if sudo:
            stand_ins["sudo"] = f'echo "sudo $1" >> {calls}\n"$@"'
        bin_folder = folder / "bin"
        bin_folder.mkdir()
        for tool in NEEDED_TOOLS:
            (bin_folder / tool).symlink_to(f"/usr/bin/{tool}")
        for name, text in stand_ins.items():
            (bin_folder / name).write_text(f"#!/usr/bin/bash\n{text}\n", encoding="utf-8")
            (bin_folder / name).chmod(0o755)
        done = subprocess.run(["/usr/bin/bash", SCRIPT, *options], capture_output=True, text=True,
                              env={**os.environ, "PATH": str(bin_folder), "OS_RELEASE_FILE": str(folder / "os-release")})
        return done.returncode, done.stdout + done.stderr, calls.read_text(encoding="utf-8").splitlines()


def packages(*options):
    return run(*options, "--list")[1].split()


class InstallDeps(unittest.TestCase):
    def test_lists_packages_without_touching_anything(self):
        status, output, calls = run("--list")
        self.assertEqual((status, calls), (0, []))
        self.assertIn("libroscpp-dev", output.split())
        self.assertNotIn("xvfb", output.split())
        self.assertIn("xvfb", packages("--demo"))
        self.assertIn("libbenchmark-dev", packages("--bench"))

    def test_makes_localhost_known_where_it_is_not(self):
        self.assertNotIn("libnss-myhostname", packages())
        self.assertIn("libnss-myhostname", run("--list", localhost=False)[1].split())

    def test_asks_no_mirror_when_all_is_there(self):
        status, output, calls = run(installed=packages())
        self.assertEqual((status, calls), (0, []))
        self.assertIn("everything is installed", output)

    def test_all_there_is_enough_on_any_system(self):
        self.assertEqual(run(installed=packages(), release=UBUNTU, apt=None)[0], 0)

    def test_installs_only_what_is_missing(self):
        status, output, calls = run(installed=[name for name in packages() if name != "tetgen"])
        self.assertEqual(status, 0)
        self.assertIn("1 packages are missing: tetgen", output)
        self.assertEqual(len(calls), 2)
        self.assertTrue(calls[0].endswith(" update"))
        self.assertTrue(calls[1].endswith("install -y --no-install-recommends tetgen"))

    def test_uses_sudo_when_it_is_not_root(self):
        status, _, calls = run(user=1000, sudo=True)
        self.assertEqual(status, 0)
        self.assertEqual([call for call in calls if call.startswith("sudo")], ["sudo env", "sudo env"])

    def test_says_so_when_there_is_neither_root_nor_sudo(self):
        status, output, calls = run(user=1000)
        self.assertEqual((status, calls), (1, []))
        self.assertIn("installing takes root", output)
        self.assertIn("apt-get install --no-install-recommends", output)

    def test_names_a_system_that_is_not_debian_12(self):
        for release, found in ((UBUNTU, "Ubuntu 22.04.4 LTS"), ("", "an unknown system"),
                               (DEBIAN_12.replace("12", "11"), "Debian GNU/Linux 11")):
            status, output, calls = run(release=release)
            self.assertEqual((status, calls), (1, []))
            self.assertIn(f"this is {found}", output)
            self.assertIn("Debian 12 (bookworm)", output)

    def test_says_so_when_there_is_no_apt(self):
        status, output, _ = run(apt=None)
        self.assertEqual(status, 1)
        self.assertIn("there is no apt-get", output)

    def test_goes_on_when_one_mirror_does_not_answer(self):
        status, output, _ = run(apt='[[ $* != *" update" ]]')
        self.assertEqual(status, 0)
        self.assertIn("not every mirror answered", output)

    def test_says_so_when_no_mirror_answers(self):
        status, output, _ = run(apt="exit 100")
        self.assertEqual(status, 1)
        self.assertIn("Is the network up", output)

    def test_refuses_an_unknown_option(self):
        status, output, calls = run("--everything")
        self.assertEqual((status, calls), (1, []))
        self.assertIn("unknown option '--everything'", output)


if __name__ == "__main__":
    unittest.main()
