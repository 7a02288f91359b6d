#!/usr/bin/env python3
"""Size against error of the presets and of single knobs: a table (CSV) and a plot (SVG) of one trained foam.

  tests/bench/rate_distortion.py --froth build/release/tool/froth --foam model.pt --cameras test.json \
      --fit train.json -o docs/reports/miku_plush

Every setting is baked with the cameras of --fit, drawn from all views of --cameras and compared with the same views of the
preset `exact`. Needs python3-matplotlib for the plot only.
"""
import argparse
import csv
import json
import pathlib
import subprocess
import tempfile

PRESETS = ["exact", "high", "default", "small"]
# One knob at a time, the others as in `default`.
SWEEPS = {
    "--error-bound": ["0.006", "0.01", "0.014", "0.03", "0.045"],
    "--position-bits": ["12", "14", "16"],
    "--detail-site-bits": ["5", "6", "7", "9"],
}


def run(*command):
    return subprocess.run([str(part) for part in command], check=True, capture_output=True, text=True).stdout


def run_json(*command):
    return json.loads(run(*command, "--json"))


class Bench:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        self.views = len(json.loads(pathlib.Path(options.cameras).read_text())["views"])

    def bake(self, flags):
        asset = self.folder / "scene.froth"
        run_json(self.options.froth, "bake", self.options.foam, "-o", asset, "--cameras", self.options.fit, "--no-measure", *flags)
        return asset

    def draw(self, asset, name):
        images = self.folder / name
        size = ["--size", self.options.size] if self.options.size else []
        run(self.options.froth, "render", asset, "--cameras", self.options.cameras, "--renderer", "raster", "--cutoff", "1e-3",
            *size, "-o", images)
        return sorted(images.iterdir())

    def measure(self, flags, exact):
        asset = self.bake(flags)
        cells = run_json(self.options.froth, "info", asset)["cells"]
        images = self.draw(asset, "images")
        psnr = [run_json(self.options.froth, "compare", a, b)["psnr"] for a, b in zip(exact, images, strict=True)]
        size = asset.stat().st_size
        return {"bytes": size, "bytesPerCell": size / cells, "minPsnr": min(psnr), "meanPsnr": sum(psnr) / len(psnr)}


def settings(options):
    for preset in PRESETS[1:]:
        yield "preset", preset, ["--preset", preset]
    for flag, values in [] if options.presets_only else SWEEPS.items():
        for value in values:
            yield flag.removeprefix("--"), value, ["--preset", "default", flag, value]


def plot(rows, path):
    import matplotlib
    matplotlib.use("svg")
    matplotlib.rcParams["svg.hashsalt"] = "froth"
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=(7, 4.5))
    for knob in dict.fromkeys(row["knob"] for row in rows):
        points = [row for row in rows if row["knob"] == knob]
        x, y = [row["bytesPerCell"] for row in points], [row["minPsnr"] for row in points]
        axes.plot(x, y, "ks" if knob == "preset" else "o-", label=knob, markersize=6 if knob == "preset" else 3)
        if knob == "preset":
            for row in points:
                axes.annotate(row["value"], (row["bytesPerCell"], row["minPsnr"]), xytext=(5, -12), textcoords="offset points")
    axes.axhline(42, color="grey", linewidth=0.5)
    axes.set_xlabel("bytes per cell, all in")
    axes.set_ylabel("PSNR against exact, worst view [dB]")
    axes.set_xscale("log")
    axes.legend()
    figure.savefig(path, metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--froth", default="froth")
    parser.add_argument("--foam", required=True, help="checkpoint")
    parser.add_argument("--cameras", required=True, help="views that are compared")
    parser.add_argument("--fit", required=True, help="cameras given to the bake")
    parser.add_argument("--presets-only", action="store_true", help="leave the single knobs out")
    parser.add_argument("--size", help="WxH of the images; default: the views' own")
    parser.add_argument("-o", "--output", required=True, help="name of the .csv and .svg, without ending")
    options = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as name:
        bench = Bench(options, pathlib.Path(name))
        exact = bench.draw(bench.bake(["--preset", "exact"]), "exact")
        for knob, value, flags in settings(options):
            rows.append({"knob": knob, "value": value, **bench.measure(flags, exact)})
            print(rows[-1], flush=True)
    output = pathlib.Path(options.output)
    with output.with_suffix(".csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    try:
        plot(rows, output.with_suffix(".svg"))
    except ImportError:
        print("no plot: python3-matplotlib is not installed")


if __name__ == "__main__":
    main()
