"""What the experiments share: options, runs that are done once, statistics, tables, plots, footer.

A run is a folder of OUT/ with what its programs left. Its run.json tells the commands, the commit and a
fingerprint of the programs and configurations; a run whose commands and fingerprint are still the same
is not done again, so an interrupted experiment goes on where it was."""

import argparse
import concurrent.futures
import glob
import hashlib
import json
import os
import re
import shlex
import shutil
import statistics
import subprocess
import sys

# Nothing but the colour of the meshes depends on the colour images.
SIMULATION = ["--no-color"]
# For experiments of many runs: a quarter of the pixels, a third of the frames.
SMALL = [*SIMULATION, "--size", "320x240", "--set", "camera.rate=10"]
FRAMES_APART = 500  # Sec. IV-B
CONFIG = "config_ini/simulated.ini"
# Smaller objects are not observed: they cannot come into the map, see [object_map] min_pixels.
MINIMUM_PIXELS = 64
BULKY = ["map.objmap", "map.simplemap", "scene.3Dscene", "pose_graph.g2o", "objects"]
QUICK_FRAMES = 200


def options(description, arguments=None, seeds="1,2,3,4,5"):
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--bin", default="build/bin", help="folder of the programs")
    parser.add_argument("--out", default="out/experiments", help="folder for the runs")
    parser.add_argument("--results", help="folder for tables and plots (doc/results)")
    parser.add_argument("--seeds", help=f"of the simulation ({seeds})")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="runs at a time")
    parser.add_argument("--quick", action="store_true",
                        help="one seed, short runs, results in OUT/quick: to try the scripts")
    parser.add_argument("--sequence", help="rawlog of a real sequence, with its sidecar")
    result = parser.parse_args(arguments)
    result.seeds = [int(seed) for seed in re.split(r"[, ]+", (result.seeds or seeds).strip())]
    if result.quick:
        result.seeds = result.seeds[:1]
        result.out = os.path.join(result.out, "quick")
    result.results = result.results or (
        os.path.join(result.out, "results") if result.quick else "doc/results")
    result.fingerprint = fingerprint(result.bin)
    os.makedirs(result.results, exist_ok=True)
    return result


# --- runs ---------------------------------------------------------------------------------------------

def fingerprint(programs):
    """Of everything that a result depends on besides its command."""
    files = [os.path.join(programs, name)
             for name in ("rawlog-simulate", "semloop-slam", "semloop-eval", "loop_closure_benchmark")]
    files += glob.glob(os.path.join(programs, "../lib/libsemloop-*.so"))
    files += glob.glob("config_ini/**/*.ini", recursive=True)
    digest = hashlib.sha256()
    for name in sorted(files):
        with open(name, "rb") as file:
            digest.update(name.encode() + file.read())
    return digest.hexdigest()[:16]


def text_of(*command):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout.strip()


def commit():
    """As git describe --always --dirty, but the results themselves may change."""
    changed = text_of("git", "status", "--porcelain", "-uno", "--", ".", ":!doc/results")
    return text_of("git", "describe", "--always") + ("-dirty" if changed else "")


class Run:
    """Commands, one after the other, that fill a folder; (command, file) keeps what it prints."""

    def __init__(self, folder, commands, remove=()):
        self.folder = folder
        self.commands = [c if isinstance(c, tuple) else (c, None) for c in commands]
        self.remove = remove

    def path(self, name):
        return os.path.join(self.folder, name)

    def json(self, name):
        with open(self.path(name), encoding="utf-8") as file:
            return json.load(file)

    def jsonl(self, name):
        with open(self.path(name), encoding="utf-8") as file:
            return [json.loads(line) for line in file]

    def identity(self, print_):
        return {"commands": [" ".join(map(shlex.quote, c)) for c, _ in self.commands],
                "fingerprint": print_}

    def is_done(self, print_):
        if not os.path.exists(self.path("run.json")):
            return False
        made = self.json("run.json")
        return all(made.get(key) == value for key, value in self.identity(print_).items())

    def execute(self, print_):
        shutil.rmtree(self.folder, ignore_errors=True)
        os.makedirs(self.folder)
        with open(self.path("log.txt"), "w", encoding="utf-8") as log:
            for command, output in self.commands:
                self.call(command, output, log)
        for name in self.remove:
            path = self.path(name)
            if os.path.isdir(path):
                shutil.rmtree(path)
            elif os.path.exists(path):
                os.remove(path)
        with open(self.path("run.json"), "w", encoding="utf-8") as file:
            json.dump({**self.identity(print_), "commit": commit()}, file, indent=1)

    def call(self, command, output, log):
        if output:
            with open(self.path(output), "w", encoding="utf-8") as stdout:
                code = subprocess.run(command, stdout=stdout, stderr=log, check=False).returncode
        else:
            code = subprocess.run(command, stdout=log, stderr=log, check=False).returncode
        if code != 0:
            raise RuntimeError(f"{shlex.join(command)}: exit code {code}; see {self.path('log.txt')}")


def execute(runs, opts, jobs=None):
    """Does the runs that are not done yet, some at a time."""
    todo = [run for run in runs if not run.is_done(opts.fingerprint)]
    if runs and not todo:
        print(f"{len(runs)} runs, all done before", file=sys.stderr)
    with concurrent.futures.ThreadPoolExecutor(jobs or opts.jobs) as pool:
        pending = {pool.submit(run.execute, opts.fingerprint): run for run in todo}
        try:
            for count, future in enumerate(concurrent.futures.as_completed(pending), 1):
                future.result()
                print(f"{count}/{len(todo)} {pending[future].folder}", file=sys.stderr)
        except (RuntimeError, KeyboardInterrupt):
            pool.shutdown(cancel_futures=True)
            raise


def program(opts, name):
    return os.path.join(opts.bin, name)


def prefix_of(opts, scene, seed, camera=SIMULATION):
    """What the files of a simulated scene begin with."""
    size = "scenes-small" if camera is SMALL else "scenes"
    return f"{opts.out}/{size}/{scene}-{seed}/scene"


def simulation(opts, scene, seed, camera):
    prefix = prefix_of(opts, scene, seed, camera)
    command = [program(opts, "rawlog-simulate"), f"config_ini/scenes/{scene}.ini",
               f"{prefix}.rawlog", "--seed", str(seed), *camera, "--threads", "1"]
    if opts.quick:
        command += ["--frames", str(QUICK_FRAMES)]
    return Run(os.path.dirname(prefix), [command])


def simulate(opts, scenes, camera=SIMULATION):
    execute([simulation(opts, scene, seed, camera) for scene in scenes for seed in opts.seeds], opts)


def simulation_text(camera=SIMULATION):
    return (f"The scenes are simulated with `rawlog-simulate {' '.join(camera)}`, each seed with "
            "other furniture, places and noise. ")


def trajectory_commands(opts, folder, truth):
    evaluate = [program(opts, "semloop-eval"), "trajectory", "--json"]
    return [([*evaluate, f"{folder}/trajectory_odometry.tum", truth], "odometry.json"),
            ([*evaluate, f"{folder}/trajectory.tum", truth], "trajectory.json")]


def mapping(opts, scene, seed, name="default", settings=()):
    """The run of Tables I to III: noisy odometry, noisy instances."""
    prefix, folder = prefix_of(opts, scene, seed), f"{opts.out}/maps/{name}/{scene}-{seed}"
    slam = [program(opts, "semloop-slam"), "-c", CONFIG, "-i", f"{prefix}.rawlog", "-o", folder,
            "--set", f"odometry.file={prefix}_odometry.tum"]
    for setting in settings:
        slam += ["--set", setting]
    loops = [program(opts, "semloop-eval"), "loops", "--json", f"{folder}/loops.jsonl",
             "--truth", f"{prefix}_truth_instances.rawlog", "--frames-apart", str(FRAMES_APART),
             "--minimum-pixels", str(MINIMUM_PIXELS)]
    return Run(folder, [slam, (loops, "loops.json"),
                        *trajectory_commands(opts, folder, f"{prefix}_groundtruth.tum")],
               remove=BULKY)


def sequence_mapping(opts, name="default", settings=()):
    """The same of the real sequence, whose objects nobody has labelled; None without one."""
    if not opts.sequence:
        return None
    prefix = os.path.splitext(opts.sequence)[0]
    folder = f"{opts.out}/maps/{name}/{os.path.basename(prefix)}"
    slam = [program(opts, "semloop-slam"), "-c", "config_ini/tum_rgbd.ini", "-i", opts.sequence,
            "-o", folder]
    for setting in settings:
        slam += ["--set", setting]
    if opts.quick:
        slam += ["--max-frames", str(QUICK_FRAMES)]
    return Run(folder, [slam, *trajectory_commands(opts, folder, f"{prefix}_groundtruth.tum")],
               remove=BULKY)


def mappings(opts, scenes):
    """The runs of each scene, simulated where they are missing, and of the real sequence, by name."""
    simulate(opts, scenes)
    groups = {scene: [mapping(opts, scene, seed) for seed in opts.seeds] for scene in scenes}
    if opts.sequence:
        real = sequence_mapping(opts)
        groups[real.folder.split("/")[-1]] = [real]
    return groups


# --- tables -------------------------------------------------------------------------------------------

def present(values):
    return [value for value in values if value is not None]


def spread(values, digits=3):
    """Median (least - greatest); a dash where nothing could be computed."""
    values = present(values)
    if not values:
        return "-"
    middle = f"{statistics.median(values):.{digits}f}"
    if len(values) == 1:
        return middle
    return f"{middle} ({min(values):.{digits}f} - {max(values):.{digits}f})"


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "| " + " | ".join("---" for _ in header) + " |"]
    lines += ["| " + " | ".join(map(str, row)) + " |" for row in rows]
    return "\n".join(lines)


def processor():
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            names = re.findall(r"^model name\s*:\s*(.*)$", file.read(), re.MULTILINE)
    except OSError:
        names = []
    return f"{names[0] if names else 'unknown processor'}, {os.cpu_count()} cores"


def footer(opts, runs):
    """Command, seeds, commit and machine; every commit that a run was made with, should they differ."""
    commits = sorted({run.json("run.json")["commit"] for run in runs})
    command = ["make", "experiments", f"SEEDS={','.join(map(str, opts.seeds))}"]
    if opts.quick:
        command.append("QUICK=1")
    if opts.sequence:
        command += ["TUM=" + os.path.splitext(os.path.basename(opts.sequence))[0], "MODEL=..."]
    lines = ["---", "", table(["", ""], [
        ["command", f"`{' '.join(command)}` (`scripts/experiments/{os.path.basename(sys.argv[0])}`)"],
        ["seeds", ", ".join(map(str, opts.seeds))],
        ["commit", ", ".join(commits)],
        ["machine", f"{processor()}; {opts.jobs} runs at a time"]])]
    if opts.quick:
        lines += ["", f"A trial of the scripts with {QUICK_FRAMES} frames a run: no result."]
    return "\n".join(lines)


def write(opts, name, *parts):
    path = os.path.join(opts.results, name)
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n\n".join(parts) + "\n")
    print(path)


# --- plots --------------------------------------------------------------------------------------------

COLORS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"]  # told apart by everybody


def pyplot():
    """Matplotlib, so that the same numbers give the same SVG."""
    import matplotlib
    matplotlib.use("svg")
    matplotlib.rcParams.update({
        "svg.hashsalt": "semloop", "svg.fonttype": "none", "font.size": 9, "axes.spines.top": False,
        "axes.spines.right": False, "axes.grid": True, "grid.alpha": 0.3, "legend.frameon": False,
        "axes.prop_cycle": matplotlib.cycler(color=COLORS)})
    import matplotlib.pyplot
    return matplotlib.pyplot


def save_plot(opts, figure, name):
    # A white ground: GitHub shows the pages on black, too.
    figure.savefig(os.path.join(opts.results, name), metadata={"Date": None}, facecolor="white",
                   bbox_inches="tight")
