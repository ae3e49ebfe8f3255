#!/usr/bin/python3
"""How much time `auto` loses against the best fixed choice, over whole runs.

  regret.py GRAINRAY [--device cpu|cuda] [--repeats 3] [--scenes NAME,...] [--json FILE] [--share S] [--against CHOICE;...]

Each scene is run with everything chosen by the program and with each fixed choice of search, interval and skin, in turns. The
figure of a run is the time of its start and steps, the least of the repeats: of the processor on a CPU (one thread), of the clock
on a GPU. Regret is time of auto over the least of all fixed choices, less 1. --share shortens all runs, to try things, and
--against leaves out all fixed choices but those named, as in the table ("cells;cells, skin 0.1").
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
EXAMPLES = HERE.parents[1] / "examples"


def column(rows):
    return [f"particles.column.count=[71,{rows},141]", f"planes.side_far.point=[0,{rows * 0.24},0]"]


# name: scene, steps, keys of the scene to set
CPU = {
    "column 20k": ("column_collapse.toml", 6000, []),
    "packing 20k": ("packing.toml", 5000, []),
    "log-normal 1:8": ("lognormal.toml", 8000, []),
    "two sizes 1:32": ("two_size.toml", 5000, []),
    "shaken box": ("shaken_box.toml", 10000, ["particles.grains.count=12000", "particles.grains.upper=[0.6,0.6,0.6]", "planes.right.point=[0.6,0,0]",
                                               "planes.far.point=[0,0.6,0]"]),
    "debris flow": ("debris_flow.toml", 5000, ["terrain.before={folder}/flume_before.asc", "terrain.after={folder}/flume_after.asc"]),
}
CUDA = {
    "column 0.1 M": ("column_collapse.toml", 8000, column(10)),
    "log-normal 1:8": ("lognormal.toml", 8000, ["particles.mixture.upper=[1.6,1.6,2.6]", "planes.right.point=[1.6,0,0]", "planes.far.point=[0,1.6,0]"]),
    "two sizes 1:32": ("two_size.toml", 5000, ["particles.mixture.upper=[0.7,0.7,0.9]", "planes.right.point=[0.7,0,0]", "planes.far.point=[0,0.7,0]"]),
    "column 1.6 M": ("column_collapse.toml", 2500, column(160)),
}
FIXED = [("cells", 0, 0), ("rays", 0, 0)] + [("cells", interval, 0) for interval in (15, 30, 60)] + [("cells", 0, skin) for skin in (0.03, 0.1, 0.3)]


def seconds(arguments, scene, steps, keys, choice, folder):
    search, interval, skin = choice
    path = HERE / scene
    command = [arguments.grainray, "bench", "step", "--scene", str(path if path.exists() else EXAMPLES / scene), "--device", arguments.device,
               "--steps", str(max(1, round(steps * arguments.share))), "--search", search, "--json", f"{folder}/step.json"]
    if arguments.device == "cpu":
        command += ["--threads", "1"]
    for key in [k.format(folder=folder) for k in keys] + [f"search.interval={interval}", f"search.skin={skin}"]:
        command += ["--set", key]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    result = json.load(open(f"{folder}/step.json"))
    return result["start_and_steps"]["processor_seconds" if arguments.device == "cpu" else "seconds"], result


def label(choice):
    search, interval, skin = choice
    return search + (f", interval {interval}" if interval else "") + (f", skin {skin}" if skin else "")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("grainray")
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--scenes", default="")
    parser.add_argument("--share", type=float, default=1)
    parser.add_argument("--against", default="")
    parser.add_argument("--json")
    arguments = parser.parse_args()
    scenes = CPU if arguments.device == "cpu" else CUDA
    if arguments.scenes:
        scenes = {name: scenes[name] for name in arguments.scenes.split(",")}
    fixed = [c for c in FIXED if not arguments.against or label(c) in arguments.against.split(";")]
    if not fixed:
        parser.error("--against: none of these is a fixed choice; there are: " + "; ".join(map(label, FIXED)))
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([pathlib.Path(arguments.grainray).resolve(), "terrain", "flume"], check=True, cwd=folder, stdout=subprocess.DEVNULL)
        for name, (scene, steps, keys) in scenes.items():
            times = {}
            for _ in range(arguments.repeats):
                for choice in [("auto", 0, 0)] + fixed:
                    time, result = seconds(arguments, scene, steps, keys, choice, folder)
                    times.setdefault(choice, []).append(time)
                    if choice[0] == "auto":
                        auto = result
            best = min(fixed, key=lambda c: min(times[c]))
            regret = min(times[("auto", 0, 0)]) / min(times[best]) - 1
            rows.append({"scene": name, "particles": auto["particles"], "steps": auto["steps"], "auto": auto["search"], "regret": regret, "best": label(best),
                         "seconds": {label(c): t for c, t in times.items()}})
            print(f"| {name} | {auto['particles']:,} | {auto['steps']:,} | {min(times[('auto', 0, 0)]):.3g} | {auto['search']['backend']} | "
                  f"{label(best)}: {min(times[best]):.3g} | {100 * regret:+.1f} % | "
                  + "; ".join(f"{label(c)} {min(t):.3g}" for c, t in times.items() if c[0] != "auto" and c != best) + " |", flush=True)
            if arguments.json:
                json.dump({"device": arguments.device, "runs": rows}, open(arguments.json, "w"), indent=1)


main()
