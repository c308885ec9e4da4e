"""Octrees as liboctomap writes them, by what its file formats say: nothing here is shared with what is tested."""
import struct

DEPTH = 16
MIDDLE = 1 << (DEPTH - 1)
UNKNOWN, FREE, OCCUPIED, INNER = 0, 1, 2, 3


def encode_binary(cells):
    """Two bits a child, children by x, y, z from the lowest bit on; cells: set of (x, y, z), occupied."""
    data = bytearray()

    def write(keys, depth):
        level = DEPTH - depth - 1
        children = [[] for _ in range(8)]
        for key in keys:
            children[sum((key[axis] >> level & 1) << axis for axis in range(3))].append(key)
        pairs = 0
        for number, child in enumerate(children):
            pairs |= (UNKNOWN if not child else OCCUPIED if level == 0 else INNER) << 2 * number
        data.extend(struct.pack("<H", pairs))
        for child in children:
            if child and level > 0:
                write(child, depth + 1)

    if cells:
        write([tuple(i + MIDDLE for i in cell) for cell in cells], 0)
    return struct.unpack("%db" % len(data), bytes(data))


def decode(message):
    """(occupied, free): sets of finest cells."""
    data = struct.pack("%db" % len(message.data), *message.data)
    found = {FREE: set(), OCCUPIED: set()}
    at = 0

    def take(layout):
        nonlocal at
        values = struct.unpack_from(layout, data, at)
        at += struct.calcsize(layout)
        return values

    def fill(low, depth, state):
        side = 1 << (DEPTH - depth)
        assert side <= 64, "a leaf larger than what is sent here"
        for z in range(side):
            for y in range(side):
                for x in range(side):
                    found[state].add((low[0] + x - MIDDLE, low[1] + y - MIDDLE, low[2] + z - MIDDLE))

    def corner(low, depth, number):
        side = 1 << (DEPTH - depth - 1)
        return tuple(low[axis] + (side if number >> axis & 1 else 0) for axis in range(3))

    def read_binary(low, depth):
        pairs, = take("<H")
        for number in range(8):
            state = pairs >> 2 * number & 3
            if state in found:
                fill(corner(low, depth, number), depth + 1, state)
        for number in range(8):
            if pairs >> 2 * number & 3 == INNER:
                read_binary(corner(low, depth, number), depth + 1)

    def read_full(low, depth):
        log_odds, children = take("<fB")
        if children == 0:
            fill(low, depth, OCCUPIED if log_odds >= 0 else FREE)
        for number in range(8):
            if children >> number & 1:
                read_full(corner(low, depth, number), depth + 1)

    if data:
        (read_binary if message.binary else read_full)((0, 0, 0), 0)
    assert at == len(data)
    return found[OCCUPIED], found[FREE]
