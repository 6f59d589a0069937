"""What the experiments share: options, the scenes' runs, statistics, tables, plots, footer."""

import argparse
import os
import re
import statistics
import sys

import runs
from runs import Run, execute

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


class Parser(argparse.ArgumentParser):
    def error(self, message):
        self.exit(2, f"{self.prog}: {message}; --help tells the options\n")


def seed_list(text):
    """Each once: two runs in one folder would be in each other's way."""
    words = re.split(r"[, ]+", text.strip())
    if not all(word.isdecimal() for word in words):
        raise argparse.ArgumentTypeError(f"'{text}' is no list of whole numbers as 1,2,3")
    return list(dict.fromkeys(map(int, words)))


def positive(text):
    if not text.isdecimal() or int(text) == 0:
        raise argparse.ArgumentTypeError(f"'{text}' is no whole number from 1 on")
    return int(text)


def options(description, seeds="1,2,3,4,5"):
    parser = Parser(description=description)
    parser.add_argument("--bin", default="build/bin", help="folder of the programs")
    parser.add_argument("--out", default="out/experiments", help="folder for the runs")
    parser.add_argument("--results", help="folder for tables and plots (doc/results)")
    parser.add_argument("--seeds", type=seed_list, default=seeds, help=f"of the simulation ({seeds})")
    parser.add_argument("--jobs", type=positive, default=os.cpu_count(), help="runs at a time")
    parser.add_argument("--quick", action="store_true",
                        help="one seed, short runs, results in OUT/quick: to try the scripts")
    parser.add_argument("--sequence", help="rawlog of a real sequence, with its sidecar")
    result = parser.parse_args()
    if result.quick:
        result.seeds = result.seeds[:1]
        result.out = os.path.join(result.out, "quick")
    result.results = result.results or (
        os.path.join(result.out, "results") if result.quick else "doc/results")
    if not os.path.exists(CONFIG):
        raise RuntimeError(f"{CONFIG}: no such file; run this in the repository's folder")
    for path in sequence_inputs(result):
        if not os.path.exists(path):
            raise RuntimeError(f"{path}: no such file; tum2rawlog and then rawlog-segment make it")
    # Hours later the sources may be others, the programs are still these.
    result.commit = runs.commit()
    result.fingerprint = runs.fingerprint(result.bin)
    os.makedirs(result.results, exist_ok=True)
    return result


# --- the runs of the scenes ---------------------------------------------------------------------------

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


def sequence_inputs(opts):
    if not opts.sequence:
        return []
    prefix = os.path.splitext(opts.sequence)[0]
    return [opts.sequence, f"{prefix}_instances.rawlog", f"{prefix}_groundtruth.tum"]


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
               remove=BULKY, inputs=sequence_inputs(opts))


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


def footer(opts, made):
    """Command, seeds, commit and machine; every commit that a run was made with, should they differ."""
    commits = sorted({run.json("run.json")["commit"] for run in made})
    command = ["make", "experiments", f"SEEDS={','.join(map(str, opts.seeds))}"]
    if opts.quick:
        command.append("QUICK=1")
    if opts.sequence:
        command += ["TUM=" + os.path.splitext(os.path.basename(opts.sequence))[0], "MODEL=..."]
    lines = ["---", "", table(["", ""], [
        ["command", f"`{' '.join(command)}` (`scripts/experiments/{os.path.basename(sys.argv[0])}`)"],
        ["seeds", ", ".join(map(str, opts.seeds))],
        ["commit", ", ".join(commits) or "-"],
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
    try:
        import matplotlib
    except ImportError as error:
        raise RuntimeError(f"{error}; install python3-matplotlib") from error
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
