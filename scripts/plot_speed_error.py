#!/usr/bin/env python3
"""Draws what speed_error measured: error against time, and time against size.

    plot_speed_error.py DIR    DIR/field.csv becomes DIR/field_error.png and DIR/field_scaling.png,
                               DIR/fem.csv DIR/fem_<case>.png
                               DIR/features.csv DIR/features.png

Fields: squares are grids of the second order, numbers their points along an axis. FEM: numbers are nodes, lines join
what no other way beats in both, stars are the defaults of a scene file.
"""
import csv
import os
import sys

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402  (the backend comes first)

COLUMNS = 4
ROUNDING = 1e-16  # where errors of zero are drawn


def read(path):
    with open(path) as stream:
        rows = list(csv.DictReader(stream))
    for row in rows:
        for key in ("ms", "max_err", "median_err", "wrong_fraction"):
            row[key] = float(row[key])
        for key in ("dim", "elements", "nodes"):
            row[key] = int(row[key])
    return rows


def largest_of_each_case(rows):
    size = {}
    for row in rows:
        size[row["case"]] = max(size.get(row["case"], 0), row["elements"])
    return [row for row in rows if row["elements"] == size[row["case"]] and "lazy" not in row["method"]]


def plot_error(rows, path):
    chosen = largest_of_each_case(rows)
    cases = list(dict.fromkeys(row["case"] for row in chosen))
    methods = list(dict.fromkeys(row["method"] for row in chosen))
    lines = (len(cases) + COLUMNS - 1) // COLUMNS
    figure, axes = plt.subplots(lines, COLUMNS, figsize=(4 * COLUMNS, 3.5 * lines), squeeze=False)
    for axis, case in zip(axes.flat, cases):
        of_case = [row for row in chosen if row["case"] == case]
        named = set()
        for row in of_case:
            number = methods.index(row["method"])
            marker = "s" if row["order"] == "2" else "o"
            label = None if row["method"] in named else row["method"]
            named.add(row["method"])
            colour = plt.cm.tab20(number % 20)
            axis.loglog(row["ms"], max(row["max_err"], ROUNDING), marker, color=colour, label=label)
            axis.loglog(row["ms"], max(row["median_err"], ROUNDING), "_", markersize=12, color=colour)
            if row["resolution"]:
                axis.annotate(row["resolution"], (row["ms"], max(row["max_err"], ROUNDING)), fontsize=6)
        axis.set_title("%s, %d elements" % (case, of_case[0]["elements"]))
        axis.set_xlabel("ms")
        axis.set_ylabel("error: o largest, - median")
        axis.legend(fontsize=6)
    for axis in axes.flat[len(cases):]:
        axis.remove()
    figure.tight_layout()
    figure.savefig(path, dpi=100)
    plt.close(figure)


def plot_scaling(rows, path):
    balls = [row for row in rows if row["case"] == "ball"]
    figure, axis = plt.subplots(figsize=(6, 4.5))
    for method in dict.fromkeys(row["method"] for row in balls):
        line = [row for row in balls if row["method"] == method]
        axis.loglog([row["elements"] for row in line], [1e6 * row["ms"] / row["nodes"] for row in line], "o-",
                    label=method)
    axis.set_xlabel("tets of a ball")
    axis.set_ylabel("ns per node")
    axis.legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(path, dpi=120)


def read_fem(path):
    with open(path) as stream:
        rows = list(csv.DictReader(stream))
    for row in rows:
        for key in ("ms", "error"):
            row[key] = float(row[key])
    return rows


def plot_fem(rows, case, path):
    of_case = [row for row in rows if row["case"] == case]
    figure, axis = plt.subplots(figsize=(7, 5))
    kinds = {}
    for row in of_case:
        name = row["method"] if row["method"] != "scene" else " ".join([row["element"], row["law"], row["linear"]])
        kinds.setdefault(name, []).append(row)
    for number, (name, line) in enumerate(kinds.items()):
        colour = plt.cm.tab20(number % 20)
        axis.loglog([row["ms"] for row in line], [max(row["error"], ROUNDING) for row in line],
                    {"tet4": "o", "tet4_anp": "^"}.get(line[0]["element"], "s"), color=colour, label=name)
    for row in of_case:
        axis.annotate(row["nodes"], (row["ms"], max(row["error"], ROUNDING)), fontsize=6)
        if row["default"] == "1":
            axis.loglog(row["ms"], max(row["error"], ROUNDING), "*", markersize=13, color="none",
                        markeredgecolor="black")
    front = sorted((row["ms"], max(row["error"], ROUNDING)) for row in of_case if row["pareto"] == "1")
    axis.loglog([ms for ms, _ in front], [error for _, error in front], "-", color="grey", linewidth=0.8)
    axis.set_title(case)
    axis.set_xlabel("ms of one thread, " + ("a simulated second" if case in ("heavy", "fall") else "a solve"))
    axis.set_ylabel("relative error")
    axis.legend(fontsize=6)
    figure.tight_layout()
    figure.savefig(path, dpi=120)
    plt.close(figure)


def plot_all_fem(folder):
    rows = read_fem(os.path.join(folder, "fem.csv"))
    for case in dict.fromkeys(row["case"] for row in rows):
        plot_fem(rows, case, os.path.join(folder, "fem_%s.png" % case.replace(" ", "_").replace("/", "_")))


def read_features(path):
    with open(path) as stream:
        rows = list(csv.DictReader(stream))
    for row in rows:
        for key in ("ms", "ratio", "wall_ratio"):
            row[key] = float(row[key])
    return rows


def plot_features(rows, path):
    """How many times as long steps take with a feature as without it; two threads by the clock on the wall."""
    shown = [row for row in rows if row["state"] != "off"]
    figure, axis = plt.subplots(figsize=(8, 0.24 * len(shown) + 1))
    ratios = [row["wall_ratio"] if row["threads"] != "1" else row["ratio"] for row in shown]
    colours = ["tab:grey" if row["state"] == "idle" else "tab:blue" for row in shown]
    axis.barh(range(len(shown)), [ratio - 1 for ratio in ratios], left=1, color=colours)
    axis.set_yticks(range(len(shown)), ["%s: %s" % (row["feature"], row["state"]) for row in shown], fontsize=7)
    axis.invert_yaxis()
    axis.axvline(1, color="black", linewidth=0.8)
    axis.set_xlabel("times as long as without it: idle grey, in use blue")
    figure.tight_layout()
    figure.savefig(path, dpi=120)
    plt.close(figure)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = sys.argv[1]
    there = [name for name in ("field.csv", "fem.csv", "features.csv") if os.path.exists(os.path.join(folder, name))]
    if not there:
        sys.exit("%s: neither field.csv, fem.csv nor features.csv is there" % folder)
    if "field.csv" in there:
        rows = read(os.path.join(folder, "field.csv"))
        plot_error(rows, os.path.join(folder, "field_error.png"))
        plot_scaling(rows, os.path.join(folder, "field_scaling.png"))
    if "fem.csv" in there:
        plot_all_fem(folder)
    if "features.csv" in there:
        plot_features(read_features(os.path.join(folder, "features.csv")), os.path.join(folder, "features.png"))


if __name__ == "__main__":
    main()
