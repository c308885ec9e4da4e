#!/usr/bin/env python3
"""Writes a scene again without the regions of its tissues: the same bodies, each of one material."""
import argparse
import sys

import yaml


def without_regions(scene):
    """The scene, its tissues' regions gone."""
    regions = [tissue.pop("regions") for tissue in scene["tissues"] if "regions" in tissue]
    if not regions:
        raise ValueError("no tissue has regions")
    return scene


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scene", help="scene file; files it names must be absolute or package://...")
    parser.add_argument("out", help="scene file to write")
    arguments = parser.parse_args()
    try:
        with open(arguments.scene) as stream:
            scene = without_regions(yaml.safe_load(stream))
        with open(arguments.out, "w") as stream:
            yaml.safe_dump(scene, stream, sort_keys=False)
    except (OSError, ValueError, KeyError, TypeError, yaml.YAMLError) as error:
        sys.exit("without_regions.py: %s" % error)


if __name__ == "__main__":
    main()
