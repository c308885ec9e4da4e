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
LONGEST_ARRAY = 4
MOST_FLIPS = 8


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


def spoilt(data, source):
    """One of: as it is, bits flipped, cut, padded, all at random."""
    way = source.randrange(5)
    data = bytearray(data)
    if way == 1 and data:
        for _ in range(source.randint(1, MOST_FLIPS)):
            data[source.randrange(len(data))] ^= 1 << source.randrange(8)
    elif way == 2:
        del data[source.randint(0, len(data)):]
    elif way == 3:
        data += bytes(source.getrandbits(8) for _ in range(source.randint(1, 64)))
    elif way == 4:
        data = bytearray(source.getrandbits(8) for _ in range(len(data)))
    return bytes(data)


def raw_class(message_class):
    """A message class of the same type and sum whose content is bytes, whatever they are."""
    class Raw(genpy.Message):
        __slots__ = ["data"]
        _slot_types = ["uint8[]"]
        _type = message_class._type
        _md5sum = message_class._md5sum
        _full_text = message_class._full_text if hasattr(message_class, "_full_text") else ""
        _has_header = False

        def serialize(self, stream):
            stream.write(self.data)

    return Raw


def random_source(seed):
    return random.Random(seed)
