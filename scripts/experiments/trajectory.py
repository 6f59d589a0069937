#!/usr/bin/python3
"""Table II: error of the trajectory, of the odometry alone and after semantic loop closure."""

import common
from runs import call_main, execute

SCENES = ["apartment", "office", "corridor", "no_loop"]
FILES = [("odometry", "odometry.json"), ("with loop closure", "trajectory.json")]


def errors(group, name):
    return [run.json(name)["ate_m"]["rmse"] for run in group]


def loops(group):
    return [run.json("summary.json")["loops_accepted"] for run in group]


def plot(opts, groups):
    figure, axis = common.pyplot().subplots(figsize=(6, 3))
    for i, (title, name) in enumerate(FILES):
        points = [(k + 0.24 * (i - 0.5), error) for k, group in enumerate(groups.values())
                  for error in common.present(errors(group, name))]
        axis.plot(*zip(*points), "o", ms=5, alpha=0.75, mew=0, label=title)
    axis.set_xticks(range(len(groups)), groups.keys())
    axis.set(ylabel="trajectory error, RMSE [m]", ylim=(0, None))
    axis.grid(axis="x", visible=False)
    axis.legend()
    common.save_plot(opts, figure, "trajectory.svg")


def main():
    opts = common.options(__doc__)
    groups = common.mappings(opts, SCENES)
    runs = [run for group in groups.values() for run in group]
    execute(runs, opts)
    plot(opts, groups)
    rows = [[scene, *(common.spread(errors(group, name)) for _, name in FILES),
             common.spread(loops(group), 0)] for scene, group in groups.items()]
    each = [[scene, seed, *(common.spread(errors([run], name)) for _, name in FILES), loops([run])[0]]
            for scene in SCENES for seed, run in zip(opts.seeds, groups[scene])]
    common.write(
        opts, "trajectory.md", "# Trajectories (Sec. IV-D, Table II)",
        common.simulation_text() + "They are mapped from noisy odometry and noisy instances with "
        f"`{common.CONFIG}`. Absolute trajectory error after the best rigid alignment, RMSE in metres "
        "(`semloop-eval trajectory`); median over the seeds (least - greatest).",
        common.table(["scene", *(title for title, _ in FILES), "loops closed"], rows),
        "![Error with and without loop closure](trajectory.svg)", "## Each run",
        common.table(["scene", "seed", *(title for title, _ in FILES), "loops closed"], each),
        common.footer(opts, runs))


if __name__ == "__main__":
    call_main(main)
