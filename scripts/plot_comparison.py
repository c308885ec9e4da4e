#!/usr/bin/env python3
"""Draws measured and simulated forces over time, from the file that run_scene --compare writes.

    plot_comparison.py COMPARE.csv OUT.png    a row of panels for each tool: the three components, and the error
"""
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import numpy as np  # noqa: E402  (the backend comes first)
from matplotlib import pyplot as plt  # noqa: E402

AXES = "xyz"


def read(path):
    """For each tool: times (N), measured and simulated forces (N x 3, newtons, world axes)."""
    with open(path, newline="") as stream:
        rows = list(csv.DictReader(stream))
    if not rows:
        raise ValueError("%s: nothing was compared" % path)
    tools = {}
    for row in rows:
        tools.setdefault(row["tool"], []).append(row)

    def forces(of_tool, side):
        return np.array([[float(row["%s_force_%s_n" % (side, axis)]) for axis in AXES] for row in of_tool])

    return {tool: (np.array([float(row["time_s"]) for row in of_tool]), forces(of_tool, "measured"),
                   forces(of_tool, "simulated")) for tool, of_tool in tools.items()}


def root_mean_square(vectors):
    return float(np.sqrt(np.mean(np.sum(vectors**2, axis=1))))


def plot(tools, path):
    figure, rows = plt.subplots(len(tools), 4, figsize=(15.0, 3.2 * len(tools)), squeeze=False,
                                layout="constrained")
    for panels, (tool, (time, measured, simulated)) in zip(rows, tools.items()):
        for k, axis in enumerate(AXES):
            panels[k].plot(time, measured[:, k], color="0.55", lw=2.0, label="measured")
            panels[k].plot(time, simulated[:, k], color="tab:red", lw=1.0, label="simulated")
            panels[k].set(xlabel="time [s]", ylabel="force %s [N]" % axis)
        panels[0].legend(fontsize="small")
        panels[0].set_title(tool)
        panels[3].plot(time, np.linalg.norm(simulated - measured, axis=1), color="tab:blue", lw=1.0)
        panels[3].set(xlabel="time [s]", ylabel="|error| [N]", title="%.3g N rms of %.3g N" % (
            root_mean_square(simulated - measured), root_mean_square(measured)))
    figure.savefig(path, dpi=110)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    try:
        plot(read(sys.argv[1]), sys.argv[2])
    except (OSError, KeyError, ValueError) as error:
        sys.exit("plot_comparison: %s" % error)


if __name__ == "__main__":
    main()
