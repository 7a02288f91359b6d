#!/usr/bin/env python3
"""Twelve cameras on a circle around a foam, for `froth bench`: how much is in view is set by their distance.

usage: cameras_outside.py FROTH INPUT DISTANCE -o cameras.json

DISTANCE: radius of the circle in halves of the longest side of the box around the sites; the circle lies 0.3 of it below the
box's centre (+y points down), and the cameras look at the centre. Images of 1920 x 1080, focal length 1600 pixels.
"""
import argparse
import json
import math
import subprocess

WIDTH, HEIGHT, FOCAL, CAMERAS, DROP = 1920, 1080, 1600.0, 12, 0.3


def box_of(froth, path):
    text = subprocess.run([froth, "info", path, "--json"], capture_output=True, text=True, check=True).stdout
    info = json.loads(text)
    return info["siteMin"], info["siteMax"]


def unit(vector):
    length = math.sqrt(sum(value * value for value in vector))
    return [value / length for value in vector]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def camera_at(eye, target):
    forward = unit([t - e for t, e in zip(target, eye)])
    right = unit(cross([0, 1, 0], forward))
    down = cross(forward, right)
    rows = [[right[k], down[k], forward[k], eye[k]] for k in range(3)]
    return {"width": WIDTH, "height": HEIGHT, "fx": FOCAL, "fy": FOCAL, "cx": WIDTH / 2, "cy": HEIGHT / 2,
            "world_from_camera": rows}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("froth")
    parser.add_argument("input")
    parser.add_argument("distance", type=float)
    parser.add_argument("-o", dest="output", required=True)
    args = parser.parse_args()
    low, high = box_of(args.froth, args.input)
    centre = [(a + b) / 2 for a, b in zip(low, high)]
    radius = args.distance * max(b - a for a, b in zip(low, high)) / 2
    angles = [2 * math.pi * i / CAMERAS for i in range(CAMERAS)]
    eyes = [[centre[0] + radius * math.cos(a), centre[1] + radius * DROP, centre[2] + radius * math.sin(a)] for a in angles]
    with open(args.output, "w") as file:
        json.dump({"views": [camera_at(eye, centre) for eye in eyes]}, file)


if __name__ == "__main__":
    main()
