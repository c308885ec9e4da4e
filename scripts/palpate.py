#!/usr/bin/env python3
"""Palpates a lobe: commands a probe, or writes the commands to a bag, in a raster of presses.

Every press goes along the local normal of the undeformed surface, to the same depth below the place
where the round tip first touches, is held there and taken back: differences in force are then
differences in the tissue. The poses are those of the tip, its z axis pointing back along the probe.
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
    parser.add_argument("--region", type=float, nargs=4, default=(-0.030, 0.018, -0.015, 0.021),
                        metavar=("X0", "X1", "Y0", "Y1"), help="where to press, m")
    parser.add_argument("--depth_m", type=float, default=0.005, help="depth of a press")
    parser.add_argument("--radius_m", type=float, default=0.005, help="radius of the round tip")
    parser.add_argument("--clearance_m", type=float, default=0.001,
                        help="height above the surface from which a press starts")
    parser.add_argument("--press_s", type=float, default=0.2, help="time of a press down")
    parser.add_argument("--hold_s", type=float, default=0.1, help="time at full depth")
    parser.add_argument("--release_s", type=float, default=0.1, help="time of the way back up")
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
    corners = nodes[triangles]
    near = np.all((corners[:, :, :2].min(axis=1) <= xy.max(axis=0)) &
                  (corners[:, :, :2].max(axis=1) >= xy.min(axis=0)), axis=1)
    for a, b, c in corners[near]:
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


def disc(radius):
    """Points (P x 2) spread over a disc around the origin."""
    offsets = np.linspace(-radius, radius, 17)
    points = np.array(list(itertools.product(offsets, offsets)))
    return points[np.sum(points**2, axis=1) <= radius**2]


def touch_height(nodes, triangles, xy, radius):
    """Height of the lowest point of a ball, coming down at (x, y), when it first touches the surface."""
    under = disc(radius)
    heights = height(nodes, triangles, xy + under)
    return np.max(heights - (radius - np.sqrt(radius**2 - np.sum(under**2, axis=1))))


def surface_point(nodes, triangles, xy, radius):
    """The surface's highest point at (x, y), and the normal of the plane that fits it best around."""
    z = height(nodes, triangles, xy[np.newaxis])[0]
    if not np.isfinite(z):
        raise ValueError("there is no surface at x = %g m, y = %g m" % tuple(xy))
    around = disc(radius)
    heights = height(nodes, triangles, xy + around)
    hit = np.isfinite(heights)
    table = np.column_stack((around[hit], np.ones(np.count_nonzero(hit))))
    slope_x, slope_y, _ = np.linalg.lstsq(table, heights[hit], rcond=None)[0]
    normal = np.array([-slope_x, -slope_y, 1.0])
    return np.append(xy, z), normal / np.linalg.norm(normal)


def turn_to(normal):
    """Quaternion (x, y, z, w) of the shortest turn of the z axis to a normal that points upwards."""
    turn = np.array([-normal[1], normal[0], 0.0, 1.0 + normal[2]])
    return turn / np.linalg.norm(turn)


def matrix(turn):
    """Rotation matrix of a unit quaternion."""
    x, y, z, w = turn
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def touch(nodes, triangles, xy, radius):
    """Position of a round tip that comes along the normal at (x, y) when it first touches, and its turn."""
    point, normal = surface_point(nodes, triangles, xy, 2.0 * radius)
    turn = turn_to(normal)
    axes = matrix(turn)  # columns: the tip's axes
    place = point @ axes
    place[2] = touch_height(nodes @ axes, triangles, place[:2], radius)
    return axes @ place, turn


def raster(region, grid):
    """Points row by row, every other row backwards."""
    xs = np.linspace(region[0], region[1], grid[0])
    ys = np.linspace(region[2], region[3], grid[1])
    for row, y in enumerate(ys):
        for x in xs if row % 2 == 0 else xs[::-1]:
            yield np.array([x, y])


def palpation_path(arguments, nodes, triangles):
    """Way points (time, position, quaternion) of the tip, to be joined by straight lines.

    It begins and ends high above the first press, so that it can be repeated.
    """
    way = []

    def move(position, turn, duration=0.0):
        if way:
            distance = np.linalg.norm(position - way[-1][1:4])
            duration = max(duration, distance / arguments.travel_m_per_s, 0.01)
        way.append(np.concatenate(([way[-1][0] + duration if way else 0.0], position, turn)))

    def lifted(position):
        return np.append(position[:2], nodes[:, 2].max() + 0.01)

    for xy in raster(arguments.region, arguments.grid):
        tip, turn = touch(nodes, triangles, xy, arguments.radius_m)
        outwards = matrix(turn)[:, 2]
        ready, deep = tip + arguments.clearance_m * outwards, tip - arguments.depth_m * outwards
        if not way:
            move(lifted(ready), turn)
        move(ready, turn)
        move(deep, turn, arguments.press_s)
        move(deep, turn, arguments.hold_s)
        move(ready, turn, arguments.release_s)
    move(lifted(way[-1][1:4]), way[-1][4:])
    move(way[0][1:4], way[0][4:])
    return np.array(way)


def poses(arguments, way):
    """Time from the start and pose of every command, without its stamp."""
    for number, time in enumerate(np.arange(0.0, way[-1, 0], 1.0 / arguments.rate_hz)):
        message = PoseStamped()
        message.header.seq = number
        message.header.frame_id = "world"
        at = np.array([np.interp(time, way[:, 0], column) for column in way.T[1:]])
        turn = at[3:] / np.linalg.norm(at[3:])
        for target, axes, values in ((message.pose.position, "xyz", at[:3]),
                                     (message.pose.orientation, "xyzw", turn)):
            for axis, value in zip(axes, values):
                setattr(target, axis, float(value))
        yield time, message


def write_bag(arguments, way):
    """Writes the commands without stamps, which means: now. So the bag can be played live, over and over."""
    start = 1.0  # a bag holds no time of zero
    count = 0
    with rosbag.Bag(arguments.out, "w", compression=rosbag.Compression.LZ4) as bag:
        for time, message in poses(arguments, way):
            bag.write(arguments.topic, message, rospy.Time.from_sec(start + time))
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
