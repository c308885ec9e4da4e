"""Small files, and launch arguments that say what they are for."""
import pathlib
import re
import statistics
import unittest
import xml.etree.ElementTree as xml

ROOT = pathlib.Path(__file__).resolve().parents[2]
LONGEST_FILE = 400
LONGEST_MEDIAN = 120
LONGEST_LINE = 100
UNFINISHED = re.compile(r"\b(TO" r"DO|FIX" r"ME|XX" r"X)\b")


def files(folders, suffixes):
    return [path for folder in folders for path in sorted((ROOT / folder).rglob("*")) if path.suffix in suffixes]


def lines_of(path):
    return path.read_text(encoding="utf-8").splitlines()


class Sources(unittest.TestCase):
    cpp = files(["include", "src", "test", "bench"], {".h", ".cpp"})
    every = cpp + files(["test", "bench", "scripts"], {".py"}) + files(["launch", "config"], {".launch", ".yaml"})

    def test_none_is_long(self):
        self.assertEqual([(str(path.relative_to(ROOT)), len(lines_of(path))) for path in self.every
                          if len(lines_of(path)) > LONGEST_FILE], [])

    def test_most_are_short(self):
        self.assertLessEqual(statistics.median(len(lines_of(path)) for path in self.cpp), LONGEST_MEDIAN)

    def test_lines_fit(self):
        self.assertEqual([f"{path.relative_to(ROOT)}:{number}" for path in self.cpp
                          for number, line in enumerate(lines_of(path), 1) if len(line) > LONGEST_LINE], [])

    def test_headers_are_guarded(self):
        self.assertEqual([str(path.relative_to(ROOT)) for path in self.cpp
                          if path.suffix == ".h" and "#pragma once" not in lines_of(path)], [])

    def test_nothing_is_unfinished(self):
        self.assertEqual([f"{path.relative_to(ROOT)}:{number}" for path in self.every
                          for number, line in enumerate(lines_of(path), 1) if UNFINISHED.search(line)], [])


class LaunchFiles(unittest.TestCase):
    def test_every_argument_is_documented(self):
        launch_files = files(["launch"], {".launch"})
        self.assertTrue(launch_files)
        undocumented = [f"{path.name}: {arg.get('name')}" for path in launch_files
                        for arg in xml.parse(path).getroot().findall("arg") if not arg.get("doc")]
        self.assertEqual(undocumented, [])


if __name__ == "__main__":
    unittest.main()
