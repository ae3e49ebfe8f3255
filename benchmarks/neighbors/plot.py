#!/usr/bin/env python3
"""Pictures of `grainray bench neighbors`: merges the JSON files of any number of machines, one column a machine.

    plot.py FILE.json ... [--out FOLDER] [--format png|svg] [--time KEY]

Writes ratio (time against the ratio of sizes), points (time against the number of points) and clouds (time by cloud), the
first and the last at the number of points that was measured most widely. Times are those of one list, a point; dashed: the
list of points that moved a little, where a back end keeps something from call to call.
"""
import argparse
import json
import os
import sys

BACKENDS = {  # in the order of the legend; whatever else a file holds follows
    "cells": "#1b6ca8", "rays": "#d1495b", "rays-published": "#edae49", "brute": "#6c757d",
    "arborx": "#2a9d8f", "nanoflann": "#8e6c8a", "cunsearch": "#7f4f24",
}
TIMES = ("milliseconds", "milliseconds_min", "milliseconds_processor",
         "milliseconds_update", "milliseconds_build", "milliseconds_refit")


def load(files):
    """Rows of all files, each with its machine and kind of list; rows without figures are left out."""
    rows = []
    for name in files:
        try:
            with open(name) as file:
                data = json.load(file)
        except (OSError, ValueError) as error:
            sys.exit(f"plot.py: {name}: {error}")
        if data.get("benchmark") != "neighbors":
            sys.exit(f"plot.py: {name} is not a file of `grainray bench neighbors --json`")
        machine = data["machine"]
        label = machine["name"] if machine["device"] == "cuda" else f"{machine['name']}, threads: {machine['threads']}"
        alone = machine["device"] == "cpu" and machine["threads"] == 1
        for row in data["results"]:
            if "failure" not in row:
                least = row["milliseconds_processor" if alone else "milliseconds_min"]
                rows.append(dict(row, machine=label, kind=data["kind"], least=least))
    if not rows:
        sys.exit("plot.py: no figures in these files")
    return rows


def unique(values):
    return list(dict.fromkeys(values))


def backends(rows):
    found = unique(row["backend"] for row in rows)
    return [b for b in BACKENDS if b in found] + [b for b in found if b not in BACKENDS]


def color(backend):
    return BACKENDS.get(backend, "black")


def nanoseconds(row, key):
    """A point's share of the time of one list."""
    return 1e6 * row[key] / row["points"]


def line(axes, rows, x, key, **style):
    """The least time at each x; several files may hold the same row."""
    best = {}
    for row in rows:
        if key in row:
            best[row[x]] = min(nanoseconds(row, key), best.get(row[x], float("inf")))
    if best:
        axes.plot(sorted(best), [best[v] for v in sorted(best)], markersize=4, **style)


def lines(axes, rows, x, key):
    for backend in backends(rows):
        its = [row for row in rows if row["backend"] == backend]
        line(axes, its, x, key, color=color(backend), label=backend, marker="o")
        if backend.startswith("rays"):
            line(axes, its, x, "milliseconds_update", color=color(backend), linestyle="--", marker=".")


def fullest(rows, key):
    """Of each machine, the rows of the number of points that has most different values of key (of two, the larger)."""
    chosen = []
    for machine in unique(row["machine"] for row in rows):
        its = [row for row in rows if row["machine"] == machine]
        points = max(unique(row["points"] for row in its), key=lambda n: (len(unique(key(r) for r in its if r["points"] == n)), n))
        chosen += [dict(row, machine=f"{machine}\n{points:,} points") for row in its if row["points"] == points]
    return chosen


def grid(plt, down, across, title):
    figure, axes = plt.subplots(len(down), len(across), figsize=(1.5 + 3.6 * len(across), 0.7 + 2.7 * len(down)), squeeze=False, sharey=True)
    figure.suptitle(title, fontsize=10)
    for j, machine in enumerate(across):
        axes[0][j].set_title(machine, fontsize=8)
    for i in range(len(down)):
        axes[i][0].set_ylabel(f"{down[i]}\nns a point", fontsize=8)
    for a in axes.flat:
        a.set_yscale("log")
        a.grid(True, which="both", linewidth=0.3, alpha=0.5)
        a.tick_params(labelsize=7)
    return figure, axes


def finish(figure, axes, path):
    entries = {}
    for a in axes.flat:
        for handle, label in zip(*a.get_legend_handles_labels()):
            entries.setdefault(label, handle)
    figure.legend(entries.values(), entries.keys(), loc="lower center", ncol=len(entries), fontsize=7, frameon=False)
    height = figure.get_figheight()
    figure.tight_layout(rect=(0, 0.3 / height, 1, 1 - 0.1 / height))
    figure.savefig(path, dpi=100)
    print(path)


def draw_lines(plt, rows, x, name, title, path, key):
    if len(unique(row[x] for row in rows)) < 2:
        return
    machines = unique(row["machine"] for row in rows)
    clouds = [c for c in unique(row["cloud"] for row in rows)
              if any(len(unique(r[x] for r in rows if r["cloud"] == c and r["machine"] == m)) > 1 for m in machines)]
    figure, axes = grid(plt, clouds, machines, title)
    for i, cloud in enumerate(clouds):
        for j, machine in enumerate(machines):
            lines(axes[i][j], [r for r in rows if r["cloud"] == cloud and r["machine"] == machine], x, key)
            axes[i][j].set_xscale("log", base=2 if x == "ratio" else 10)
            if x == "ratio":
                ticks = sorted(unique(row[x] for row in rows))
                axes[i][j].set_xticks(ticks, [f"{t:g}" for t in ticks])
    for a in axes[-1]:
        a.set_xlabel(name, fontsize=8)
    finish(figure, axes, path)


def draw_clouds(plt, rows, title, path, key):
    machines = unique(row["machine"] for row in rows)
    figure, axes = grid(plt, ["all clouds"], machines, title)
    for j, machine in enumerate(machines):
        its = [row for row in rows if row["machine"] == machine]
        names = unique(cloud_label(row) for row in its)
        for backend in backends(its):
            of = [row for row in its if row["backend"] == backend and key in row]
            axes[0][j].plot([names.index(cloud_label(row)) for row in of], [nanoseconds(row, key) for row in of], "o", markersize=5,
                            color=color(backend), label=backend)
        axes[0][j].set_xticks(range(len(names)), names, rotation=45, ha="right")
    finish(figure, axes, path)


def cloud_label(row):
    return f"{row['cloud']} {row['ratio']:g}" if row["ratio"] > 1 else row["cloud"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", metavar="FILE.json")
    parser.add_argument("--out", default=".", metavar="FOLDER")
    parser.add_argument("--format", default="png", choices=("png", "svg"))
    parser.add_argument("--time", default="least", choices=("least",) + TIMES,
                        help="which time of a row; least is milliseconds_min, and of one thread the processor's (default: %(default)s)")
    options = parser.parse_args()
    try:
        import matplotlib
    except ImportError:
        sys.exit("plot.py: matplotlib is missing; install it with: sudo apt-get install python3-matplotlib (or pip install matplotlib)")
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    rows = load(options.files)
    kinds = " and ".join(unique(row["kind"] for row in rows))
    os.makedirs(options.out, exist_ok=True)

    def path(name):
        return os.path.join(options.out, f"{name}.{options.format}")

    sized = fullest([row for row in rows if row["cloud"] in ("lognormal", "two-size")], lambda row: row["ratio"])
    draw_lines(plt, sized, "ratio", "largest reach / smallest", f"Time against the ratio of sizes, {kinds} lists", path("ratio"), options.time)
    equal = [row for row in rows if row["cloud"] not in ("lognormal", "two-size")]
    draw_lines(plt, equal, "points", "points", f"Time against the number of points, {kinds} lists",
               path("points"), options.time)
    draw_clouds(plt, fullest(rows, cloud_label), f"Time by cloud, {kinds} lists", path("clouds"), options.time)


if __name__ == "__main__":
    main()
