#!/usr/bin/python3
"""The table at the end of make demo: RESULT is the folder of a run, PREFIX what the truth's files
begin with. Rows whose truth is missing are left out. Standard library only."""

import argparse
import json
import os
import subprocess
import sys


def evaluate(program, *arguments):
    output = subprocess.run([program, *arguments, "--json"], check=True, stdout=subprocess.PIPE)
    return json.loads(output.stdout)


def number(value, digits=2):
    """A dash where there was nothing to measure."""
    return "-" if value is None else f"{value:.{digits}f}"


def trajectory_rows(evaluator, result, truth):
    def error(name):
        ate = evaluate(evaluator, "trajectory", f"{result}/{name}", truth)["ate_m"]
        return f"{number(ate['rmse'], 3)} m RMSE, {number(ate['max'])} m at most"

    yield "trajectory error of the odometry", error("trajectory_odometry.tum")
    yield "after semantic loop closure", error("trajectory.tum")


def loop_rows(evaluator, result, truth, frames_apart):
    loops = evaluate(evaluator, "loops", f"{result}/loops.jsonl", "--truth", truth,
                     "--frames-apart", str(frames_apart), "--minimum-pixels", "64")
    accepted = loops["after_verification"]
    yield "loops closed", (f"{accepted['true_positives']} true, "
                           f"{accepted['false_positives']} false")
    if loops["places"]:
        yield "revisits with a loop", f"{loops['places_found']} of {loops['places']}"


def object_rows(evaluator, result, truth):
    objects = evaluate(evaluator, "objects", result, "--truth", truth)
    found = objects["true_objects_found"]
    yield "objects found", (f"{found} of {objects['true_objects']}, "
                            f"{objects['objects'] - found} too many")
    yield "centres of these", f"{number(objects['centre_error_m']['median'])} m off (median)"


def rows(options):
    result, prefix = options.result, options.prefix
    evaluator = os.path.join(options.bin, "semloop-eval")
    with open(f"{result}/summary.json", encoding="utf-8") as file:
        summary = json.load(file)
    groundtruth = prefix + "_groundtruth.tum"
    instances = prefix + "_truth_instances.rawlog"
    objects = prefix + "_objects.json"
    if os.path.exists(groundtruth):
        yield from trajectory_rows(evaluator, result, groundtruth)
    if os.path.exists(instances):
        yield from loop_rows(evaluator, result, instances, options.frames_apart)
    else:
        yield "loops closed", str(summary["loops_accepted"])
    if os.path.exists(objects):
        yield from object_rows(evaluator, result, objects)
    else:
        yield "objects", str(sum(summary["objects_by_label"].values()))
    yield "time a frame", f"{summary['mapping_ms_per_frame']:.0f} ms mapping with loop closure"
    if summary["odometry_ms_per_frame"] > 0.5:  # else it was recorded
        yield "", f"{summary['odometry_ms_per_frame']:.0f} ms odometry"
    yield "", f"{summary['front_end_ms_per_frame']:.0f} ms reading, in a thread of its own"
    yield "", f"{summary['frames']} frames in {summary['wall_seconds']:.0f} s"
    yield "trajectory, objects, loops", f"{result}/: see doc/file-formats.md"
    yield "look at the map", f"SceneViewer3D {result}/scene.3Dscene"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("result")
    parser.add_argument("prefix")
    parser.add_argument("--bin", default="build/bin")
    parser.add_argument("--frames-apart", type=int, default=500)
    table = list(rows(parser.parse_args()))
    width = max(len(name) for name, _ in table)
    print()
    for name, value in table:
        print(f"  {name:<{width}}  {value}")


if __name__ == "__main__":
    try:
        main()
    except FileNotFoundError as error:
        sys.exit(f"demo_table.py: {error.filename}: no such file; make demo makes it")
    except subprocess.CalledProcessError:
        sys.exit(1)  # semloop-eval has said why
