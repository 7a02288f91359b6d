#!/usr/bin/env python3
"""PSNR of the test photos over the seconds of training: a table (CSV) and a plot (SVG) of logs that `froth train --log` wrote.

  tests/bench/training_curves.py fox.jsonl miku_plush.jsonl -o docs/reports/training

A curve has the name of its log. Needs python3-matplotlib.
"""
import argparse
import csv
import json
import pathlib

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "froth"
from matplotlib import pyplot


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("logs", nargs="+", type=pathlib.Path)
    parser.add_argument("-o", "--output", required=True, type=pathlib.Path, help="name of the .csv and .svg, without ending")
    options = parser.parse_args()
    figure, axes = pyplot.subplots(figsize=(7, 4.5))
    with options.output.with_suffix(".csv").open("w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["run", "steps", "seconds", "cells", "psnr"])
        for log in options.logs:
            looks = [json.loads(line) for line in log.read_text().splitlines()]
            table.writerows([log.stem, look["steps"], f"{look['seconds']:.2f}", look["cells"], f"{look['psnr']:.2f}"] for look in looks)
            axes.plot([look["seconds"] for look in looks], [look["psnr"] for look in looks], "o-", markersize=3, label=log.stem)
    axes.set_xlabel("training [s]")
    axes.set_ylabel("PSNR of photos held out [dB]")
    axes.grid(alpha=0.3)
    axes.legend()
    figure.savefig(options.output.with_suffix(".svg"), metadata={"Date": None})


if __name__ == "__main__":
    main()
