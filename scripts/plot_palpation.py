#!/usr/bin/env python3
"""Plots a palpation from run_scene's CSV: the map of peak forces, and force against depth for each press.

Beside it, if there is one, the same palpation of the same tissue without its stiff regions, and how
many times as much force the stiff regions make. What the map says goes to palpation_map.json too.
"""
import argparse
import collections
import csv
import json
import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.path
import matplotlib.pyplot as plt
import matplotlib.tri
import numpy as np

TOUCH_N = 1.0e-3  # below that the probe counts as free
SAME_PLACE_M = 1.0e-3  # a step may pass between two first touches
Press = collections.namedtuple("Press", "x_m y_m peak_n depth_m force_n")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--csv", required=True, help="written by run_scene --csv")
    parser.add_argument("--without", help="CSV of the same presses on the tissue without its stiff regions")
    parser.add_argument("--bag", help="written by run_scene --bag-out: tells where the regions are")
    parser.add_argument("--out", required=True, help="folder for force_map.png, force_depth.png, palpation_map.json")
    parser.add_argument("--tool", help="tool to plot, its frame at its tip; default: the first in the CSV")
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
    """One press for every time the probe touches and lets go: where it touched first, and its way down."""
    tip = np.column_stack([columns["%s_%s_m" % (tool, axis)] for axis in "xyz"])
    force = np.sqrt(sum(columns["%s_force_%s_n" % (tool, axis)]**2 for axis in "xyz"))
    touching = np.concatenate(([False], force > TOUCH_N, [False]))
    starts = np.flatnonzero(~touching[:-1] & touching[1:])
    ends = np.flatnonzero(touching[:-1] & ~touching[1:])
    presses = []
    for start, end in zip(starts, ends):
        first = max(start - 1, 0)
        depth = np.linalg.norm(tip[first:end] - tip[first], axis=1)
        deepest = int(np.argmax(depth)) + 1
        peak = start + int(np.argmax(force[start:end]))
        presses.append(Press(tip[first, 0], tip[first, 1], force[peak], depth[:deepest],
                             force[first:first + deepest]))
    if not presses:
        raise ValueError("%s never touches anything" % tool)
    return presses


def need_same_places(presses, others):
    """Comparing press by press makes sense for the same presses only."""
    if len(presses) != len(others):
        raise ValueError("%d presses can't be compared with %d" % (len(presses), len(others)))
    for press, other in zip(presses, others):
        if np.hypot(press.x_m - other.x_m, press.y_m - other.y_m) > SAME_PLACE_M:
            raise ValueError("the press at x = %g m, y = %g m is compared with one at x = %g m, y = %g m" %
                             (press.x_m, press.y_m, other.x_m, other.y_m))


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


def is_over(press, outlines):
    return any(matplotlib.path.Path(outline).contains_point((press.x_m, press.y_m)) for outline in outlines)


def figures(presses, others, outlines):
    """What the map says, in numbers; `others` are the presses without the stiff regions, or None."""
    def place(number):
        found = {"x_m": presses[number].x_m, "y_m": presses[number].y_m, "peak_n": presses[number].peak_n}
        if others:
            found["peak_without_n"] = others[number].peak_n
            found["ratio"] = presses[number].peak_n / others[number].peak_n
        return found

    def strongest(over):
        numbers = [i for i, press in enumerate(presses) if is_over(press, outlines) == over]
        return place(max(numbers, key=lambda i: presses[i].peak_n)) if numbers else None

    return {"presses": len(presses), "strongest_over_stiff_region": strongest(True),
            "strongest_elsewhere": strongest(False)}


def draw_map(axes, presses, values, outlines, scale, title):
    x, y = 1e3 * np.array([p.x_m for p in presses]), 1e3 * np.array([p.y_m for p in presses])
    if len(presses) >= 4 and min(np.ptp(x), np.ptp(y)) > 0.0:
        axes.tricontourf(*smooth(x, y, values), levels=np.linspace(*scale, 25), extend="both", cmap="inferno")
    points = axes.scatter(x, y, c=values, vmin=scale[0], vmax=scale[1], cmap="inferno", edgecolors="white",
                          linewidths=0.6, s=16)
    for number, outline in enumerate(outlines):
        axes.plot(1e3 * outline[:, 0], 1e3 * outline[:, 1], "--", color="cyan", lw=1.6,
                  label="stiff region" if number == 0 else None)
    axes.margins(0.04)
    axes.set(xlabel="x [mm]", ylabel="y [mm]", title=title, aspect="equal")
    return points


def smooth(x, y, values):
    """A finer triangulation and the values on it, through the measured ones."""
    coarse = matplotlib.tri.Triangulation(x, y)
    coarse.set_mask(matplotlib.tri.TriAnalyzer(coarse).get_flat_tri_mask(0.1))
    refiner = matplotlib.tri.UniformTriRefiner(coarse)
    return refiner.refine_field(values, matplotlib.tri.CubicTriInterpolator(coarse, values, kind="geom"), subdiv=3)


def plot_maps(presses, others, outlines, path):
    count = 3 if others else 1
    figure, (all_axes,) = plt.subplots(1, count, figsize=(4.2 * count + 0.4, 3.2), squeeze=False,
                                       layout="constrained")
    peak = np.array([press.peak_n for press in presses])
    other_peak = np.array([press.peak_n for press in others]) if others else peak
    scale = (min(peak.min(), other_peak.min()), max(peak.max(), other_peak.max()))
    points = draw_map(all_axes[0], presses, peak, outlines, scale, "Peak force of each press")
    if outlines:
        all_axes[0].legend(loc="lower left", fontsize="small")
    if others:
        draw_map(all_axes[1], presses, other_peak, outlines, scale, "The same, the stiff region made soft")
        ratio = peak / other_peak
        ratios = draw_map(all_axes[2], presses, ratio, outlines, (1.0, max(ratio.max(), 1.01)), "Ratio")
        figure.colorbar(ratios, ax=all_axes[2], label="with over without")
    figure.colorbar(points, ax=all_axes[:2], label="peak force [N]")
    figure.savefig(path, dpi=100)


def plot_curves(presses, others, outlines, path):
    figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
    groups = [([p for p in presses if not is_over(p, outlines)], "0.7", "elsewhere"),
              ([p for p in presses if is_over(p, outlines)], "tab:red", "over the stiff region")]
    if others:
        groups.append(([p for p in others if is_over(p, outlines)], "tab:blue", "the same places without it"))
    for group, colour, label in groups:
        for number, press in enumerate(group):
            axes.plot(1e3 * press.depth_m, press.force_n, color=colour, lw=1.0,
                      label=label if number == 0 and outlines else None)
    if outlines:
        axes.legend(loc="upper left")
    axes.set(xlabel="way since first touch [mm]", ylabel="force [N]", title="Force while pressing down")
    axes.grid(True, alpha=0.3)
    figure.savefig(path, dpi=110)


def main():
    arguments = parse_arguments()
    try:
        columns = read_columns(arguments.csv)
        tool = arguments.tool or first_tool(columns)
        presses, others = find_presses(columns, tool), None
        if arguments.without:
            others = find_presses(read_columns(arguments.without), tool)
            need_same_places(presses, others)
        outlines = [hull(region) for region in read_regions(arguments.bag)] if arguments.bag else []
        os.makedirs(arguments.out, exist_ok=True)
        plot_maps(presses, others, outlines, os.path.join(arguments.out, "force_map.png"))
        plot_curves(presses, others, outlines, os.path.join(arguments.out, "force_depth.png"))
        with open(os.path.join(arguments.out, "palpation_map.json"), "w") as stream:
            json.dump(figures(presses, others, outlines), stream, indent=2)
    except (OSError, ValueError, KeyError) as error:
        sys.exit("plot_palpation.py: %s" % error)
    strongest = max(presses, key=lambda press: press.peak_n)
    weakest = min(presses, key=lambda press: press.peak_n)
    print("%d presses, peak force %.3f to %.3f N, strongest at x = %.1f mm, y = %.1f mm" %
          (len(presses), weakest.peak_n, strongest.peak_n, 1e3 * strongest.x_m, 1e3 * strongest.y_m))


if __name__ == "__main__":
    main()
