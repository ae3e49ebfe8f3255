#!/usr/bin/env python3
"""Writes bed_plane.toml and bed_mesh.toml: 1.6 million spheres in a box, its floor a plane or 100,352 random triangles (floor.obj).
From the top of the repository: python3 benchmarks/mesh_cost/scenes.py; what it is for: benchmarks/results/debris.md."""
import random

CELLS, SIDE = 224, 80.0  # two triangles a cell, nodes shifted by up to a quarter of an edge, diagonals at random
random.seed(1)
edge = SIDE / CELLS


def shift(k):
    return random.uniform(-0.24 * edge, 0.24 * edge) if 0 < k < CELLS else 0


def node(i, j):
    return j * (CELLS + 1) + i + 1


with open("floor.obj", "w") as mesh:
    for j in range(CELLS + 1):
        for i in range(CELLS + 1):
            mesh.write(f"v {-0.4 + i * edge + shift(i):.6g} {-0.4 + j * edge + shift(j):.6g} 0\n")
    for j in range(CELLS):
        for i in range(CELLS):
            a, b, c, d = node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)
            for corners in ((a, b, d), (b, c, d)) if random.random() < 0.5 else ((a, b, c), (a, c, d)):
                mesh.write("f %d %d %d\n" % corners)

scene = open("examples/packing.toml").read()
for old, new in (("count = [32, 10, 63]", "count = [330, 330, 15]"), ("point = [0, 2.4, 0]", "point = [0, 79.2, 0]"),
                 ("point = [7.68, 0, 0]", "point = [79.2, 0, 0]")):
    assert old in scene
    scene = scene.replace(old, new)
open("bed_plane.toml", "w").write(scene)
floor, back = scene.index("[planes.floor]"), scene.index("[planes.back]")
open("bed_mesh.toml", "w").write(scene[:floor] + scene[back:] + '\n[meshes.floor]\nfile = "floor.obj"\nmaterial = "wall"\n')
