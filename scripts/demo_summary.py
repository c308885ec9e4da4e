#!/usr/bin/env python3
"""Prints what scripts/demo measured: the runs from the bag, the map of forces, and the live run if there was one."""
import csv
import json
import os
import statistics
import sys


def print_row(name, value):
    print("  %-32s %s" % (name, value))


def print_run(title, run):
    print(title)
    for body in run["bodies"]:
        print_row("tissue " + body["name"], "%d nodes, %d tets" % (body["nodes"], body["tets"]))
    print_row("simulated", "%.1f s in %.1f s" % (run["sim_time_s"], run["wall_s"]))
    print_row("time step", "%g ms" % (1e3 * run["time_step_s"]))
    print_row("real-time factor", "%.2f" % run["real_time_factor"])
    step = run["step_ms"]
    print_row("step", "%.2f ms median, %.2f ms 99th percentile, %.2f ms longest" %
              (step["median"], step["p99"], step["max"]))
    print_row("stages, mean ms", ", ".join("%s %.2f" % stage for stage in run["stage_ms"].items()))
    for tool in run["tools"]:
        print_row("peak force on " + tool["name"],
                  "%.3f N at %.2f s" % (tool["peak_force_n"], tool["peak_force_time_s"]))
    print_row("largest penetration", "%.3f mm" % (1e3 * run["max_penetration_m"]))
    print_row("smallest det F", "%.3f" % run["min_det_f"])
    print_row("steps held / not converged",
              "%d / %d of %d" % (run["steps_held"], run["steps_not_converged"], run["steps"]))
    print_row("state hash", run["state_hash"])


def print_map(found):
    nodule = found["strongest_over_stiff_region"]
    print("map of %d presses" % found["presses"])
    print_row("strongest over the nodule", "%.3f N at x = %.1f mm, y = %.1f mm" %
              (nodule["peak_n"], 1e3 * nodule["x_m"], 1e3 * nodule["y_m"]))
    print_row("the same press without nodule", "%.3f N" % nodule["peak_without_n"])
    print_row("with over without", "%.2f" % nodule["ratio"])
    print_row("strongest beside the nodule", "%.3f N" % found["strongest_elsewhere"]["peak_n"])


def read_stats(path):
    """The SimStats of a bag."""
    import rosbag
    with rosbag.Bag(path) as bag:
        return [message for topic, message, _ in bag.read_messages() if topic.endswith("/stats")]


def marker_rate(path):
    """The last mean rate that rostopic hz wrote, in Hz."""
    with open(path) as stream:
        return float([line.split()[-1] for line in stream if "average rate" in line][-1])


def print_live(title, path, time_step_s):
    """How a run held to real time kept up, and how fast its steps were: a factor of 1.00 means it did keep up."""
    stats = read_stats(path)
    contact_ms = [message.step_ms for message in stats if message.contacts > 0]
    if not contact_ms:
        sys.exit("demo_summary.py: %s: no step in contact" % path)
    factors = [message.real_time_factor for message in stats]
    step_ms = 1e3 * time_step_s
    print(title)
    print_row("real-time factor, at most 1", "%.2f median, %.2f least" % (statistics.median(factors), min(factors)))
    print_row("step in contact", "%.2f ms mean, %.2f ms median, %.2f ms longest, of %g ms" %
              (statistics.mean(contact_ms), statistics.median(contact_ms), max(contact_ms), step_ms))
    contact = [message for message in stats if message.contacts > 0]
    print_row("steps in contact ended early", "%.0f %%, to keep to budget_ms" %
              (100.0 * statistics.mean(message.out_of_time for message in contact)))
    print_row("residual in contact", "%.4f median" % statistics.median(message.residual for message in contact))
    print_row("real time over mean step", "%.2f" % (step_ms / statistics.mean(contact_ms)))


def read_json(folder, name):
    with open(os.path.join(folder, name)) as stream:
        return json.load(stream)


def main():
    folder = sys.argv[1]
    runs = {"from the bag, as fast as possible": read_json(folder, "palpation.json"),
            "the same without the nodule": read_json(folder, "without_nodule.json")}
    for title, run in runs.items():
        print_run(title, run)
    print_map(read_json(folder, "palpation_map.json"))
    time_step_s = next(iter(runs.values()))["time_step_s"]
    live = {"live_markers.bag": "live, markers to a subscriber that counts them",
            "live_rviz.bag": "live, markers to it and to rviz, which shares the processors"}
    for name, title in live.items():
        path = os.path.join(folder, name)
        if os.path.exists(path):
            print_live(title, path, time_step_s)
    if os.path.exists(os.path.join(folder, "logs", "markers.log")):
        print_row("markers", "%.1f arrays a second" % marker_rate(os.path.join(folder, "logs", "markers.log")))
    print("in %s: %s" % (folder, ", ".join(sorted(
        name for name in os.listdir(folder) if os.path.isfile(os.path.join(folder, name))))))
    for title, run in runs.items():
        if not run["finite"] or run["steps_held"] > 0:
            sys.exit("demo_summary.py: %s: the run was not sound: see above" % title)


if __name__ == "__main__":
    main()
