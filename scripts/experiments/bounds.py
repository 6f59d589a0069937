#!/usr/bin/python3
"""What the experiments must hold: reads the runs of the tables and of Fig. 4, ends with exit code 1 when a
bound is broken or a run has not been made."""

import math
import statistics

import association
import common
from runs import call_main

REVISITED = ["apartment", "office"]
SEEN_ONCE = ["corridor", "no_loop"]
# Where the nearest neighbour does better than this, little is left to be better at.
NEAREST_NEIGHBOUR_FAILS = 0.85


def false_loops(run):
    return run.json("loops.json")["after_verification"]["false_positives"]


def loops(run):
    return run.json("loops.json")["after_verification"]["detections"]


def error(run, name="trajectory.json"):
    rmse = run.json(name)["ate_m"]["rmse"]
    return math.inf if rmse is None else rmse


def share_of_odometry(run):
    return error(run) / error(run, "odometry.json")


def accuracies(runs):
    return [value or 0 for value in association.values(runs, "accuracy")]


class Table:
    """A row for each bound; its value is measured only where all of its runs were made."""

    def __init__(self):
        self.rows = []
        self.runs = []

    def add(self, what, value, holds, bound):
        self.rows.append([what, value, bound, "yes" if holds else "**no**"])

    def made(self, what, runs, opts):
        missing = [run.folder for run in runs if not run.is_done(opts)]
        if missing:
            self.add(what, f"not run: {len(missing)} of {len(runs)}", False, "")
        self.runs += [run for run in runs if run.folder not in missing]
        return not missing

    def broken(self):
        return sum(row[-1] != "yes" for row in self.rows)


def check_maps(table, opts):
    for scene in REVISITED + SEEN_ONCE:
        runs = [common.mapping(opts, scene, seed) for seed in opts.seeds]
        if not table.made(scene, runs, opts):
            continue
        if scene in SEEN_ONCE:
            worst = max(map(loops, runs))
            table.add(f"{scene}: loops closed, all of them false", worst, worst == 0, "0")
            continue
        worst = max(map(false_loops, runs))
        table.add(f"{scene}: false loops closed", worst, worst == 0, "0")
        worst = max(map(share_of_odometry, runs))
        table.add(f"{scene}: trajectory error / the odometry's", f"{worst:.3f}", worst <= 0.25, "<= 0.25")
        worst = max(map(error, runs))
        table.add(f"{scene}: trajectory error", f"{worst:.3f} m", worst <= 0.1, "<= 0.10 m")


def check_association(table, opts):
    noises, results = association.experiments(opts)
    for noise, _, unit, levels in noises:
        for scene in association.SCENES:
            for level in levels:
                proposed = results[noise, scene, "proposed", level]
                if level:
                    what = f"{scene}, noise of the {noise} {level} {unit}"
                    check_lead(table, opts, what, proposed,
                               results[noise, scene, "nearest neighbour", level])
                elif noise == "translation":  # without noise both kinds are the same runs
                    what = f"{scene}: accuracy of the association without noise"
                    if table.made(what, proposed, opts):
                        worst = min(accuracies(proposed))
                        table.add(what, f"{worst:.3f}", worst >= 0.95, ">= 0.95")


def check_lead(table, opts, what, proposed, nearest):
    if not table.made(what, proposed + nearest, opts):
        return
    median = statistics.median(accuracies(nearest))
    if median < NEAREST_NEIGHBOUR_FAILS:
        lead = statistics.median(accuracies(proposed)) - median
        table.add(f"{what}: accuracy above the nearest neighbour's {median:.3f}", f"{lead:.3f}",
                  lead >= 0.1, ">= 0.10")


def main():
    opts = common.options(__doc__)
    association_opts = common.options(__doc__, association.SEEDS)
    table = Table()
    check_maps(table, opts)
    check_association(table, association_opts)
    width = max(len(row[0]) for row in table.rows)
    for what, value, bound, holds in table.rows:
        print(f"  {holds.strip('*'):<4} {what:<{width}}  {value} {bound and f'({bound})'}")
    common.write(
        opts, "bounds.md", "# What must hold",
        "`make experiments` fails when one of these is broken. Loops and trajectories "
        f"([default configuration](../../{common.CONFIG})) are those of the worst seed. The association "
        f"has the seeds {', '.join(map(str, association_opts.seeds))}: without noise the worst counts, "
        "with noise the median, wherever the nearest neighbour's is below "
        f"{NEAREST_NEIGHBOUR_FAILS}.",
        common.table(["what", "value", "bound", "holds"], table.rows),
        common.footer(opts, table.runs))
    if table.broken() and not opts.quick:
        raise RuntimeError(f"{opts.results}/bounds.md: {table.broken()} of {len(table.rows)} bounds do "
                           "not hold or were not run; make experiments does what is missing")


if __name__ == "__main__":
    call_main(main)
