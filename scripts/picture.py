#!/usr/bin/python3
"""Draws a simulated run: a colour image, the instances in it, and the map from above with the trajectory
before and after loop closure.

    scripts/picture.py out/demo/result out/demo/apartment out/demo/apartment.png

RESULT is the folder of the run, PREFIX what the simulation's files begin with."""

import argparse
import configparser
import csv
import glob
import gzip
import json
import math
import struct

import matplotlib
import numpy as np

matplotlib.use("agg")
import matplotlib.patches
import matplotlib.patheffects
import matplotlib.pyplot as plt

TRUTH, ODOMETRY, ESTIMATE = "#222222", "#d55e00", "#0072b2"


# --- files --------------------------------------------------------------------------------------------

def read_trajectory(path):
    poses = np.loadtxt(path, comments="#")
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


def read_associations(path):
    """{frame: {index of the instance: object}}"""
    result = {}
    with open(path, encoding="utf-8") as file:
        for row in csv.DictReader(file):
            result.setdefault(int(row["frame"]), {})[int(row["instance"])] = int(row["object"])
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


def read_surface(folder, thing):
    """Vertices of an object's PLY file: <id>_<label>.ply, whatever the label is written like."""
    return read_vertices(glob.glob(f"{folder}/{thing['id']}_*.ply")[0])


def read_floor_plan(path):
    """Rooms (x, y, width, depth) and doors (x, y, width) of a scene's ini file."""
    ini = configparser.ConfigParser(inline_comment_prefixes=(";",), interpolation=None)
    ini.read(path)

    def numbers(text):
        return [float(number) for number in text.replace(",", " ").split()]

    rooms = [(*numbers(ini[s]["corner"]), *numbers(ini[s]["size"]))
             for s in ini.sections() if s.startswith("room.")]
    doors = [numbers(door) for door in ini["scene"].get("doors", "").split(",") if door.strip()]
    return rooms, doors


# --- geometry -----------------------------------------------------------------------------------------

def alignment(source, target):
    """R, t of least squares with target = R source + t (Umeyama, without scale)."""
    a, b = source - source.mean(0), target - target.mean(0)
    u, _, vt = np.linalg.svd(b.T @ a)
    flip = np.diag([1, 1, np.sign(np.linalg.det(u @ vt))])
    rotation = u @ flip @ vt
    return rotation, target.mean(0) - rotation @ source.mean(0)


def outline(points):
    """The convex hull of points in the plane, counterclockwise."""
    points = sorted(set(map(tuple, points)))

    def half(sequence):
        chain = []
        for x, y in sequence:
            while len(chain) > 1 and ((chain[-1][0] - chain[-2][0]) * (y - chain[-2][1])
                                      - (chain[-1][1] - chain[-2][1]) * (x - chain[-2][0])) <= 0:
                chain.pop()
            chain.append((x, y))
        return chain[:-1]
    return np.array(half(points) + half(reversed(points)))


def rmse(estimate, truth):
    return math.sqrt(np.mean(np.sum((estimate - truth) ** 2, axis=1)))


# --- drawing ------------------------------------------------------------------------------------------

def colors_of(labels):
    """Neighbours in the alphabet get hues far apart."""
    names = sorted(set(labels))
    return {name: matplotlib.colors.hsv_to_rgb([(0.618034 * i) % 1, 0.62, 0.85 - 0.2 * (i % 2)])
            for i, name in enumerate(names)}


def best_frame(masks, associations, known, pixels):
    """The frame with the most large masks that are objects of the map."""
    def worth(frame):
        found = [len_of(masks[frame][i]) for i, thing in associations[frame].items() if thing in known]
        return sum(area > 0.008 * pixels for area in found), sum(found)
    return max((f for f in associations if f < len(masks)), key=worth)


def len_of(runs):
    return int(np.sum(runs[:, 2].astype(int) - runs[:, 1]))


def draw_instances(axis, image, masks, objects, labels, colors):
    overlay = image.astype(float) / 255
    names = []
    for i, runs in enumerate(masks):
        if objects.get(i) not in labels:
            continue
        mask = np.zeros(image.shape[:2], bool)
        for row, begin, end in runs:
            mask[row, begin:end] = True
        label = labels[objects[i]]
        overlay[mask] = 0.4 * overlay[mask] + 0.6 * colors[label]
        # The edge, darker: inside the mask with a neighbour outside.
        inner = mask.copy()
        inner[1:] &= mask[:-1]
        inner[:-1] &= mask[1:]
        inner[:, 1:] &= mask[:, :-1]
        inner[:, :-1] &= mask[:, 1:]
        overlay[mask & ~inner] = 0.55 * colors[label]
        if mask.sum() > 0.006 * mask.size:
            rows, columns = np.nonzero(mask)
            middle = np.argmin((rows - rows.mean()) ** 2 + (columns - columns.mean()) ** 2)
            names.append((columns[middle], rows[middle], label))
    axis.imshow(overlay, interpolation="lanczos")
    for x, y, label in names:
        text(axis, x, y, label, 8)


def text(axis, x, y, label, size):
    axis.text(x, y, label, size=size, ha="center", va="center", color="black", zorder=9,
              path_effects=[matplotlib.patheffects.withStroke(linewidth=2.2, foreground="white")])


def name_largest(axis, names):
    """Names (area, place, label) of large things, where no larger one's is."""
    written = []
    for area, place, label in sorted(names, key=lambda n: -n[0]):
        clear = all(abs(place[0] - x) > 0.9 or abs(place[1] - y) > 0.25 for x, y in written)
        if area > 0.2 and clear:
            text(axis, *place, label, 7)
            written.append(place)


def draw_walls(axis, rooms, doors):
    for x, y, width, depth in rooms:
        axis.add_patch(plt.Rectangle((x, y), width, depth, fill=False, ec="#666666", lw=1.6))
    for x, y, width in doors:
        # A wall along y is nearer to the door than one along x, or the other way round.
        along_y = min(min(abs(x - r[0]), abs(x - r[0] - r[2])) for r in rooms) < \
                  min(min(abs(y - r[1]), abs(y - r[1] - r[3])) for r in rooms)
        w, h = (0.3, width) if along_y else (width, 0.3)
        axis.add_patch(plt.Rectangle((x - w / 2, y - h / 2), w, h, color="white"))


def draw_map(axis, options, objects, colors):
    _, truth = read_trajectory(options.prefix + "_groundtruth.tum")
    draw_walls(axis, *read_floor_plan(options.scene))
    for thing in read_objects(options.prefix + "_objects.json"):
        corners = outline(read_surface(options.prefix + "_objects", thing)[:, :2])
        axis.add_patch(plt.Polygon(corners, closed=True, fill=False, ec="#777777",
                                   ls=(0, (2, 2)), lw=0.8, zorder=3))
    _, estimate = read_trajectory(options.result + "/trajectory.tum")
    rotation, translation = alignment(estimate, truth)
    names = []
    for thing in sorted(objects, key=lambda o: o["position"][2]):
        surface = read_surface(options.result + "/objects", thing) @ rotation.T + translation
        # A few thousand points show the shape; the higher, the darker.
        surface = surface[::max(1, len(surface) // 4000)]
        surface = surface[np.argsort(surface[:, 2])]
        shade = 1.15 - 0.3 * np.clip(surface[:, 2:], 0, 2)
        axis.scatter(*surface[:, :2].T, s=1.8, lw=0, zorder=2, rasterized=True,
                     c=np.clip(colors[thing["label"]] * shade, 0, 1))
        names.append((np.prod(np.ptp(surface[:, :2], axis=0)), surface[:, :2].mean(0), thing["label"]))
    name_largest(axis, names)
    _, odometry = read_trajectory(options.result + "/trajectory_odometry.tum")
    rows = [("odometry", odometry, ODOMETRY, 1.3, "-"), ("semloop", estimate, ESTIMATE, 1.5, "-"),
            ("truth", truth, TRUTH, 0.9, (0, (3, 2)))]
    for name, path, color, width, style in rows:
        rotation, translation = alignment(path, truth)
        path = path @ rotation.T + translation
        label = name if path is truth or name == "truth" else \
            f"{name}: {rmse(path, truth):.2f} m off"
        axis.plot(*path[:, :2].T, color=color, lw=width, ls=style, label=label, zorder=4)
    axis.set_aspect("equal")
    axis.autoscale_view()
    axis.margins(0.01)
    axis.set_anchor("N")
    axis.axis("off")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("result")
    parser.add_argument("prefix")
    parser.add_argument("picture")
    parser.add_argument("--scene", default="config_ini/scenes/apartment.ini")
    parser.add_argument("--frame", type=int, help="the one that is shown")
    options = parser.parse_args()

    objects = read_objects(options.result + "/objects.json")
    labels = {thing["id"]: thing["label"] for thing in objects}
    colors = colors_of(labels.values())
    masks = list(InstanceReader(options.prefix + "_instances.rawlog").observations())
    associations = read_associations(options.result + "/associations.csv")
    images = options.prefix + "_Images/color_{:06d}.jpg"
    frame = options.frame
    if frame is None:
        frame = best_frame(masks, associations, labels, plt.imread(images.format(0))[..., 0].size)
    image = plt.imread(images.format(frame))

    figure = plt.figure(figsize=(9.4, 5.5))
    color, overlay, above = (figure.add_axes(place) for place in (
        [0.005, 0.505, 0.38, 0.485], [0.005, 0.01, 0.38, 0.485], [0.4, 0.055, 0.595, 0.935]))
    color.imshow(image, interpolation="lanczos")
    draw_instances(overlay, image, masks[frame], associations.get(frame, {}), labels, colors)
    color.axis("off")
    overlay.axis("off")
    draw_map(above, options, objects, colors)
    figure.legend(loc="lower center", bbox_to_anchor=(0.7, -0.01), ncol=3, fontsize=9, frameon=False,
                  handlelength=1.6)
    figure.savefig(options.picture, dpi=100, facecolor="white", pil_kwargs={"optimize": True})
    print(f"{options.picture}: frame {frame}")


if __name__ == "__main__":
    main()
