#!/usr/bin/python3
"""Collect timings in a CSV file and print their medians.

  timing.py peer CSV CASE CODE CORES LOCAL REP OUTPUT   a run of run.sh whose screen output is in OUTPUT
  timing.py grainray CSV CASE CORES REP JSON OUTPUT     a run of grainray: its JSON, and its screen output
  timing.py table CSV                                   the table
Time is what each program reports for its own stepping loop, set-up excluded (LAMMPS, LIGGGHTS: the last "Loop time").
peak_rss_mb is the sum over processes of the peak resident size, as /usr/bin/time prints it (PEAKRSS=kB).
Memory per particle is (peak_rss of the case - peak_rss of the 64-sphere case "tiny") / n, so that the size of the
program itself does not count; "-" where there is no tiny row.
"""
import csv
import json
import os
import re
import statistics as st
import sys
from collections import defaultdict

HEAD = ["case", "code", "local", "cores", "rep", "n", "steps", "loop_s", "particle_steps_per_s", "peak_rss_mb"]


def append(path, row):
    new = not os.path.exists(path)
    with open(path, "a", newline="") as f:
        w = csv.writer(f, lineterminator="\n")
        if new:
            w.writerow(HEAD)
        w.writerow(row)


def peak_rss(text):
    return sum(int(k) for k in re.findall(r"PEAKRSS=(\d+)", text)) / 1024


def peer(path, case, code, cores, local, rep, output):
    text = open(output, errors="replace").read()
    loops = re.findall(r"Loop time of ([\d.e+-]+) on \d+ procs for (\d+) steps with (\d+) atoms", text)
    if not loops:
        sys.exit(f"{output}: no 'Loop time': the run failed\n{text[-800:]}")
    seconds, steps, n = float(loops[-1][0]), int(loops[-1][1]), int(loops[-1][2])
    append(path, [case, code, local, cores, rep, n, steps, f"{seconds:.4f}", f"{n * steps / seconds:.0f}", f"{peak_rss(text):.1f}"])


def grainray(path, case, cores, rep, report, output):
    j, text = json.load(open(report)), open(output, errors="replace").read()
    append(path, [case, "grainray", 1, cores, rep, j["particles"], j["steps"], f"{j['wall_seconds']:.4f}",
                  f"{j['particle_steps_per_second']:.0f}", f"{peak_rss(text):.1f}"])


def table(path):
    group = defaultdict(list)
    for r in csv.DictReader(open(path)):
        group[r["case"], r["code"], r["local"], r["cores"]].append(
            (float(r["particle_steps_per_s"]) / 1e6, float(r["peak_rss_mb"]), int(r["n"])))
    tiny = {(k[1], k[3]): min(v[1] for v in rows) for k, rows in group.items() if k[0] == "tiny"}
    print("| case | code | Cundall damping | cores | n | million particle-steps/s, median (min - max) | bytes per particle | peak MB |")
    print("|---|---|---|---|---|---|---|---|")
    for k in sorted(k for k in group if k[0] != "tiny"):
        speed, rss, n = [r[0] for r in group[k]], max(r[1] for r in group[k]), group[k][0][2]
        base = tiny.get((k[1], k[3]))
        size = "-" if base is None else f"{(rss - base) * 2**20 / n:.0f}"
        print(f"| {k[0]} | {k[1]} | {'yes' if k[2] == '1' else 'no'} | {k[3]} | {n} | {st.median(speed):.3f} "
              f"({min(speed):.3f} - {max(speed):.3f}) | {size} | {rss:.0f} |")


if __name__ == "__main__":
    commands = {"peer": peer, "grainray": grainray, "table": table}
    if len(sys.argv) < 3 or sys.argv[1] not in commands:
        sys.exit(__doc__)
    commands[sys.argv[1]](*sys.argv[2:])
