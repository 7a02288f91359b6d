#!/usr/bin/env python3
"""Prints the values that flip_test.cpp expects: LDR-FLIP written once more from the formulas of the paper (HPG 2020), in double,
with two-dimensional filters summed directly. With --reference the same pictures go through NVIDIA's own evaluator
(pip install flip-evaluator; the values in the test were made with 1.7), which works in float."""
import sys

import numpy as np
from scipy.signal import correlate2d

PPD = 3840 * np.pi / 180


def linear(c):
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


XYZ = np.array([[10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794],
                [2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897],
                [1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382]])
WHITE = XYZ.sum(axis=1)


def opponent(rgb):
    x, y, z = np.moveaxis(rgb @ XYZ.T / WHITE, -1, 0)
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], -1)


def from_opponent(o):
    y = (o[..., 0] + 16) / 116
    xyz = np.stack([y + o[..., 1] / 500, y, y - o[..., 2] / 200], -1) * WHITE
    return xyz @ np.linalg.inv(XYZ).T


def hunt_lab(rgb):
    t = rgb @ XYZ.T / WHITE
    d = 6 / 29
    x, y, z = np.moveaxis(np.where(t > d**3, np.cbrt(t), t / (3 * d * d) + 4 / 29), -1, 0)
    light = 116 * y - 16
    return np.stack([light, 0.01 * light * 500 * (x - y), 0.01 * light * 200 * (y - z)], -1)


def hyab(a, b):
    return abs(a[..., 0] - b[..., 0]) + np.hypot(a[..., 1] - b[..., 1], a[..., 2] - b[..., 2])


def filtered(plane, kernel):
    return correlate2d(np.pad(plane, kernel.shape[0] // 2, mode="edge"), kernel, mode="valid")


def seen(image):
    radius = int(np.ceil(3 * np.sqrt(0.04 / (2 * np.pi**2)) * PPD))
    y, x = np.mgrid[-radius:radius + 1, -radius:radius + 1] / PPD
    planes = []
    for c, gaussians in enumerate([[(1, 0.0047)], [(1, 0.0053)], [(34.1, 0.04), (13.5, 0.025)]]):
        kernel = sum(a * np.sqrt(np.pi / b) * np.exp(-np.pi**2 * (x * x + y * y) / b) for a, b in gaussians)
        planes.append(filtered(opponent(linear(image))[..., c], kernel / kernel.sum()))
    return hunt_lab(np.clip(from_opponent(np.stack(planes, -1)), 0, 1))


def features(image):
    grey = (opponent(linear(image))[..., 0] + 16) / 116
    s = 0.5 * 0.082 * PPD
    radius = int(np.ceil(3 * s))
    y, x = np.mgrid[-radius:radius + 1, -radius:radius + 1].astype(float)
    g = np.exp(-(x * x + y * y) / (2 * s * s))
    lengths = []
    for kernel in (-x * g, (x * x / (s * s) - 1) * g):
        kernel = np.where(kernel > 0, kernel / kernel[kernel > 0].sum(), kernel / -kernel[kernel < 0].sum())
        lengths.append(np.hypot(filtered(grey, kernel), filtered(grey, kernel.T)))
    return lengths


def flip(a, b):
    primaries = hunt_lab(np.eye(3))
    largest = hyab(primaries[1], primaries[2]) ** 0.7
    colour = hyab(seen(a), seen(b)) ** 0.7
    colour = np.where(colour < 0.4 * largest, colour * 0.95 / (0.4 * largest),
                      0.95 + (colour - 0.4 * largest) / (0.6 * largest) * 0.05)
    (edge_a, point_a), (edge_b, point_b) = features(a), features(b)
    feature = (np.maximum(abs(edge_a - edge_b), abs(point_a - point_b)) / np.sqrt(2)) ** 0.5
    return colour ** (1 - feature)


def flat(*colour):
    return np.tile(np.array(colour, np.float32), (24, 32, 1))


def lattice(multiplier):
    return ((np.arange(24 * 32 * 3) * multiplier) % 251 / 250).astype(np.float32).reshape(24, 32, 3)


def step(left, right):
    image = flat(*left)
    image[:, 16:] = right
    return image


def dot():
    image = flat(0.5, 0.5, 0.5)
    image[12, 16] = 1
    return image


def soft(multiplier, shift):
    """Smooth waves, as pictures have them."""
    y, x, c = np.mgrid[0:24, 0:32, 0:3]
    return (0.5 + 0.4 * np.sin((x * multiplier + y * 3 + c * 5 + shift) / 16)).astype(np.float32)


PAIRS = {
    "black, white": (flat(0, 0, 0), flat(1, 1, 1)),
    "green, blue": (flat(0, 1, 0), flat(0, 0, 1)),
    "grey, one step of 8 bits": (flat(0.5, 0.5, 0.5), flat(0.5 + 1 / 255, 0.5 + 1 / 255, 0.5 + 1 / 255)),
    "chroma alone": (flat(0.6, 0.5, 0.5), flat(0.5, 0.55, 0.5)),
    "an edge": (step((0.2, 0.2, 0.2), (0.7, 0.7, 0.7)), flat(0.2, 0.2, 0.2)),
    "an edge of colour": (step((0.8, 0.2, 0.1), (0.1, 0.3, 0.9)), flat(0.8, 0.2, 0.1)),
    "a dot": (dot(), flat(0.5, 0.5, 0.5)),
    "noise": (lattice(37), lattice(53)),
    "waves": (soft(2, 0), soft(2, 3)),
}

if __name__ == "__main__":
    for name, (a, b) in PAIRS.items():
        if "--reference" in sys.argv:
            import flip_evaluator
            m = np.asarray(flip_evaluator.evaluate(a, b, "LDR", True, False, True, {})[0]).reshape(24, 32).astype(float)
        else:
            m = flip(a.astype(float), b.astype(float))
        print(f"{name:28s} mean {m.mean():.6f}  at (0, 0) {m[0, 0]:.6f}  at (16, 12) {m[12, 16]:.6f}  at (5, 20) {m[20, 5]:.6f}")
