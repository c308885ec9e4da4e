#!/usr/bin/env python3
"""Plots a palpation from run_scene's CSV: the map of peak forces, and force against depth for each press."""
import argparse
import collections
import csv
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

TOUCH_N = 1.0e-3  # below that the probe counts as free
Press = collections.namedtuple("Press", "x_m y_m peak_n depth_m force_n")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--csv", required=True, help="written by run_scene --csv")
    parser.add_argument("--bag", help="written by run_scene --bag-out: tells where the regions are")
    parser.add_argument("--out", required=True, help="folder for force_map.png and force_depth.png")
    parser.add_argument("--tool", help="tool to plot; default: the first in the CSV")
    return parser.parse_args()


def read_columns(path):
    """Columns by name, as numbers."""
    with open(path, newline="") as stream:
        rows = list(csv.DictReader(stream))
    if not rows:
        raise ValueError("%s: has no steps" % path)
    names = [name for name in rows[0] if name != "state_hash"]
    return {name: np.array([float(row[name]) for row in rows]) for name in names}


def first_tool(columns):
    for name in columns:
        if name.endswith("_force_x_n"):
            return name[:-len("_force_x_n")]
    raise ValueError("there is no tool in the CSV")


def find_presses(columns, tool):
    """One press for every time the probe touches and lets go."""
    x, y, z = (columns["%s_%s_m" % (tool, axis)] for axis in "xyz")
    force = np.sqrt(sum(columns["%s_force_%s_n" % (tool, axis)]**2 for axis in "xyz"))
    touching = np.concatenate(([False], force > TOUCH_N, [False]))
    starts = np.flatnonzero(~touching[:-1] & touching[1:])
    ends = np.flatnonzero(touching[:-1] & ~touching[1:])
    presses = []
    for start, end in zip(starts, ends):
        peak = start + int(np.argmax(force[start:end]))
        down = slice(max(start - 1, 0), start + int(np.argmin(z[start:end])) + 1)
        presses.append(Press(x[peak], y[peak], force[peak], z[down.start] - z[down], force[down]))
    if not presses:
        raise ValueError("%s never touches anything" % tool)
    return presses


def read_regions(path):
    """For every tissue and every region but its largest: the nodes' x and y (K x 2) at rest."""
    import rosbag
    regions = []
    with rosbag.Bag(path) as bag:
        for topic, mesh, _ in bag.read_messages():
            if not topic.endswith("/mesh"):
                continue
            nodes = np.array(mesh.rest_positions).reshape(-1, 3)
            tets = np.array(mesh.tets).reshape(-1, 4)
            tags = np.array(mesh.region_tags)
            values, counts = np.unique(tags, return_counts=True)
            for value in values:
                if value != values[np.argmax(counts)]:
                    regions.append(nodes[np.unique(tets[tags == value]), :2])
    return regions


def hull(points):
    """Convex hull of points (K x 2), counter-clockwise, closed."""
    def half(ordered):
        chain = []
        for p in ordered:
            while len(chain) > 1:
                a, b = chain[-1] - chain[-2], p - chain[-2]
                if a[0] * b[1] - a[1] * b[0] > 0.0:
                    break
                chain.pop()
            chain.append(p)
        return chain
    ordered = points[np.lexsort((points[:, 1], points[:, 0]))]
    lower, upper = half(ordered), half(ordered[::-1])
    return np.array(lower + upper[1:])


def plot_map(presses, regions, path):
    figure, axes = plt.subplots(figsize=(7.0, 5.2))
    x, y, peak = (1e3 * np.array([p.x_m for p in presses]), 1e3 * np.array([p.y_m for p in presses]),
                  np.array([p.peak_n for p in presses]))
    spans = [np.ptp(x), np.ptp(y)]
    if len(presses) >= 4 and min(spans) > 0.0:
        axes.tricontourf(x, y, peak, levels=20, cmap="viridis")
    points = axes.scatter(x, y, c=peak, cmap="viridis", edgecolors="white", s=60)
    for number, region in enumerate(regions):
        outline = 1e3 * hull(region)
        axes.plot(outline[:, 0], outline[:, 1], "r--", label="stiff region" if number == 0 else None)
    if regions:
        axes.legend(loc="upper right")
    figure.colorbar(points, label="peak force [N]")
    axes.margins(0.06)
    axes.set(xlabel="x [mm]", ylabel="y [mm]", title="Peak force of each press", aspect="equal")
    figure.tight_layout()
    figure.savefig(path, dpi=120)


def plot_curves(presses, path):
    figure, axes = plt.subplots(figsize=(7.0, 5.2))
    peaks = np.array([p.peak_n for p in presses])
    colours = matplotlib.cm.ScalarMappable(matplotlib.colors.Normalize(peaks.min(), peaks.max()),
                                           "viridis")
    for press in presses:
        axes.plot(1e3 * press.depth_m, press.force_n, color=colours.to_rgba(press.peak_n), lw=1.0)
    figure.colorbar(colours, ax=axes, label="peak force [N]")
    axes.set(xlabel="way since first touch [mm]", ylabel="force [N]", title="Force while pressing down")
    axes.grid(True, alpha=0.3)
    figure.tight_layout()
    figure.savefig(path, dpi=120)


def main():
    arguments = parse_arguments()
    try:
        columns = read_columns(arguments.csv)
        presses = find_presses(columns, arguments.tool or first_tool(columns))
        regions = read_regions(arguments.bag) if arguments.bag else []
        os.makedirs(arguments.out, exist_ok=True)
        plot_map(presses, regions, os.path.join(arguments.out, "force_map.png"))
        plot_curves(presses, os.path.join(arguments.out, "force_depth.png"))
    except (OSError, ValueError, KeyError) as error:
        sys.exit("plot_palpation.py: %s" % error)
    strongest = max(presses, key=lambda press: press.peak_n)
    weakest = min(presses, key=lambda press: press.peak_n)
    print("%d presses, peak force %.3f to %.3f N, strongest at x = %.1f mm, y = %.1f mm" %
          (len(presses), weakest.peak_n, strongest.peak_n, 1e3 * strongest.x_m,
           1e3 * strongest.y_m))


if __name__ == "__main__":
    main()
