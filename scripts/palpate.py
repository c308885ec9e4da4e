#!/usr/bin/env python3
"""Palpates a lobe: commands a probe, or writes the commands to a bag, in a raster of presses, each from above, held,
and taken back.

Every press goes the same depth below the height at which the round tip first touches the undeformed
surface, so that differences in force are differences in the tissue.
"""
import argparse
import itertools
import os
import sys

import numpy as np
import rosbag
import rospy
from geometry_msgs.msg import PoseStamped


def default_mesh():
    import rospkg
    package = rospkg.RosPack().get_path("soft_tissue_sim")
    return os.path.join(package, "config", "meshes", "lobe_5k.msh")


def parse_arguments():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--out", help="bag to write; without one the commands are published, over and over")
    parser.add_argument("--mesh", default=None,
                        help="Gmsh 2.2 ASCII mesh in metres; default: the package's lobe_5k.msh")
    parser.add_argument("--topic", default="/sim_node/probe/servo_cp", help="topic of the poses")
    parser.add_argument("--grid", type=int, nargs=2, default=(9, 7), metavar=("NX", "NY"),
                        help="presses along x and y")
    parser.add_argument("--region", type=float, nargs=4, default=(-0.032, 0.032, -0.024, 0.024),
                        metavar=("X0", "X1", "Y0", "Y1"), help="where to press, m")
    parser.add_argument("--depth_m", type=float, default=0.004, help="depth of a press")
    parser.add_argument("--radius_m", type=float, default=0.004, help="radius of the round tip")
    parser.add_argument("--tip_below_origin_m", type=float, default=0.014,
                        help="how far the tip's lowest point lies below the tool frame")
    parser.add_argument("--clearance_m", type=float, default=0.002,
                        help="height above the surface from which a press starts")
    parser.add_argument("--press_s", type=float, default=0.3, help="time of a press down or up")
    parser.add_argument("--hold_s", type=float, default=0.1, help="time at full depth")
    parser.add_argument("--travel_m_per_s", type=float, default=0.1, help="speed between presses")
    parser.add_argument("--rate_hz", type=float, default=200.0, help="poses a second")
    return parser.parse_args(rospy.myargv()[1:])


def read_gmsh(path):
    """Nodes (N x 3) and tets (M x 4, from 0) of a Gmsh 2.2 ASCII file."""
    with open(path) as stream:
        lines = stream.read().split("\n")
    if not lines[1].startswith("2.2 0"):
        raise ValueError("%s: is not Gmsh 2.2 ASCII" % path)
    start = lines.index("$Nodes") + 1
    count = int(lines[start])
    table = np.array([line.split() for line in lines[start + 1:start + 1 + count]], dtype=float)
    place = {int(number): i for i, number in enumerate(table[:, 0])}
    start = lines.index("$Elements") + 1
    tets = []
    for line in lines[start + 1:start + 1 + int(lines[start])]:
        fields = [int(field) for field in line.split()]
        if fields[1] == 4:
            tets.append([place[node] for node in fields[-4:]])
    return table[:, 1:4], np.array(tets)


def surface_triangles(tets):
    """Faces that belong to one tet only (K x 3)."""
    faces = np.concatenate([tets[:, list(face)] for face in
                            ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))])
    _, first, counts = np.unique(np.sort(faces, axis=1), axis=0, return_index=True,
                                 return_counts=True)
    return faces[first[counts == 1]]


def height(nodes, triangles, xy):
    """Highest z of the surface above or below each of some points (P x 2); -inf beside it."""
    found = np.full(len(xy), -np.inf)
    for a, b, c in nodes[triangles]:
        ab, ac = b - a, c - a
        area = ab[0] * ac[1] - ab[1] * ac[0]
        if abs(area) < 1e-18:
            continue
        d = xy - a[:2]
        v = (d[:, 0] * ac[1] - d[:, 1] * ac[0]) / area
        w = (ab[0] * d[:, 1] - ab[1] * d[:, 0]) / area
        inside = (v >= -1e-9) & (w >= -1e-9) & (v + w <= 1.0 + 1e-9)
        z = a[2] + v * ab[2] + w * ac[2]
        found = np.where(inside & (z > found), z, found)
    return found


def touch_height(nodes, triangles, x, y, radius):
    """Height of the lowest point of a ball, coming down at (x, y), when it first touches the surface."""
    offsets = np.linspace(-radius, radius, 17)
    dx, dy = (grid.ravel() for grid in np.meshgrid(offsets, offsets))
    squared = dx**2 + dy**2
    under = squared <= radius**2
    dx, dy, squared = dx[under], dy[under], squared[under]
    heights = height(nodes, triangles, np.column_stack((x + dx, y + dy)))
    return np.max(heights - (radius - np.sqrt(radius**2 - squared)))


def raster(region, grid):
    """Points row by row, every other row backwards."""
    xs = np.linspace(region[0], region[1], grid[0])
    ys = np.linspace(region[2], region[3], grid[1])
    for row, y in enumerate(ys):
        for x in xs if row % 2 == 0 else xs[::-1]:
            yield float(x), float(y)


def palpation_path(arguments, nodes, triangles):
    """Way points (time, x, y, z of the tip's lowest point) to be joined by straight lines."""
    top = nodes[:, 2].max() + 0.005
    way = []
    time = 0.0
    for x, y in raster(arguments.region, arguments.grid):
        touch = touch_height(nodes, triangles, x, y, arguments.radius_m)
        if not np.isfinite(touch):
            raise ValueError("there is no surface at x = %g m, y = %g m" % (x, y))
        ready = touch + arguments.clearance_m
        if way:
            _, last_x, last_y, last_z = way[-1]
            time += max(np.hypot(x - last_x, y - last_y) / arguments.travel_m_per_s, 0.01)
        way.append((time, x, y, top))
        for z, duration in ((ready, (top - ready) / arguments.travel_m_per_s),
                            (touch - arguments.depth_m, arguments.press_s),
                            (touch - arguments.depth_m, arguments.hold_s),
                            (ready, arguments.press_s),
                            (top, (top - ready) / arguments.travel_m_per_s)):
            time += max(duration, 0.01)
            way.append((time, x, y, z))
    return np.array(way)


def poses(arguments, way):
    """Time from the start and pose of every command, without its stamp."""
    for number, time in enumerate(np.arange(0.0, way[-1, 0], 1.0 / arguments.rate_hz)):
        message = PoseStamped()
        message.header.seq = number
        message.header.frame_id = "world"
        position = message.pose.position
        position.x, position.y, position.z = (np.interp(time, way[:, 0], way[:, axis])
                                              for axis in (1, 2, 3))
        position.z += arguments.tip_below_origin_m
        message.pose.orientation.w = 1.0
        yield time, message


def write_bag(arguments, way):
    start = 1.0  # stamps of zero would mean "now"
    count = 0
    with rosbag.Bag(arguments.out, "w", compression=rosbag.Compression.LZ4) as bag:
        for time, message in poses(arguments, way):
            message.header.stamp = rospy.Time.from_sec(start + time)
            bag.write(arguments.topic, message, message.header.stamp)
            count += 1
    return count


def publish(arguments, way):
    rospy.init_node("palpate")
    publisher = rospy.Publisher(arguments.topic, PoseStamped, queue_size=1)
    rate = rospy.Rate(arguments.rate_hz)
    for _, message in itertools.chain.from_iterable(poses(arguments, way) for _ in itertools.count()):
        if rospy.is_shutdown():
            return
        message.header.stamp = rospy.Time.now()
        publisher.publish(message)
        rate.sleep()


def main():
    arguments = parse_arguments()
    mesh = arguments.mesh or default_mesh()
    try:
        nodes, tets = read_gmsh(mesh)
        way = palpation_path(arguments, nodes, surface_triangles(tets))
        presses = "%d presses of %g mm in %.1f s" % (arguments.grid[0] * arguments.grid[1],
                                                     1e3 * arguments.depth_m, way[-1, 0])
        if arguments.out:
            count = write_bag(arguments, way)
            print("%s: %d poses, %s" % (arguments.out, count, presses))
        else:
            print("%s: %s, over and over" % (arguments.topic, presses))
            publish(arguments, way)
    except rospy.ROSInterruptException:
        pass
    except (OSError, ValueError) as error:
        sys.exit("palpate.py: %s" % error)


if __name__ == "__main__":
    main()
