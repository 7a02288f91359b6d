#!/usr/bin/env python3
"""Writes the meshes that stand around, or in, a foam. Metres, y up; the same bytes on every run.

Usage: make_room.py room room.gltf        any foam on a pedestal
       make_room.py gallery gallery.gltf  things that stand in the foam of `froth synth gallery`

What froth_mirror_room reads besides meshes: the nodes "foam" (with a scale: where the middle of the foam's foot stands, how
it is turned, and the edge of the cube that it fills; without: where its origin lies), "ball" (where the ball begins to fall)
and "centre" (what the camera and the motes turn around, and how far the motes reach), the camera, and the directional light
(KHR_lights_punctual). Mirrors are metals of roughness 0, all in one plane.
"""
import base64
import json
import math
import struct
import sys

MATERIALS = {  # name: (base colour, metallic, roughness)
    "tile light": ((0.62, 0.58, 0.52), 0, 1),
    "tile dark": ((0.16, 0.20, 0.24), 0, 1),
    "wall": ((0.55, 0.60, 0.62), 0, 1),
    "wood": ((0.23, 0.12, 0.06), 0, 0.9),
    "stone": ((0.50, 0.48, 0.46), 0, 1),
    "lacquer": ((0.55, 0.04, 0.05), 0, 0.22),
    "silver": ((0.92, 0.93, 0.95), 1, 0),
    "rubber": ((0.80, 0.50, 0.06), 0, 0.8),
}


class Mesh:
    """Triangles of one material."""

    def __init__(self, material):
        self.material, self.positions, self.normals, self.indices = material, [], [], []

    def quad(self, corner, edge_u, edge_v):
        """Faces edge_u x edge_v."""
        normal = normalize(cross(edge_u, edge_v))
        first = len(self.positions)
        for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
            self.positions.append([corner[i] + u * edge_u[i] + v * edge_v[i] for i in range(3)])
            self.normals.append(normal)
        self.indices += [first, first + 1, first + 2, first, first + 2, first + 3]
        return self

    def box(self, low, high):
        for axis in range(3):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            edge_u = [high[i] - low[i] if i == u else 0 for i in range(3)]
            edge_v = [high[i] - low[i] if i == v else 0 for i in range(3)]
            self.quad([high[i] if i == axis else low[i] for i in range(3)], edge_u, edge_v)
            self.quad(low, edge_v, edge_u)
        return self

    def sphere(self, rows, columns):
        """Of radius 1 around the origin."""
        for row in range(rows + 1):
            latitude = math.pi * row / rows
            for column in range(columns + 1):
                longitude = 2 * math.pi * column / columns
                ring = math.sin(latitude)
                point = [ring * math.cos(longitude), math.cos(latitude), ring * math.sin(longitude)]
                self.positions.append(point)
                self.normals.append(point)
        for row in range(rows):
            for column in range(columns):
                a = row * (columns + 1) + column
                b = a + columns + 1
                if row > 0:
                    self.indices += [a, a + 1, b + 1]
                if row + 1 < rows:
                    self.indices += [a, b + 1, b]
        return self


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def normalize(a):
    length = math.sqrt(sum(x * x for x in a))
    return [x / length for x in a]


def turn_from_axes(x, y, z):
    """The quaternion (x, y, z, w) that turns the unit axes to x, y and z; its w is not near 0."""
    w = 0.5 * math.sqrt(1 + x[0] + y[1] + z[2])
    return [(y[2] - z[1]) / (4 * w), (z[0] - x[2]) / (4 * w), (x[1] - y[0]) / (4 * w), w]


def look_along(forward):
    """For nodes that look along their -z."""
    back = normalize([-x for x in forward])
    right = normalize(cross([0, 1, 0], back))
    return turn_from_axes(right, cross(back, right), back)


def turn_about_y(degrees):
    angle = math.radians(degrees)
    return [0, math.sin(angle / 2), 0, math.cos(angle / 2)]


class File:
    def __init__(self):
        self.bytes, self.views, self.accessors, self.meshes, self.nodes = b"", [], [], [], []

    def accessor(self, rows, kind, code, component):
        data = b"".join(struct.pack("<" + code * len(row), *row) for row in rows)
        self.views.append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)})
        self.bytes += data + bytes(-len(data) % 4)
        accessor = {"bufferView": len(self.views) - 1, "componentType": component, "count": len(rows), "type": kind}
        if code == "f" and kind == "VEC3":
            stored = [struct.unpack("<3f", struct.pack("<3f", *row)) for row in rows]
            accessor["min"] = [min(row[i] for row in stored) for i in range(3)]
            accessor["max"] = [max(row[i] for row in stored) for i in range(3)]
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def mesh(self, name, *parts):
        names = list(MATERIALS)
        self.meshes.append({"name": name, "primitives": [{
            "attributes": {"POSITION": self.accessor(part.positions, "VEC3", "f", 5126),
                           "NORMAL": self.accessor(part.normals, "VEC3", "f", 5126)},
            "indices": self.accessor([[i] for i in part.indices], "SCALAR", "H", 5123),
            "material": names.index(part.material)} for part in parts]})
        return len(self.meshes) - 1

    def node(self, name, **fields):
        self.nodes.append({"name": name, **fields})

    def sphere(self, name, material, centre, radius):
        self.node(name, mesh=self.mesh(name, Mesh(material).sphere(28, 56)), translation=centre, scale=[radius] * 3)

    def camera(self, eye, target):
        self.node("camera", camera=0, translation=eye, rotation=look_along([t - e for t, e in zip(target, eye)]))

    def sun(self, towards):
        self.node("sun", rotation=look_along([-x for x in towards]), extensions={"KHR_lights_punctual": {"light": 0}})

    def write(self, path):
        cameras = [{"type": "perspective", "perspective": {"yfov": 0.80, "znear": 0.01}}]
        lights = [{"type": "directional", "color": [1, 0.95, 0.86], "intensity": 1.5}]
        data = "data:application/octet-stream;base64," + base64.b64encode(self.bytes).decode()
        root = {
            "asset": {"version": "2.0", "generator": "Froth, samples/mirror_room/meshes/make_room.py"},
            "extensionsUsed": ["KHR_lights_punctual"],
            "extensions": {"KHR_lights_punctual": {"lights": lights}},
            "scene": 0, "scenes": [{"nodes": list(range(len(self.nodes)))}],
            "nodes": self.nodes, "meshes": self.meshes, "cameras": cameras,
            "materials": [{"name": name, "pbrMetallicRoughness": {
                "baseColorFactor": [*colour, 1], "metallicFactor": metallic, "roughnessFactor": roughness}}
                for name, (colour, metallic, roughness) in MATERIALS.items()],
            "accessors": self.accessors, "bufferViews": self.views,
            "buffers": [{"byteLength": len(self.bytes), "uri": data}],
        }
        with open(path, "w", encoding="ascii") as file:
            json.dump(root, file, separators=(",", ":"))
            file.write("\n")


def floor_tiles(half, tiles):
    edge = 2 * half / tiles
    light, dark = Mesh("tile light"), Mesh("tile dark")
    for i in range(tiles):
        for k in range(tiles):
            corner = [i * edge - half, 0, k * edge - half]
            (light if (i + k) % 2 else dark).quad(corner, [0, 0, edge], [edge, 0, 0])
    return light, dark


def mirror_and_frame(width, height, bar, depth):
    """The mirror's face looks along +z; its lower edge is y = 0."""
    w, h = width / 2, height
    mirror = Mesh("silver").quad([-w, 0, 0], [width, 0, 0], [0, height, 0])
    frame = Mesh("wood")
    for low, high in (((-w - bar, -bar), (w + bar, 0)), ((-w - bar, h), (w + bar, h + bar)),
                      ((-w - bar, 0), (-w, h)), ((w, 0), (w + bar, h))):
        frame.box([*low, -depth], [*high, depth / 2])
    frame.box([-w, 0, -depth], [w, h, -depth / 2])
    return mirror, frame


def room(file):
    file.node("floor", mesh=file.mesh("floor", *floor_tiles(3.0, 10)))
    walls = Mesh("wall").quad([-3, 0, -2.4], [6, 0, 0], [0, 2.8, 0]).quad([-3, 0, 3], [0, 0, -5.4], [0, 2.8, 0])
    file.node("walls", mesh=file.mesh("walls", walls))
    file.node("mirror", mesh=file.mesh("mirror", *mirror_and_frame(1.9, 1.9, 0.07, 0.06)),
              translation=[-2.0, 0.12, -0.7], rotation=turn_about_y(55))
    file.node("pedestal", mesh=file.mesh("pedestal", Mesh("stone").box([-0.45, 0, -0.45], [0.45, 0.3, 0.45])))
    file.sphere("sphere", "lacquer", [1.15, 0.34, 0.35], 0.34)
    file.sphere("ball", "rubber", [0.16, 2.2, 0.12], 0.09)
    file.node("foam", translation=[0, 0.3, 0], rotation=[1, 0, 0, 0], scale=[1.3] * 3)  # captures have -y up
    file.node("centre", translation=[0, 0.3, 0], scale=[1.3] * 3)
    file.camera([0.9, 1.45, 3.5], [-0.45, 0.78, 0.0])
    file.sun([0.55, 1.0, 0.5])


def gallery(file):
    """The foam has z up and fills 8.2 x 5.9 x 3.2 metres from its origin on: (x, y, z) becomes (x, z, -y)."""
    file.node("mirror", mesh=file.mesh("mirror", *mirror_and_frame(1.5, 1.8, 0.06, 0.05)),
              translation=[5.2, 0.1, -4.6], rotation=turn_about_y(-22))
    file.node("pedestal", mesh=file.mesh("pedestal", Mesh("stone").box([3.0, 0, -4.0], [3.5, 0.5, -3.5])))
    file.sphere("sphere", "lacquer", [3.25, 0.75, -3.75], 0.25)
    file.sphere("ball", "rubber", [4.15, 0.85, -3.2], 0.11)
    half = math.sqrt(0.5)
    file.node("foam", rotation=[-half, 0, 0, half])
    file.node("centre", translation=[4.3, 0.5, -3.8], scale=[1.2] * 3)
    file.camera([4.3, 1.5, -0.9], [4.2, 0.95, -4.0])
    file.sun([-1.0, 1.4, 0.5])


def main():
    scenes = {"room": room, "gallery": gallery}
    file = File()
    scenes[sys.argv[1]](file)
    file.write(sys.argv[2])


if __name__ == "__main__":
    main()
