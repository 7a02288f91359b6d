#!/usr/bin/env python3
"""Runs the packed GPU tests (scripts/test-gpu pack) on this machine and prints one table.

Each part leaves PART.json and PART.log in the results folder, and the table holds all parts that lie there: parts may be run in
several calls. The driver is chosen by VK_DRIVER_FILES, as the Vulkan loader documents. Exit code: 0 if nothing failed.
"""
import argparse
import json
import os
import re
import subprocess
import sys
import time
from pathlib import Path

PACK = Path(__file__).resolve().parent
# Part: program, whether the tests ask for validation layers.
PROGRAMS = {"render": ("test_render", True), "walk": ("test_walk", True), "levels": ("test_levels", True),
            "runtime": ("test_runtime", True), "threads": ("test_threads", True), "runtime_inside": ("test_runtime_inside", True), "query": ("test_query", True),
            "room": ("test_room", True), "faults": ("test_faults", False), "far_away": ("test_stability_far_away", True),
            "tool": ("test_tool", False)}
STABILITY = {"stability": [], "found": ["--replay", str(PACK / "source/tests/stability/found")]}
RESULT = re.compile(r"^\[ +(OK|FAILED|SKIPPED) +\] (\S+?)(?:,.*)? \(\d+ ms\)$")
STARTED = re.compile(r"^\[ RUN      \] (\S+)")
VERDICTS = {"within": "within", "refused": "within", "falls short": "known"}  # all others: beyond


def environment():
    env = dict(os.environ, FROTH_SOURCE=str(PACK / "source"), FROTH_SHADERS=str(PACK / "source"),
               FROTH_PROGRAMS=str(PACK / "bin"), VK_LAYER_PATH=str(PACK / "layers"))
    env["LD_LIBRARY_PATH"] = ":".join(filter(None, [str(PACK / "lib"), env.get("LD_LIBRARY_PATH")]))
    return env


def execute(command, log, seconds):
    """Returns the exit code; None: cut off by the time limit."""
    with open(log, "w") as out:
        try:
            return subprocess.run(command, env=environment(), stdout=out, stderr=subprocess.STDOUT, timeout=seconds).returncode
        except subprocess.TimeoutExpired:
            return None


def note_of(code):
    return "out of time" if code is None else f"ended by signal {-code}" if code < 0 else ""


def run_program(part, log, seconds, gtest_filter):
    program, validates = PROGRAMS[part]
    code = execute([PACK / "bin" / program, f"--gtest_filter={gtest_filter}"], log, seconds)
    verdicts, running = {}, None
    for line in log.read_text(errors="replace").splitlines():
        if started := STARTED.match(line):
            running = started[1]
        elif ended := RESULT.match(line):
            verdicts[ended[2]] = ended[1]
            running = None
    if running and code is not None:
        verdicts[running] = "FAILED"  # the program ended within it
    count = lambda verdict: sum(1 for found in verdicts.values() if found == verdict)
    if code not in (0, None) and not count("FAILED"):
        verdicts["(program)"] = "FAILED"
    return {"tests": len(verdicts), "passed": count("OK"), "failed": count("FAILED"), "skipped": count("SKIPPED"),
            "validation": validates, "note": note_of(code),
            "failures": [name for name, verdict in verdicts.items() if verdict == "FAILED"]}


def run_stability(part, log, seconds, validates):
    command = [PACK / "bin/froth", "stability", "--quiet", "--json", *STABILITY[part]]
    code = execute(command if validates else [*command, "--no-validation"], log, seconds)
    text = log.read_text(errors="replace")
    try:
        cases = json.JSONDecoder().raw_decode(text[text.index("{"):])[0]["cases"]
    except (ValueError, KeyError):
        cases = []
    counts = {"within": 0, "known": 0, "beyond": 0}
    for case in cases:
        counts[VERDICTS.get(case["verdict"], "beyond")] += 1
    failures = [case["name"] for case in cases if case["verdict"] not in VERDICTS]
    if not cases and code is not None:
        failures.append("(program)")
    note = f"within {counts['within']}, known {counts['known']}, beyond {counts['beyond']}"
    return {"tests": len(cases), "passed": counts["within"] + counts["known"], "failed": len(failures), "skipped": 0,
            "validation": validates, "note": "; ".join(filter(None, [note, note_of(code)])), **counts, "failures": failures}


def device_text():
    found = subprocess.run([PACK / "bin/froth", "devices", "--json"], env=environment(), capture_output=True, text=True)
    try:
        devices = json.loads(found.stdout)
    except ValueError:
        return "no Vulkan device: " + found.stderr.strip()
    return "; ".join(f"{device.get('name')} ({device.get('driver')})" for device in devices) or "no Vulkan device"


def table_of(results):
    rows = [["part", "tests", "passed", "failed", "skipped", "seconds", "validation", "remarks"]]
    for part, result in results.items():
        rows.append([part, *(str(result[key]) for key in ("tests", "passed", "failed", "skipped")), f"{result['seconds']:.0f}",
                     "on" if result["validation"] else "off", result["note"]])
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    lines = ["| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths)) + " |" for row in rows]
    lines.insert(1, "|" + "|".join("-" * (width + 2) for width in widths) + "|")
    return "\n".join(lines) + "\n"


def main():
    parts = [*PROGRAMS, *STABILITY]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", help="of " + ", ".join(parts) + " (default: all)")
    parser.add_argument("--minutes", type=float, default=1e3, help="bound on the whole call; what has not run by then is told")
    parser.add_argument("--results", type=Path, default=Path("test-gpu-results"), help="folder (default: %(default)s)")
    parser.add_argument("--filter", default="*", help="--gtest_filter of the test programs")
    parser.add_argument("--no-validation", action="store_true", help="stability and found without validation layers")
    parser.add_argument("--table", action="store_true", help="run nothing; print the table of the results that are there")
    options = parser.parse_args()
    if unknown := set(options.parts) - set(parts):
        parser.error(f"{', '.join(sorted(unknown))}: no such part; there are {', '.join(parts)}")

    options.results.mkdir(parents=True, exist_ok=True)
    if not options.table:
        (options.results / "device").write_text(f"{device_text()}, Froth {(PACK / 'version').read_text().strip()}\n")
    end = time.monotonic() + 60 * options.minutes
    for part in [] if options.table else options.parts or parts:
        start = time.monotonic()
        log = options.results / f"{part}.log"
        if part in PROGRAMS:
            result = run_program(part, log, max(1, end - start), options.filter)
        else:
            result = run_stability(part, log, max(1, end - start), not options.no_validation)
        result["seconds"] = round(time.monotonic() - start, 1)
        (options.results / f"{part}.json").write_text(json.dumps(result, indent=1) + "\n")
        print(f"{part}: {result['passed']} of {result['tests']} passed, {result['failed']} failed, {result['seconds']} s "
              f"{result['note']}", *(f"\n  {name}" for name in result["failures"]), flush=True)

    results = {part: json.loads((options.results / f"{part}.json").read_text())
               for part in parts if (options.results / f"{part}.json").exists()}
    device = (options.results / "device").read_text() if (options.results / "device").exists() else ""
    markdown = device + "\n" + table_of(results)
    failures = [f"- `{part}`: {name}\n" for part, result in results.items() for name in result["failures"]]
    if failures:
        markdown += "\nFailed:\n" + "".join(failures)
    (options.results / "table.md").write_text(markdown)
    (options.results / "table.json").write_text(json.dumps({"device": device.strip(), "parts": results}, indent=1) + "\n")
    print("\n" + markdown, end="")
    return 1 if failures or any("out of time" in result["note"] for result in results.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
