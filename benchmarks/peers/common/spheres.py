"""Spheres of the column-collapse cases: constants, start files and dumps.

Every script of this folder takes its constants from here; lammps/column.in and
liggghts/column.in repeat them at their heads.
"""
import numpy as np

RADIUS = 0.1                                   # m
DENSITY = 2000.0                               # kg/m^3
GRAVITY = 10.0                                 # m/s^2
MASS = DENSITY * 4.0 / 3.0 * np.pi * RADIUS**3  # kg
SPACING = 2.4 * RADIUS                         # m, of the lattice

# name: (nx, ny, nz, friction of the two side walls, steps)
CASES = {
    "A": (32, 10, 63, 0.0, 10000),
    "B": (21, 23, 41, 1.0, 8000),
    "tiny": (4, 4, 4, 0.0, 1),                 # the size of an almost empty program
}


def write_start(prefix, pos, width, title):
    """PREFIX.data for LAMMPS and LIGGGHTS, PREFIX.csv for everybody else, PREFIX.geo for the shell."""
    n = len(pos)
    xmax, zmax = pos[:, 0].max() + 1.0, pos[:, 2].max() + 1.0  # the box follows the spheres from there
    with open(prefix + ".data", "w") as f:
        f.write(f"{title}\n\n{n} atoms\n3 atom types\n\n")
        f.write(f"-0.05 {xmax:.6f} xlo xhi\n-0.05 {width + 0.05:.6f} ylo yhi\n-0.05 {zmax:.6f} zlo zhi\n\n")
        f.write("Atoms\n\n")
        for i, p in enumerate(pos, 1):
            f.write(f"{i} 1 {2 * RADIUS} {DENSITY} {p[0]:.9f} {p[1]:.9f} {p[2]:.9f}\n")
    with open(prefix + ".csv", "w") as f:
        f.write("x,y,z,radius\n")
        for p in pos:
            f.write(f"{p[0]:.9f},{p[1]:.9f},{p[2]:.9f},{RADIUS}\n")
    with open(prefix + ".geo", "w") as f:
        f.write(f"WIDTH={width:.9f}\nN={n}\n")


def read_dump(path):
    """Last frame of a text dump as a dict of columns, sorted by id."""
    lines = open(path).read().split("\n")
    at = max(i for i, line in enumerate(lines) if line.startswith("ITEM: TIMESTEP"))
    n, names = int(lines[at + 3]), lines[at + 8].split()[2:]
    a = np.array([line.split() for line in lines[at + 9:at + 9 + n]], float)
    a = a[np.argsort(a[:, names.index("id")])]
    return {name: a[:, i] for i, name in enumerate(names)}


def read_spheres(path):
    """A dump, or a CSV with the columns x,y,z (radius, vx, vy, vz where it has them)."""
    if open(path).readline().startswith("ITEM:"):
        return read_dump(path)
    names = open(path).readline().strip().split(",")
    a = np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)
    return {name: a[:, i] for i, name in enumerate(names)}
