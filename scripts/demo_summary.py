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


def read_live(path):
    """Real-time factors and step times while in contact, and how many stats there were."""
    with open(path, newline="") as stream:
        rows = [row for row in csv.DictReader(stream) if row.get("field.state_hash")]
    contact = [row for row in rows if int(row["field.contacts"]) > 0]
    factors = [float(row["field.real_time_factor"]) for row in rows]
    return factors, [float(row["field.step_ms"]) for row in contact]


def print_live(path):
    factors, contact_ms = read_live(path)
    if not factors or not contact_ms:
        sys.exit("demo_summary.py: %s: no step in contact" % path)
    print("live, with rviz on this machine")
    print_row("real-time factor", "%.2f median, %.2f least" % (statistics.median(factors), min(factors)))
    print_row("step in contact", "%.2f ms median, %.2f ms longest" %
              (statistics.median(contact_ms), max(contact_ms)))


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
    live = os.path.join(folder, "live_stats.csv")
    if os.path.exists(live):
        print_live(live)
    print("in %s: %s" % (folder, ", ".join(sorted(
        name for name in os.listdir(folder) if os.path.isfile(os.path.join(folder, name))))))
    for title, run in runs.items():
        if not run["finite"] or run["steps_held"] > 0:
            sys.exit("demo_summary.py: %s: the run was not sound: see above" % title)


if __name__ == "__main__":
    main()
