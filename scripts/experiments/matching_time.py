#!/usr/bin/python3
"""Table III and Fig. 7: time of the graph matching in the maps of the scenes, and against the number
of objects and the sparsity of S in random maps. One program at a time, so that nothing disturbs it."""

import common
from common import program
from runs import Run, call_main, execute

SCENES = ["apartment", "office", "corridor", "no_loop"]
REPETITIONS = 5


def benchmark(opts, maps):
    """Each case several times; the median of these is taken."""
    folder = f"{opts.out}/matching_time"
    filters = ("spectralMatchOfWholeMaps/(25|50)/" if opts.quick else "spectralMatchOfWholeMaps")
    command = [program(opts, "loop_closure_benchmark"), "--benchmark_format=json",
               f"--benchmark_filter={filters}|spectralMatchOfRun",
               f"--benchmark_repetitions={REPETITIONS}", "--benchmark_min_time=0.1",
               *(run.path("objects.json") for run in maps)]
    return Run(folder, [(command, "benchmark.json")])


def medians(run):
    """By name, in ms of CPU time."""
    return {entry["run_name"]: entry for entry in run.json("benchmark.json")["benchmarks"]
            if entry.get("aggregate_name") == "median"}


def stage(run, name):
    """The line of a stage in timings.csv, empty where it did not take place."""
    with open(run.path("timings.csv"), encoding="utf-8") as file:
        header = next(file).strip().split(",")
        for line in file:
            row = dict(zip(header, line.strip().split(",")))
            if row["stage"] == name:
                return row
    return {}


def scene_row(scene, group, cases):
    found = [cases[name] for run in group
             if (name := f"spectralMatchOfRun/{run.path('objects.json')}") in cases]
    detection = [stage(run, "loop_detection") for run in group]

    def of_stage(key):
        return [float(row[key]) if row else None for row in detection]

    return [scene, common.spread([c["cpu_time"] / c["queries"] for c in found]),
            common.spread([c["sparsity"] for c in found]),
            common.spread([c["query_objects"] for c in found], 0),
            common.spread([c["objects"] for c in found], 0),
            common.spread(of_stage("p50_ms"), 1), common.spread(of_stage("p95_ms"), 1)]


def whole_maps(cases):
    """(objects, labels, time in ms, sparsity)"""
    for name, case in cases.items():
        if name.startswith("spectralMatchOfWholeMaps/"):
            objects, labels = map(int, name.split("/")[1:3])
            yield objects, labels, case["cpu_time"], case["sparsity"]


def plot(opts, points):
    figure, (left, right) = common.pyplot().subplots(1, 2, figsize=(8, 3.2), sharey=True)
    for labels in sorted({p[1] for p in points}):
        line = sorted(p for p in points if p[1] == labels)
        left.plot([p[0] for p in line], [p[2] for p in line], marker="o", ms=3.5,
                  label=f"{labels} labels")
    for objects in sorted({p[0] for p in points}):
        line = sorted((p for p in points if p[0] == objects), key=lambda p: p[3])
        right.plot([1 - p[3] for p in line], [p[2] for p in line], marker="o", ms=3.5,
                   label=f"{objects} objects")
    left.set(xscale="log", yscale="log", xlabel="objects in either map", ylabel="time [ms]")
    right.set(xscale="log", xlabel="non-zeros of S / all entries (1 - sparsity)")
    objects = sorted({p[0] for p in points})
    left.set_xticks(objects, objects)
    left.minorticks_off()
    left.legend()
    right.legend()
    figure.tight_layout()
    common.save_plot(opts, figure, "matching_time.svg")


def main():
    opts = common.options(__doc__)
    groups = common.mappings(opts, SCENES)
    maps = [run for group in groups.values() for run in group]
    execute(maps, opts)
    timing = benchmark(opts, maps)
    execute([timing], opts, jobs=1)
    cases = medians(timing)
    points = sorted(whole_maps(cases))
    plot(opts, points)
    common.write(
        opts, "matching_time.md", "# Time of the graph matching (Sec. IV-E, Table III, Fig. 7)",
        "CPU time on one core, median of "
        f"{REPETITIONS} repetitions (`loop_closure_benchmark`, `spectralMatchOfRun` and "
        "`spectralMatchOfWholeMaps`); in the table of the scenes also the median over the seeds "
        "(least - greatest).",
        "## In the maps of the scenes",
        "*Match*: an object and the nearest seen with it, twelve in all, against the whole map; mean "
        "over all objects. "
        "*Loop detection* is a whole attempt in the run itself, wall time with other runs beside it: "
        "recognition of the place and, where it succeeds, the alignment of the surfaces.",
        common.table(["scene", "match [ms]", "sparsity of S", "objects of the query",
                      "objects of the map", "loop detection, median [ms]", "95 % [ms]"],
                     [scene_row(scene, group, cases) for scene, group in groups.items()]),
        "## Against the number of objects and the sparsity",
        "Random maps, one object a square metre, edges up to 4 m, matched with themselves (N = M). "
        "Fewer labels make S less sparse.",
        "![Time against objects, and against the sparsity](matching_time.svg)",
        common.table(["objects", "labels", "sparsity of S", "time [ms]"],
                     [[n, labels, f"{s:.4f}", f"{t:.3g}"] for n, labels, t, s in points]),
        common.footer(opts, [*maps, timing]))


if __name__ == "__main__":
    call_main(main)
