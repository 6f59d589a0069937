#!/usr/bin/python3
"""Draws a simulated run: a colour image, the instances in it, and the map from above with the trajectory
before and after loop closure.

    scripts/picture.py out/demo/result out/demo/apartment out/demo/apartment.png

RESULT is the folder of the run, PREFIX what the simulation's files begin with."""

import argparse
import configparser
import math

# First: it tells when numpy or matplotlib is missing.
from picture_common import (InstanceReader, alignment, call_main, paired, read_associations, read_objects,
                            read_surface, read_trajectory)

import matplotlib.colors
import matplotlib.patheffects
import matplotlib.pyplot as plt
import numpy as np

TRUTH, ODOMETRY, ESTIMATE = "#222222", "#d55e00", "#0072b2"


def read_floor_plan(path):
    """Rooms (x, y, width, depth) and doors (x, y, width) of a scene's ini file."""
    ini = configparser.ConfigParser(inline_comment_prefixes=(";",), interpolation=None)
    if not ini.read(path):
        raise ValueError(f"{path}: no such file; config_ini/scenes has some scenes")

    def numbers(text):
        return [float(number) for number in text.replace(",", " ").split()]

    rooms = [(*numbers(ini[s]["corner"]), *numbers(ini[s]["size"]))
             for s in ini.sections() if s.startswith("room.")]
    doors = [numbers(door) for door in ini["scene"].get("doors", "").split(",") if door.strip()]
    return rooms, doors


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
    return max(associations, key=worth)


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
    truth = read_trajectory(options.prefix + "_groundtruth.tum")
    draw_walls(axis, *read_floor_plan(options.scene))
    for thing in read_objects(options.prefix + "_objects.json"):
        corners = outline(read_surface(options.prefix + "_objects", thing)[:, :2])
        axis.add_patch(plt.Polygon(corners, closed=True, fill=False, ec="#777777",
                                   ls=(0, (2, 2)), lw=0.8, zorder=3))
    estimate, odometry = (read_trajectory(f"{options.result}/{name}.tum")
                          for name in ("trajectory", "trajectory_odometry"))
    rotation, translation = alignment(*paired(estimate, truth, options.result))
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
    for name, path, color, width in (("odometry", odometry, ODOMETRY, 1.3),
                                     ("semloop", estimate, ESTIMATE, 1.5)):
        here, there = paired(path, truth, options.result)
        rotation, translation = alignment(here, there)
        error = rmse(here @ rotation.T + translation, there)
        axis.plot(*(path[1] @ rotation.T + translation)[:, :2].T, color=color, lw=width, zorder=4,
                  label=f"{name}: {error:.2f} m off")
    axis.plot(*truth[1][:, :2].T, color=TRUTH, lw=0.9, ls=(0, (3, 2)), label="truth", zorder=4)
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
    times, _ = read_trajectory(options.prefix + "_groundtruth.tum")
    associations = read_associations(options.result + "/associations.csv", times)
    if not associations:
        raise ValueError(f"{options.result}/associations.csv: no object was mapped, nothing to draw")
    images = options.prefix + "_Images/color_{:06d}.jpg"
    frame = options.frame
    if frame is None:
        frame = best_frame(masks, associations, labels, plt.imread(images.format(0))[..., 0].size)
    if not 0 <= frame < len(masks):
        raise ValueError(f"--frame {frame}: the simulation has the frames 0 to {len(masks) - 1}")
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
    call_main(main)
