"""Bytes on the wire that no honest program sends: random fields, flipped bits, cut and padded messages."""
import io
import random
import struct

import genpy
import roslib.message

NUMBERS = {"int8": "b", "uint8": "B", "byte": "b", "char": "B", "int16": "h", "uint16": "H", "int32": "i",
           "uint32": "I", "int64": "q", "uint64": "Q", "float32": "f", "float64": "d", "bool": "B"}
ODD_FLOATS = (0.0, -0.0, 1.0, 0.03, 0.7071067811865476, 1e-310, 1e308, -1e308, float("nan"), float("inf"),
              float("-inf"))
ODD_STRINGS = ("", "world", "probe", "/world", "no such frame", "\u00e9\u00e8", "a" * 3000, "../../x", "%s%n", "\0")
ODD_BYTES = [struct.pack("<d", number) for number in ODD_FLOATS] + [
    struct.pack("<I", number) for number in (0, 1, 2**32 - 1, 2**31, 10**6, 10**9, 2**28 + 1)]
LONGEST_ARRAY = 4
MOST_FLIPS = 8
MOST_NOISE = 400
POOL = 200
HONEST_SHARE = 4  # of those that are not


def random_number(kind, source):
    if kind.startswith("float"):
        number = source.choice(ODD_FLOATS) if source.random() < 0.5 else source.uniform(-0.1, 0.1)
        return number if kind == "float64" or abs(number) < 3e38 else float("inf")
    bits = 8 * struct.calcsize(NUMBERS[kind])
    if kind == "bool":
        return source.random() < 0.5
    low, high = (0, 2**bits - 1) if kind[0] in "uc" else (-2**(bits - 1), 2**(bits - 1) - 1)
    return source.choice((0, 1, low, high, source.randint(low, high)))


def random_value(kind, source):
    """Something of a type as a .msg file names it."""
    if kind.endswith("]"):
        base, length = kind[:-1].split("[")
        count = int(length) if length else source.randint(0, LONGEST_ARRAY)
        return [random_value(base, source) for _ in range(count)]
    if kind in NUMBERS:
        return random_number(kind, source)
    if kind == "string":
        return source.choice(ODD_STRINGS)
    if kind == "time":
        return genpy.Time(*source.choice(((0, 0), (2**32 - 1, 10**9 - 1), (source.randint(0, 2**32 - 1), 5))))
    if kind == "duration":
        return genpy.Duration(source.randint(-2**31, 2**31 - 1), 0)
    return random_message(roslib.message.get_message_class("std_msgs/Header" if kind == "Header" else kind), source)


def random_message(message_class, source):
    message = message_class()
    for slot, kind in zip(message.__slots__, message._slot_types):
        setattr(message, slot, random_value(kind, source))
    return message


def serialized(message):
    stream = io.BytesIO()
    message.serialize(stream)
    return stream.getvalue()


def flipped(data, source):
    data = bytearray(data)
    for _ in range(source.randint(1, MOST_FLIPS) if data else 0):
        data[source.randrange(len(data))] ^= 1 << source.randrange(8)
    return bytes(data)


def overwritten(data, source):
    """A number that is odd, or a length that can't be, wherever it lands."""
    odd = source.choice(ODD_BYTES)
    at = source.randrange(len(data) + 1)
    return (data[:at] + odd + data[at + len(odd):])[:max(len(data), at)]


class Spoiler:
    """Spoilt messages of a class, one after the other, the same ones for the same seed.

    They come from a pool: making each of its own takes a thousand times as long as spoiling one. `honest` ones are
    those that a node takes; a message with one bit off gets further than noise.
    """

    def __init__(self, message_class, seed, honest=()):
        self.source = random.Random(seed)
        pool = [serialized(random_message(message_class, self.source)) for _ in range(POOL)]
        self.pool = pool + [serialized(message) for message in honest] * (POOL // HONEST_SHARE)

    def next(self):
        """One of: as it is, bits flipped, odd numbers in it, cut, padded, mixed with another, noise."""
        source = self.source
        data = source.choice(self.pool)
        way = source.randrange(7)
        if way == 1:
            return flipped(data, source)
        if way == 2:
            return overwritten(data, source)
        if way == 3:
            return data[:source.randrange(len(data) + 1)]
        if way == 4:
            return data + source.randbytes(source.randint(1, 64))
        if way == 5:
            return data[:source.randrange(len(data) + 1)] + source.choice(self.pool)[source.randrange(len(data) + 1):]
        if way == 6:
            return source.randbytes(min(len(data), MOST_NOISE))
        return data
