"""What the pictures share: matplotlib, the files of a simulated run, geometry, errors in one line."""

import csv
import errno
import glob
import gzip
import json
import os
import struct
import subprocess
import sys

try:
    import matplotlib
    import numpy as np
except ImportError as missing:
    sys.exit(f"{os.path.basename(sys.argv[0])}: {missing}; install python3-matplotlib")

matplotlib.use("agg")
MAX_TIME_DIFFERENCE = 0.02  # [s] as semloop-eval


def call_main(main):
    """Ends with main's exit code; or, when something stops it, with one line on stderr and 1."""
    script = os.path.basename(sys.argv[0])
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(f"{script}: interrupted")
    except FileNotFoundError as error:
        sys.exit(f"{script}: {error.filename}: no such file; make demo SIMULATE=1 makes it")
    except (OSError, ValueError) as error:
        sys.exit(f"{script}: {error}")
    except subprocess.CalledProcessError:
        sys.exit(1)  # the program has said why


# --- files --------------------------------------------------------------------------------------------

def read_trajectory(path):
    """Times and positions."""
    with open(path, encoding="utf-8") as file:
        poses = np.loadtxt(file, comments="#", ndmin=2)
    return poses[:, 0], poses[:, 1:4]


class InstanceReader:
    """CObservationInstances of a rawlog, as MRPT serialises them (little endian): only the masks."""

    POSE = b"mrpt::poses::CPose3D\x03"

    def __init__(self, path):
        with gzip.open(path) as file:
            self.data = file.read()
        self.at = 0

    def take(self, layout):
        values = struct.unpack_from("<" + layout, self.data, self.at)
        self.at += struct.calcsize("<" + layout)
        return values[0] if len(values) == 1 else values

    def skip(self, size):
        self.at += size

    def end_of_object(self):
        if self.take("B") != 0x88:
            raise ValueError(f"no end of an object at byte {self.at - 1}: another version?")

    def observations(self):
        """A list of masks, each an array of runs (row, begin, end), for every frame."""
        while self.at < len(self.data):
            # Before the labels come time, camera and pose; the pose's 12 numbers are the last of it.
            self.at = self.data.index(self.POSE, self.at) + len(self.POSE) + 12 * 8
            self.end_of_object()
            for _ in range(self.take("I")):
                self.skip(self.take("I"))
            yield [self.mask() for _ in range(self.take("I"))]
            self.end_of_object()

    def words(self):
        count = self.take("I")
        self.skip(2 * count)
        return np.frombuffer(self.data, "<u2", count, self.at - 2 * count)

    def mask(self):
        self.skip(4 * 2 + 4)  # box, confidence
        self.skip(8 * self.take("I"))  # label scores
        self.words()  # embedding
        runs = self.words().reshape(-1, 3)
        if self.take("B"):
            raise ValueError("instances with depth are not read here")
        if self.take("B"):
            self.skip(4)  # the true object
        return runs


def read_associations(path, times):
    """{frame: {index of the instance: object}}; the simulation's frames were at times."""
    result = {}
    with open(path, encoding="utf-8") as file:
        for row in csv.DictReader(file):
            frame = int(nearest(times, float(row["time"])))
            result.setdefault(frame, {})[int(row["instance"])] = int(row["object"])
    return result


def read_objects(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)["objects"]


def read_vertices(path):
    """Of a binary PLY file whose first element is the vertices."""
    types = {"float": "<f4", "uchar": "u1", "int": "<i4"}
    fields, count, in_vertices = [], 0, False
    with open(path, "rb") as file:
        for line in file:
            words = line.decode("ascii").split()
            if words[0] == "element":
                in_vertices = words[1] == "vertex"
                count = int(words[2]) if in_vertices else count
            elif words[0] == "property" and in_vertices:
                fields.append((words[2], types[words[1]]))
            elif words[0] == "end_header":
                break
        data = np.frombuffer(file.read(np.dtype(fields).itemsize * count), fields)
    return np.stack([data["x"], data["y"], data["z"]], axis=1).astype(float)


def mesh_of(folder, number):
    """<id>_<label>.ply, whatever the label is written like."""
    pattern = f"{folder}/{number}_*.ply"
    for path in glob.glob(pattern):
        return path
    raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), pattern)


def read_surface(folder, thing):
    """Vertices of an object's mesh."""
    return read_vertices(mesh_of(folder, thing["id"]))


# --- geometry -----------------------------------------------------------------------------------------

def nearest(times, time):
    """Index of the nearest of times, which ascend."""
    return np.rint(np.interp(time, times, np.arange(len(times)))).astype(int)


def paired(estimate, truth, name):
    """Positions of two trajectories at the same times."""
    rows = nearest(truth[0], estimate[0])
    same = np.abs(truth[0][rows] - estimate[0]) <= MAX_TIME_DIFFERENCE
    if np.sum(same) < 3:
        raise ValueError(f"{name}: fewer than three poses have a true one: not of this simulation?")
    return estimate[1][same], truth[1][rows[same]]


def alignment(source, target):
    """R, t of least squares with target = R source + t (Umeyama, without scale)."""
    a, b = source - source.mean(0), target - target.mean(0)
    u, _, vt = np.linalg.svd(b.T @ a)
    flip = np.diag([1, 1, np.sign(np.linalg.det(u @ vt))])
    rotation = u @ flip @ vt
    return rotation, target.mean(0) - rotation @ source.mean(0)
