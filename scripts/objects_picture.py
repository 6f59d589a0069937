#!/usr/bin/python3
"""Draws objects of a simulated run as they were mapped, each above its true mesh.

    scripts/objects_picture.py out/demo/result out/demo/apartment out/demo/objects.png

RESULT is the folder of the run, PREFIX what the simulation's files begin with."""

import argparse
import json
import os
import subprocess

# First: it tells when numpy or matplotlib is missing.
from picture_common import alignment, call_main, mesh_of, paired, read_objects, read_trajectory

import matplotlib.collections
import matplotlib.pyplot as plt
import numpy as np


def read_mesh(folder, number):
    """Vertices and triangles of a PLY file as semloop writes it: floats x y z nx ny nz, colour, lists."""
    counts = {}
    with open(mesh_of(folder, number), "rb") as file:
        for line in file:
            words = line.decode("ascii").split()
            if words[0] == "element":
                counts[words[1]] = int(words[2])
            elif words[0] == "end_header":
                break
        vertex = np.dtype([("xyz", "<f4", 3), ("normal", "<f4", 3), ("color", "u1", 3)])
        face = np.dtype([("count", "u1"), ("corners", "<i4", 3)])
        vertices = np.frombuffer(file.read(vertex.itemsize * counts["vertex"]), vertex)
        faces = np.frombuffer(file.read(face.itemsize * counts["face"]), face)
    return vertices["xyz"].astype(float), faces["corners"]


def view_from(direction):
    """R with the rows right, up, towards the viewer, seen from the side where the camera was."""
    azimuth = np.arctan2(direction[1], direction[0])
    elevation = np.radians(25)
    back = np.array([np.cos(azimuth) * np.cos(elevation), np.sin(azimuth) * np.cos(elevation),
                     np.sin(elevation)])
    right = np.array([-np.sin(azimuth), np.cos(azimuth), 0])
    return np.stack([right, np.cross(back, right), back])


def draw_mesh(axis, vertices, triangles, rotation, centre, reach):
    """Flat shading, painted from back to front."""
    corners = ((vertices - centre) @ rotation.T)[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    # Either side of a face is lit: furniture's faces look both ways.
    light = np.array([0.35, 0.45, 0.82])
    shade = 0.25 + 0.75 * np.abs(normals @ light)
    order = np.argsort(corners[:, :, 2].mean(1))
    colors = shade[order, None] * np.array([[0.62, 0.76, 0.92]])
    axis.add_collection(matplotlib.collections.PolyCollection(
        corners[order, :, :2], facecolors=colors, edgecolors=colors, linewidths=0.15,
        rasterized=True))
    axis.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
    axis.axis("off")


def matches_of(options):
    """(object, true object) of `semloop-eval objects`."""
    command = [os.path.join(options.bin, "semloop-eval"), "objects", "--json", options.result,
               "--truth", f"{options.prefix}_objects.json"]
    output = subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout
    return [(match["object"], match["truth"]) for match in json.loads(output)["matches"]]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("result")
    parser.add_argument("prefix")
    parser.add_argument("picture")
    parser.add_argument("--bin", default="build/bin", help="folder of the programs")
    parser.add_argument("--columns", type=int, default=8)
    options = parser.parse_args()

    labels = {thing["id"]: thing["label"] for thing in read_objects(options.result + "/objects.json")}
    truth = read_trajectory(options.prefix + "_groundtruth.tum")
    estimate = read_trajectory(options.result + "/trajectory.tum")
    rotation, translation = alignment(*paired(estimate, truth, options.result))
    pairs = []
    for found, true in matches_of(options):
        mesh = read_mesh(options.result + "/objects", found)
        pairs.append((labels[found], (mesh[0] @ rotation.T + translation, mesh[1]),
                      read_mesh(options.prefix + "_objects", true)))
    # The largest of each label.
    pairs.sort(key=lambda pair: -np.prod(np.ptp(pair[2][0], axis=0)))
    shown = list({label: pair for pair in reversed(pairs) for label in [pair[0]]}.values())
    shown = sorted(shown, key=lambda pair: pair[0])

    rows = -(-len(shown) // options.columns)
    figure, axes = plt.subplots(2 * rows, options.columns, squeeze=False,
                                figsize=(1.3 * options.columns, 2.75 * rows))
    for axis in axes.flat:
        axis.axis("off")
    for i, (label, mapped, true) in enumerate(shown):
        row, column = 2 * (i // options.columns), i % options.columns
        middle = 0.5 * (true[0].min(0) + true[0].max(0))
        near = truth[1][np.argsort(np.linalg.norm(truth[1] - middle, axis=1))[:200]]
        look = view_from((near - middle).mean(0))
        reach = 0.6 * np.linalg.norm(np.ptp(true[0], axis=0))
        draw_mesh(axes[row, column], *mapped, look, middle, reach)
        draw_mesh(axes[row + 1, column], *true, look, middle, reach)
        axes[row, column].set_title(label, size=8, pad=1)
    figure.subplots_adjust(0, 0, 1, 0.97, 0.02, 0.05)
    figure.savefig(options.picture, dpi=110, facecolor="white", pil_kwargs={"optimize": True})
    print(f"{options.picture}: {len(shown)} labels, above as mapped, below the truth")


if __name__ == "__main__":
    call_main(main)
