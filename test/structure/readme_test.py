"""The scene the README shows runs, and the files it points to exist. usage: readme_test.py RUN_SCENE"""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
RUN_SCENE = sys.argv.pop(1)
README = (ROOT / "README.md").read_text(encoding="utf-8")


class Readme(unittest.TestCase):
    def test_its_scene_runs(self):
        scenes = re.findall(r"```yaml\n(.*?)```", README, re.DOTALL)
        self.assertEqual(len(scenes), 1)
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder) / "scene.yaml"
            scene.write_text(scenes[0], encoding="utf-8")
            done = subprocess.run([RUN_SCENE, scene, "--duration", "0.02", "--quiet"], capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stdout + done.stderr), (0, ""))

    def test_what_it_links_to_exists(self):
        links = re.findall(r"\]\(([^)]+)\)", README)
        self.assertTrue(links)
        self.assertEqual([link for link in links if not (ROOT / link).exists()], [])

    def test_its_pictures_are_small(self):
        pictures = list((ROOT / "docs/images").glob("*.png"))
        self.assertTrue(pictures)
        self.assertEqual([picture.name for picture in pictures if picture.stat().st_size > 300_000], [])

    def test_limits_name_everything_that_is_not_available(self):
        limits = (ROOT / "docs/limits.md").read_text(encoding="utf-8")
        described = (ROOT / "docs/scene.md").read_text(encoding="utf-8")
        keys = re.findall(r"^- `(\w+)`: ", described, re.MULTILINE)
        schema = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "src/scene").glob("schema_*.cpp"))
        words = re.findall(r'^ +\{"(\w+)"\}\),$', schema, re.MULTILINE)  # known to the parser, for later
        self.assertTrue(keys + words)
        self.assertEqual([name for name in keys + words if name not in limits], [])


if __name__ == "__main__":
    unittest.main()
