"""An independent reader of .froth assets, written from docs/FORMAT.md alone: numpy, zstandard and xxhash, no code of Froth.

Asset(bytes).read_chunk(index, layer) gives a dictionary of arrays.
"""
import struct

import numpy as np
import xxhash

from froth_codecs import (
    BOX, CHUNK, CHUNK_LEVEL, decode, GROUP, join_green, MAX_INDEX, need, on_lattice, quaternions, SECTION, signed, sums_within, Table,
    truncated_floats)

SHARED = 0xFFFFFFFF  # the chunk of shared sections
NO_GROUP = 0xFFFFFFFF
MOST = 2.0**50  # of every float but densities and orientations


def within(values, most):
    return bool(np.all(np.abs(np.asarray(values, np.float64)) <= most))  # False for NaN


# ---- Graph


def square(v):
    return (v[..., 0] * v[..., 0] + v[..., 1] * v[..., 1]) + v[..., 2] * v[..., 2]


class GraphDecoder:
    MOST_PAIRS = 32  # of a cell whose pairs propose candidates

    def __init__(self, sites, radii, cells, live, has_walk_graph):
        self.p, self.r = sites.astype(np.float64), radii.astype(np.float64)
        self.cells, self.live, self.has_walk_graph = cells, live, has_walk_graph

    def candidates(self, i, before, kept):
        proposed = {j for a in before for j in kept[a] if j > i}
        if not proposed:
            return []
        c = np.array(sorted(proposed))
        key = square(self.p[c] - self.p[i]) - self.r[c] * self.r[c]
        return c[np.lexsort((c, key))].tolist()

    def pairs(self, counts, deltas):
        """The larger sites of each cell's pairs, in the order of its deltas."""
        before = [[] for _ in range(len(self.p))]  # cells whose pairs propose candidates for this one
        kept, cursor, degrees = [], 0, np.zeros(len(self.p), np.int64)
        for i in range(self.cells):
            order, place, mine = self.candidates(i, before[i], kept), -1, []
            for delta in deltas[cursor : cursor + counts[i]].tolist():
                place += delta + 1
                j = order[place] if place < len(order) else i + 1 + place - len(order)
                need(j < len(self.p) and (place < len(order) or j not in order), f"cell {i}: a place of no site")
                mine.append(j)
            cursor += counts[i]
            kept.append(mine)
            degrees[i] += len(mine)
            degrees[mine] += 1
            if len(mine) <= self.MOST_PAIRS:
                for j in mine:
                    before[j].append(i)
        need(cursor == len(deltas), "counts do not add up to the pairs")
        need(degrees.max() <= 65535 and (degrees * degrees).sum() <= 2**32 + 2**12 * len(degrees), "too many neighbours")
        return kept

    def are_alpha(self, kept, alpha_bits):
        first = np.repeat(np.arange(self.cells), [len(mine) for mine in kept])
        second = np.array([j for mine in kept for j in mine], np.int64)
        if not self.has_walk_graph:
            return first, second, np.ones(len(first), bool)
        reach = self.r[first] + self.r[second]
        expected = (first < self.live) & (square(self.p[second] - self.p[first]) < reach * reach)
        bits = np.unpackbits(alpha_bits, bitorder="little")
        need(not bits[len(first) :].any(), "bits behind the last pair")
        alpha = expected ^ bits[: len(first)].astype(bool)
        need(not np.any(alpha & (first >= self.live)), "an alpha pair of a cell that is not live")
        return first, second, alpha

    def rows(self, counts, deltas, alpha_bits):
        first, second, alpha = self.are_alpha(self.pairs(counts.tolist(), deltas), alpha_bits)
        back = second < self.cells
        i, j = np.concatenate([first, second[back]]), np.concatenate([second, first[back]])
        alpha = np.concatenate([alpha, alpha[back]]) & (i < self.live)
        if not self.has_walk_graph:
            i, j, alpha = i[alpha], j[alpha], alpha[alpha]
        d = square(self.p[j] - self.p[i])
        m = 0.5 * (d + (self.r[i] - self.r[j]) * (self.r[i] + self.r[j]))
        order = np.lexsort((j, m / np.sqrt(d), ~alpha, i))
        ends = np.cumsum(np.bincount(i, minlength=self.cells))
        return {
            "neighbourOffsets": np.concatenate([[0], ends]).astype(np.uint32),
            "neighbours": j[order].astype(np.uint32),
            "alphaCounts": np.bincount(i[alpha], minlength=self.cells)[: self.live].astype(np.uint32),
        }


# ---- Asset


class Asset:
    def __init__(self, data):
        self.data = data
        magic, major, _, zero, size, begin, length, manifest_hash, zero2, header_hash = struct.unpack_from(
            "<8sHHIQQQQQQ", data)
        need(magic == b"\x89FROTH\r\n" and xxhash.xxh3_64_intdigest(data[:56]) == header_hash, "no asset, or damaged")
        need(major in (2, 3) and zero == 0 and zero2 == 0 and begin == 64 and size == len(data), "header is not of version 2 or 3")
        manifest = data[begin : begin + length]
        need(xxhash.xxh3_64_intdigest(manifest) == manifest_hash and manifest[4:8] == b"FRTH", "manifest is damaged")
        root = Table(manifest, struct.unpack_from("<I", manifest)[0])
        self.details = root.scalar(0, "I", 0)
        self.most_lobes = root.scalar(1, "I", 0)
        self.local_bits = root.scalar(2, "I", 32)
        self.has_walk_graph = bool(root.scalar(3, "B", 1))
        self.codebook_size = root.scalar(7, "I", 0)
        need(1 <= self.details <= 32 and self.most_lobes <= 32 and root.text(8) == "sRGB", "manifest")
        need(0 <= root.scalar(4, "f", 10) <= 2**20 and 0 <= root.scalar(5, "f", 4) <= 2**10, "sharpness or near ratio")
        need(0 <= root.scalar(6, "f", 0) <= MOST, "near depth")
        need(len(root.text(8)) + len(root.text(10)) + len(root.text(11) or "") <= length, "strings are too long")
        lattices = root.table(9)
        self.position_step = lattices.scalar(0, "d", 0)
        self.radius_bits, self.density_bits = lattices.scalar(1, "I", 23), lattices.scalar(2, "I", 23)
        self.normal_bits = lattices.scalar(3, "I", 0)
        self.detail_site_step, self.height_step, self.colour_step, self.lobe_axis_step = (
            lattices.scalar(field, "f", 0) for field in range(4, 8))
        self.read_eyes(root)
        self.chunks = root.structs(17, CHUNK)
        for chunk in self.chunks:
            need(within(chunk["origin"], MOST) and within(chunk["low"], 2 * MOST) and within(chunk["high"], 2 * MOST), "chunk")
        self.read_levels(root)
        self.sections = {}
        for record in root.structs(18, SECTION):
            need(record["flags"] >> 8 == 0 and record["reserved0"] == 0 and record["reserved1"] == 0, "reserved bits")
            key = int(record["chunk"]), int(record["type"])
            need(key not in self.sections, f"section {key} twice")
            self.sections[key] = record

    def read_levels(self, root):
        """The structs of levels and groups, or empty arrays, checked against each other."""
        self.levels = root.structs(20, CHUNK_LEVEL, is_optional=True)
        self.groups = root.structs(21, GROUP, is_optional=True)
        self.border_count = root.scalar(22, "I", 0)
        need((len(self.levels) == 0) == (len(self.groups) == 0), "levels and groups: both or neither")
        levels, groups = self.levels, self.groups
        need(self.border_count <= int(levels["borders"].astype(np.uint64).sum()), "more borders than the chunks hold")
        if len(levels) == 0:
            return
        need(len(levels) == len(self.chunks) and np.all(levels["borders"] <= self.chunks["cells"]), "levels of chunks")
        need(within(groups["centre"], MOST) and within(groups["radius"], 4 * MOST) and within(groups["error"], 4 * MOST)
             and np.all(groups["radius"] >= 0) and np.all(groups["error"] >= 0) and not groups["reserved"].any(), "groups")
        is_made, is_in = levels["made_by"] != NO_GROUP, levels["in"] != NO_GROUP
        need(np.array_equal(is_made, levels["level"] > 0), "made_by none and level 0 do not agree")
        for given, name, step in ((is_made, "made_by", 1), (is_in, "in", 0)):
            numbers = levels[name][given]
            need(np.all(numbers < len(groups)), f"{name} beyond the groups")
            need(np.array_equal(groups["level"][numbers] + step, levels["level"][given]), f"{name}: level of the group")
            need(len(np.unique(numbers)) == len(groups), f"{name}: a group without such chunks")
        both = is_made & is_in
        below, above = groups[levels["made_by"][both]], groups[levels["in"][both]]
        need(np.all(below["error"] < above["error"]), "errors do not grow")
        reach = np.sqrt(square(below["centre"] - above["centre"])) + below["radius"]
        size = above["radius"] + np.abs(above["centre"]).max(axis=1, initial=0)
        need(np.all(reach <= above["radius"] + 2.0**-40 * size), "a ball sticks out")
        floor = int((~is_in).sum())
        need(not is_in[:floor].any(), "the floor is not first")
        for part in (levels["level"][:floor], levels["level"][floor:]):
            need(np.all(part[1:] <= part[:-1]), "levels rise")

    def read_borders(self, index, out):
        count = int(self.levels["borders"][index]) if len(self.levels) else 0
        cells, _ = self.elements(index, 13, count, 1)
        numbers, _ = self.elements(index, 14, count, 1)
        need((cells is None) == (count == 0) and (numbers is None) == (count == 0), "borders without their sections")
        refs = out["ghostRefs"]
        if len(self.levels) and refs is not None:
            need(np.all(refs < self.border_count), "a ghost beyond the borders")
        if count == 0:
            return
        out["borderCells"], out["borderNumbers"] = cells.ravel(), numbers.ravel()
        ascending = out["borderCells"].astype(np.int64)
        need(np.all(ascending[1:] > ascending[:-1]) and ascending[-1] < self.chunks["cells"][index], "border cells")
        need(len(np.unique(numbers)) == count and np.all(numbers < self.border_count), "border numbers")
        need(refs is None or not np.isin(refs, numbers).any(), "a ghost is a border of its own chunk")

    def read_eyes(self, root):
        """The boxes [count x 2 x 3] and the radius of the region of eyes, or None."""
        eyes = root.table(19)
        self.eyes = None
        if eyes is None:
            return
        boxes, radius = eyes.structs(0, BOX), eyes.scalar(1, "d", 0)
        need(len(boxes) > 0 and within(boxes["low"], MOST) and within(boxes["high"], MOST), "eyes: boxes")
        need(np.all(boxes["low"] <= boxes["high"]), "eyes: a box is inverted")
        need(all(0 <= eyes.scalar(field, "d", 0) <= MOST for field in (1, 2, 3)), "eyes: radius or figures")
        self.eyes = np.stack([boxes["low"], boxes["high"]], axis=1), radius

    def elements(self, chunk, kind, entries, components):
        """Unsigned elements of a section as [entries x components], or None; and the section's base."""
        record = self.sections.get((chunk, kind))
        if record is None:
            return None, 0
        begin, stored_size, element = int(record["offset"]), int(record["stored"]), int(record["element"])
        need(begin + stored_size <= len(self.data), f"section {kind} of chunk {chunk} leaves the file")
        need(int(record["raw"]) == entries * components * element <= 256 * stored_size, f"section {kind}: raw size")
        stored = self.data[begin : begin + stored_size]
        need(xxhash.xxh3_64_intdigest(stored) == int(record["hash"]), f"section {kind} of chunk {chunk} is damaged")
        values = decode(stored, int(record["codec"]), element, entries, components)
        return values.reshape(entries, components), int(record["base"])

    def floats(self, chunk, kind, entries, components):
        values, _ = self.elements(chunk, kind, entries, components)
        return None if values is None else values.astype("<u4").view("<f4")

    def unsigned(self, chunk, kind, entries, components):
        values, base = self.elements(chunk, kind, entries, components)
        return None if values is None else (values.astype(np.int64) + base) % 2**32

    def signed(self, chunk, kind, entries, components):
        values, _ = self.elements(chunk, kind, entries, components)
        return None if values is None else signed(values)

    def positions(self, chunk, kind, entries):
        values, _ = self.elements(chunk, kind, entries, 3)
        if values is None:
            return np.zeros((0, 3), np.float32)
        if not self.position_step:
            return values.view("<f4")
        return on_lattice(self.position_step, values.view("<i4").astype(np.int64))

    def stepped(self, chunk, kind, entries, components, step):
        """Floats, or indices times a step."""
        if not step:
            return self.floats(chunk, kind, entries, components)
        numbers = self.signed(chunk, kind, entries, components)
        return None if numbers is None else on_lattice(step, numbers)

    def mantissas(self, chunk, kind, entries, bits):
        return truncated_floats(self.unsigned(chunk, kind, entries, 1), bits).ravel()

    def read_chunk(self, index, layer=2):
        chunk = self.chunks[index]
        n, live, ghosts = int(chunk["cells"]), int(chunk["live"]), int(chunk["ghosts"])
        out = {"origin": chunk["origin"].copy()}
        own, other = self.positions(index, 1, n), self.positions(index, 2, ghosts)
        out["sites"] = np.concatenate([own, other])
        out["radii"] = self.mantissas(index, 3, n + ghosts, self.radius_bits)
        refs, _ = self.elements(index, 4, ghosts, 1)
        out["ghostRefs"] = None if refs is None else refs.ravel()
        self.read_borders(index, out)
        out.update(self.read_graph(index, out["sites"], out["radii"]))
        if live:
            out["densities"] = self.mantissas(index, 8, live, self.density_bits)
            out["orientations"] = (quaternions(self.unsigned(index, 9, live, 2), self.normal_bits) if self.normal_bits
                                   else self.floats(index, 9, live, 4))
        colour_bytes, _ = self.elements(index, 10, live, 3)
        if colour_bytes is not None:
            colour_bytes = join_green(colour_bytes)
        height_numbers = self.signed(index, 11, live, 1) if self.height_step else None
        if colour_bytes is not None:
            out["cellColours"] = colour_bytes.astype(np.float32) / np.float32(255)
        out["cellHeights"] = self.stepped(index, 11, live, 1, self.height_step)
        solid_balls, _ = self.elements(index, 12, live, 4)
        if solid_balls is not None:
            need(np.all(solid_balls <= 64), "a solid ball is out of range")
            out["solidBalls"] = solid_balls.astype("u1")
        if layer == 0:
            out["detailSites"] = np.zeros((live, 2), np.float32)
            out["detailHeights"] = out["cellHeights"]
            if colour_bytes is not None:
                out["baseColours"] = out["cellColours"] - np.float32(0.5)
        else:
            self.read_details(index, live, colour_bytes, height_numbers, out)
        if layer >= 2 and self.most_lobes:
            self.read_lobes(index, live, int(chunk["lobes"]), out)
        out = {name: values for name, values in out.items() if values is not None and values.size}
        for name, values in out.items():
            if values.dtype == np.float32 and name not in ("densities", "orientations"):
                need(within(values, MOST), f"{name}: out of range")
        need(np.all(out["radii"] > 0), "a radius that is not positive")
        densities = out.get("densities", np.zeros(0, np.float32))
        need(within(densities, 2.0**100) and not np.signbit(densities).any(), "a density out of range")
        return out

    def read_graph(self, index, sites, radii):
        chunk = self.chunks[index]
        n, live, pairs = int(chunk["cells"]), int(chunk["live"]), int(chunk["pairs"])
        if pairs == 0:
            return {"neighbourOffsets": np.zeros(n + 1, np.uint32), "alphaCounts": np.zeros(live, np.uint32)}
        counts, _ = self.elements(index, 5, n, 1)
        deltas, _ = self.elements(index, 6, pairs, 1)
        bits, _ = self.elements(index, 7, (pairs + 7) // 8, 1)
        graph = GraphDecoder(sites, radii, n, live, self.has_walk_graph)
        return graph.rows(counts.ravel(), deltas.ravel().astype(np.int64), None if bits is None else bits.ravel())

    def read_details(self, index, live, colour_bytes, height_numbers, out):
        k = self.details
        scales, _ = self.elements(index, 36, live, 1)
        out["detailScales"] = None if scales is None else scales.ravel()
        scale = np.repeat(self.scales(live, out, "detailScales"), k)[:, None]
        if self.detail_site_step:
            numbers = self.signed(index, 32, live * k, 2)
            if numbers is not None:
                numbers = numbers.reshape(live, k, 2).copy()
                numbers[:, :, 0] = np.cumsum(numbers[:, :, 0], axis=1)
                out["detailSites"] = on_lattice(self.detail_site_step * scale, numbers.reshape(live * k, 2))
        else:
            out["detailSites"] = self.floats(index, 32, live * k, 2)
        if self.height_step:
            numbers = self.signed(index, 33, live * k, 1)
            if numbers is not None:
                base = 0
                if height_numbers is not None:
                    base = np.rint(np.repeat(height_numbers, k, axis=0) / scale).astype(np.int64)
                out["detailHeights"] = on_lattice(self.height_step * scale, numbers + base)
        else:
            out["detailHeights"] = self.floats(index, 33, live * k, 1)
        scales, _ = self.elements(index, 34, live, 1)
        out["colourScales"] = None if scales is None else scales.ravel()
        if not self.colour_step:
            out["baseColours"] = self.floats(index, 35, live * k, 3)
            return
        numbers = self.signed(index, 35, live * k, 3)
        if numbers is not None:
            unit = self.colour_units(live, out)[:, None]
            base = 0
            if colour_bytes is not None:
                base = np.clip(np.rint((colour_bytes / 255 - 0.5) / unit), -MAX_INDEX, MAX_INDEX).astype(np.int64)
                base = np.repeat(base, k, axis=0)
            out["baseColours"] = on_lattice(np.repeat(unit, k, axis=0), join_green(numbers) + base)

    def scales(self, live, out, name):
        scales = out.get(name)
        scales = np.zeros(live, np.int64) if scales is None else scales.astype(np.int64)
        need(np.all(scales <= 15), name)
        return 2.0**scales

    def colour_units(self, live, out):
        return np.float64(self.colour_step) * self.scales(live, out, "colourScales")

    def read_lobes(self, index, live, lobes, out):
        sites = live * self.details
        counts, _ = self.elements(index, 64, sites, 1)
        if lobes == 0:
            counts = np.zeros(sites, np.uint8)
        out["lobeCounts"] = None if counts is None else counts.ravel()
        if lobes == 0:
            return
        per_site = np.full(sites, self.most_lobes) if counts is None else counts.ravel().astype(np.int64)
        need(per_site.sum() == lobes and per_site.max() <= self.most_lobes, "lobe counts do not add up")
        axes = self.stepped(index, 66, lobes, 3, self.lobe_axis_step)
        if self.codebook_size:
            entries = self.floats(SHARED, 68, self.codebook_size, 3)
            labels = self.unsigned(index, 65, lobes, 1).ravel()
            need(labels.max() < self.codebook_size, "a label beyond the codebook")
            labels = sums_within(labels, per_site) % self.codebook_size
            axes = entries[labels] if axes is None else entries[labels] + axes
        out["lobeAxes"] = axes
        if not self.colour_step:
            out["lobeColours"] = self.floats(index, 67, lobes, 3)
        else:
            cells = np.repeat(np.arange(sites) // self.details, per_site)
            unit = self.colour_units(live, out)[cells][:, None]
            out["lobeColours"] = on_lattice(unit, join_green(self.signed(index, 67, lobes, 3)))
