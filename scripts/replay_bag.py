#!/usr/bin/env python3
"""Plays to a node what of a bag concerns its scene, below whatever names it was recorded, with the bag's clock."""
import argparse
import os
import subprocess
import sys


def inputs(scene, bag):
    """[(recorded topic, name below the node)], as run_scene finds them."""
    said = subprocess.run(["rosrun", "soft_tissue_sim", "run_scene", scene, "--bag-in", bag, "--list-inputs"],
                          stdout=subprocess.PIPE, universal_newlines=True)
    if said.returncode != 0:
        sys.exit(said.returncode)
    return [line.split(":=") for line in said.stdout.splitlines()]


def play_command(pairs, node, bag, options):
    """What plays these topics as the node's."""
    renamed = [(recorded, name if name.startswith("/") else node + "/" + name) for recorded, name in pairs]
    return (["rosrun", "rosbag", "play", "--quiet", "--clock", "--hz=200"] + options +
            ["--topics"] + [recorded for recorded, _ in renamed] + ["--bags=" + bag] +
            ["%s:=%s" % pair for pair in renamed if pair[0] != pair[1]])


def main(arguments):
    by_roslaunch = [argument for argument in arguments if argument.startswith("__")]
    arguments = [argument for argument in arguments if argument not in by_roslaunch]
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scene", required=True, help="scene of the node")
    parser.add_argument("--bag", required=True)
    parser.add_argument("--node", default="/sim_node", help="the node's name (%(default)s)")
    parser.add_argument("--also", nargs="*", default=[], metavar="RECORDED:=NAME",
                        help="more topics, and the node's names for them, e.g. /PSM1/setpoint_cp:=psm/servo_cp")
    known, options = parser.parse_known_args(arguments)
    pairs = inputs(known.scene, known.bag) + [pair.split(":=") for pair in known.also]
    if any(len(pair) != 2 for pair in pairs):
        parser.error("--also takes pairs RECORDED:=NAME")
    if not pairs:
        sys.exit("replay_bag: %s has nothing that moves a tool of %s or tells of its obstacles" % (known.bag, known.scene))
    for recorded, name in pairs:
        print("playing %s as %s" % (recorded, name), flush=True)
    command = play_command(pairs, known.node, known.bag, options) + by_roslaunch
    os.execvp(command[0], command)


if __name__ == "__main__":
    main(sys.argv[1:])
