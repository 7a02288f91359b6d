"""Tables, codecs and values of .froth assets, for froth_reader.py; written from docs/FORMAT.md alone."""
import struct

import numpy as np
import zstandard

MAX_INDEX = 2**24 - 1
MAX_WINDOW = 1 << 23
CODEC_STORED, CODEC_ZSTD, CODEC_PLANES, CODEC_DELTA, CODEC_MORTON, CODEC_DRACO = range(6)


class NotHere(Exception):
    """What the page describes and this reader leaves out."""


def need(condition, message):
    if not condition:
        raise ValueError(message)


# ---- FlatBuffers


class Table:
    def __init__(self, buffer, position):
        self.buffer, self.position = buffer, position
        vtable = position - struct.unpack_from("<i", buffer, position)[0]
        size = struct.unpack_from("<H", buffer, vtable)[0]
        self.offsets = struct.unpack_from(f"<{(size - 4) // 2}H", buffer, vtable + 4)

    def place(self, field):
        offset = self.offsets[field] if field < len(self.offsets) else 0
        return self.position + offset if offset else None

    def scalar(self, field, code, default):
        place = self.place(field)
        return default if place is None else struct.unpack_from("<" + code, self.buffer, place)[0]

    def target(self, field):
        place = self.place(field)
        return None if place is None else place + struct.unpack_from("<I", self.buffer, place)[0]

    def table(self, field):
        target = self.target(field)
        return None if target is None else Table(self.buffer, target)

    def text(self, field):
        target = self.target(field)
        if target is None:
            return None
        size = struct.unpack_from("<I", self.buffer, target)[0]
        return bytes(self.buffer[target + 4 : target + 4 + size]).decode()

    def structs(self, field, dtype, is_optional=False):
        target = self.target(field)
        if target is None and is_optional:
            return np.zeros(0, dtype)
        need(target is not None, f"manifest field {field} is missing")
        count = struct.unpack_from("<I", self.buffer, target)[0]
        return np.frombuffer(self.buffer, dtype, count, target + 4)


CHUNK = np.dtype([("origin", "<f8", 3), ("cells", "<u8"), ("live", "<u8"), ("ghosts", "<u8"), ("pairs", "<u8"),
                  ("lobes", "<u8"), ("low", "<f8", 3), ("high", "<f8", 3)])
SECTION = np.dtype([("type", "<u4"), ("chunk", "<u4"), ("flags", "<u2"), ("codec", "<u2"), ("element", "<u2"),
                    ("reserved0", "<u2"), ("base", "<u4"), ("reserved1", "<u4"), ("offset", "<u8"), ("stored", "<u8"),
                    ("raw", "<u8"), ("hash", "<u8")])
BOX = np.dtype([("low", "<f8", 3), ("high", "<f8", 3)])
CHUNK_LEVEL = np.dtype([("level", "<u4"), ("made_by", "<u4"), ("in", "<u4"), ("borders", "<u4")])
GROUP = np.dtype([("centre", "<f8", 3), ("radius", "<f8"), ("error", "<f8"), ("level", "<u4"), ("reserved", "<u4")])
assert CHUNK.itemsize == 112 and SECTION.itemsize == 56 and BOX.itemsize == 48
assert CHUNK_LEVEL.itemsize == 16 and GROUP.itemsize == 48


# ---- Codecs


def unfold(numbers):
    """0, 1, 2, 3, 4 ... -> 0, -1, 1, -2, 2 ..., modulo the width of the unsigned numbers."""
    one = numbers.dtype.type(1)
    return np.where(numbers & one, ~(numbers >> one), numbers >> one)


def decode_frames(stored, sizes):
    """The contents of one frame after the other."""
    contents = []
    for size in sizes:
        content, stored = decode_frame(stored, size)
        contents.append(content)
    need(not any(stored), "bytes after the last frame")
    return contents


def decode_frame(stored, size):
    """Its content, and what follows it."""
    frame = zstandard.get_frame_parameters(stored)
    need(frame.content_size == size, f"frame of {frame.content_size} bytes, expected {size}")
    need(frame.window_size <= MAX_WINDOW and frame.dict_id == 0, "frame wants a large window or a dictionary")
    decoder = zstandard.ZstdDecompressor().decompressobj()
    raw = decoder.decompress(stored)
    need(len(raw) == size and decoder.eof, "a frame that does not end")
    return raw, decoder.unused_data


def join_planes(frames, dtype):
    planes = np.stack([np.frombuffer(plane, np.uint8) for plane in frames])
    return np.ascontiguousarray(planes.T).view(dtype).ravel()


def join_green(colours):
    """Green, red - green, blue - green to red, green, blue; bytes modulo 256."""
    green = colours[:, 0]
    return np.stack([colours[:, 1] + green, green, colours[:, 2] + green], axis=1)


def sums_within(numbers, counts):
    """Running sums that begin anew with each of the groups, which have `counts` numbers."""
    sums = np.cumsum(numbers, dtype=np.int64)
    first = np.cumsum(counts) - counts
    before = np.concatenate([[0], sums])[first]
    return sums - np.repeat(before, counts)


def decode_morton(stored, entries):
    least, *planes = decode_frames(stored, [12] + 8 * [entries])
    least = np.frombuffer(least, "<u4", 3)
    codes = np.cumsum(unfold(join_planes(planes, "<u8")), dtype=np.uint64)
    points = np.zeros((entries, 3), np.uint32)
    for axis in range(3):
        for bit in range(21):
            points[:, axis] |= ((codes >> np.uint64(3 * bit + axis)) & np.uint64(1)).astype(np.uint32) << np.uint32(bit)
    return (points + least).ravel()


def decode(stored, codec, element, entries, components):
    """Unsigned elements, entries after entries."""
    count, dtype = entries * components, np.dtype(f"<u{element}")
    if codec == CODEC_STORED:
        return np.frombuffer(stored, dtype)
    if codec == CODEC_ZSTD:
        return np.frombuffer(decode_frames(stored, [count * element])[0], dtype)
    if codec == CODEC_MORTON:
        need(element == 4 and components == 3, "Morton delta of something that is no position")
        return decode_morton(stored, entries)
    if codec == CODEC_DRACO:
        raise NotHere("Draco sections are not in this reader")
    need(codec in (CODEC_PLANES, CODEC_DELTA), "unknown codec")
    elements = join_planes(decode_frames(stored, components * element * [entries]), dtype)
    if codec == CODEC_DELTA:
        elements = np.cumsum(unfold(elements).reshape(entries, components), axis=0, dtype=dtype).ravel()
    return elements


# ---- Values


def signed(elements):
    n = elements.astype(np.int64)
    return np.where(n & 1, -((n + 1) >> 1), n >> 1)


def on_lattice(step, numbers):
    need(np.all(np.abs(numbers) <= MAX_INDEX), "a lattice index is out of range")
    return (np.float64(step) * numbers).astype(np.float32)


def truncated_floats(numbers, bits):
    need(np.all(numbers < 2 ** (8 + bits)), "a mantissa is out of range")
    return (numbers.astype(np.uint32) << np.uint32(23 - bits)).view(np.float32)


def quaternions(indices, bits):
    h = float(2 ** (bits - 1) - 1)
    need(np.all(indices <= 2**bits - 2), "a normal is out of range")
    y, z = (indices[:, 0] - h) / h, (indices[:, 1] - h) / h
    x = 1 - np.abs(y) - np.abs(z)

    def sign(v):
        return np.where(v < 0, -1.0, 1.0)

    folded_y, folded_z = (1 - np.abs(z)) * sign(y) + 0.0, (1 - np.abs(y)) * sign(z) + 0.0
    y, z = np.where(x < 0, folded_y, y), np.where(x < 0, folded_z, z)
    length = np.sqrt((x * x + y * y) + z * z)
    x, y, z = x / length, y / length, z / length
    w = np.sqrt((1 + np.abs(x)) / 2)
    s = 0.5 / w
    zero = np.zeros_like(x)
    front = np.stack([w, zero, z * s, -y * s], axis=1)
    back = np.stack([-y * s, z * s, zero, w], axis=1)
    return np.where((x >= 0)[:, None], front, back).astype(np.float32)
