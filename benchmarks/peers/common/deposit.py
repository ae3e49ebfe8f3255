#!/usr/bin/python3
"""Measure a deposit: the definitions of every figure in reference/deposit.csv.

  deposit.py FRAME CASE [--profile OUT.csv] [--row OUT.csv CODE SEED STEP]
FRAME   a LAMMPS/LIGGGHTS text dump (its last frame counts) or a CSV with columns x,y,z[,vx,vy,vz]
CASE    A, B, ... of spheres.py, or a lattice such as 32x10x63

Let r = 0.1 m (RADIUS), n the number of spheres, (x, z) the centre of a sphere, nx ny nz the lattice,
s = 2.4 r, L0 = nx s, W = ny s (width of the channel), V = 4/3 pi r^3, m = 2000 V.  All spheres have equal mass.
Everything below uses centres only, except where "top" is written: top = z + r.

Bins      Width w = 2 r along x, bin i holds the spheres with i = max(0, floor(x / w)); bin i spans
          [i w, (i+1) w), its middle is X_i = (i + 0.5) w.  Bins run from 0 to the last one that holds a sphere.
h_top_i   the largest top in bin i (0 where the bin is empty).
h_mass_i  count_i V / (w W 0.6): the height of the same mass at a nominal solid fraction 0.6.
smooth    centred mean over 5 bins: s_i = mean of h_mass_j, max(0, i-2) <= j <= min(last, i+2).
edge(h)   the end of the contiguous bed: with k the smallest i such that s_i < h and i >= 1, the straight line
          between (X_{k-1}, s_{k-1}) and (X_k, s_k) is cut at height h:
          x = X_{k-1} + w (s_{k-1} - h) / (s_{k-1} - s_k).  If there is no such k, x = X_last.

Figures
  x_edge        edge(4 r), the end of the bed: the place where it is worth two sphere diameters of height.
  x_toe         edge(2 r), the end of the thin toe; noisier, since the toe runs out into single spheres.
  runout        (x_edge - L0) / L0
  x_99, x_95, x_50   sorted centres x_(0) <= x_(1) ...: x_(floor(q n)) for q = 0.99, 0.95, 0.50
  x_max         largest x (a lone roller; not a measure of run-out)
  x_mean        mean x of all spheres;  x_mean_99 mean x of those with x <= x_99;  z_mean mean z of all
  h_wall        mean of h_top over bins 0..4 (0 <= x < 1 m);  h_wall_mass  mean of h_mass over bins 1..4
                (bin 0 is left out: the spheres stand in a file along the wall and its first half radius is empty)
  angle_secant  atan(h_wall / x_edge)
  angle_top     least-squares straight line through the points (X_i, h_top_i), all with weight 1, over all bins i
                with i >= i0, X_i < x_edge and 0.2 H <= h_top_i <= 0.8 H, where H = max h_top over bins with
                X_i < x_edge and i0 is the first bin that has it; angle = atan(-slope)
  angle_mass    the same with h_mass in the place of h_top everywhere (H = max h_mass, i0 its first bin)
  angle_steep   the steepest of all straight lines through h_top over g = max(4, round(0.4 L0 / w)) adjoining bins
                i .. i+g-1, 1 <= i, (i+g-1) such that X < x_edge;  x_steep = i w, where that window begins
  r2_top, r2_mass   1 - var(residual) / var(height) of the two fits;  all angles in degrees;
                nan where a fit has fewer than 3 points, or no window fits into the bed
  epot          m g sum(z), J, g = 10;   z = 0 is the floor
  ekin, ekin_bed    translational kinetic energy of all spheres and of those with x < x_edge, J
  moving_bed    spheres with x < x_edge faster than 0.1 m/s;  beyond  spheres with x >= x_toe
Velocities are left out of the sums (0) where the file has none.
"""
import csv
import os
import sys
import numpy as np
import spheres as s

BIN = 2 * s.RADIUS
VOLUME = 4.0 / 3.0 * np.pi * s.RADIUS**3


def mass_height(x, width):
    count = np.bincount(np.maximum(0, np.floor(x / BIN).astype(int)))
    return count * VOLUME / (BIN * width * 0.6)


def bed_edge(x, width, height=4 * s.RADIUS):
    h = mass_height(x, width)
    smooth = np.array([h[max(0, i - 2):i + 3].mean() for i in range(len(h))])
    below = [i for i in range(1, len(h)) if smooth[i] < height]
    if not below:
        return (len(h) - 0.5) * BIN
    k = below[0]
    return (k - 0.5) * BIN + BIN * (smooth[k - 1] - height) / (smooth[k - 1] - smooth[k])


def line(mid, h):
    """Angle in degrees and r2 of the least-squares line."""
    if len(h) < 3:
        return np.nan, np.nan
    p = np.polyfit(mid, h, 1)
    return np.degrees(np.arctan(-p[0])), 1 - (h - np.polyval(p, mid)).var() / h.var()


def flank(mid, h, bed):
    top = h[bed].max()
    use = bed & (np.arange(len(h)) >= np.argmax(np.where(bed, h, -1))) & (h >= 0.2 * top) & (h <= 0.8 * top)
    return line(mid[use], h[use])


def profile(g, width):
    x, top = g["x"], g["z"] + s.RADIUS
    h_mass = mass_height(x, width)
    h_top = np.zeros(len(h_mass))
    np.maximum.at(h_top, np.maximum(0, np.floor(x / BIN).astype(int)), top)
    return (np.arange(len(h_mass)) + 0.5) * BIN, h_top, h_mass


def measure(g, nx, ny):
    width, length, n = ny * s.SPACING, nx * s.SPACING, len(g["x"])
    x, z, order = g["x"], g["z"], np.sort(g["x"])
    v2 = sum(g[c]**2 for c in ("vx", "vy", "vz")) if "vx" in g else np.zeros(n)
    mid, h_top, h_mass = profile(g, width)
    edge, toe = bed_edge(x, width), bed_edge(x, width, 2 * s.RADIUS)
    bed = mid < edge
    wide = max(4, int(round(0.4 * length / BIN)))
    windows = range(1, bed.sum() - wide + 1)
    steep = max(((line(mid[i:i + wide], h_top[i:i + wide])[0], i * BIN) for i in windows), default=(np.nan, np.nan))
    top, mass = flank(mid, h_top, bed), flank(mid, h_mass, bed)
    h_wall = h_top[:5].mean()
    return dict(
        n=n, x_edge=edge, x_toe=toe, runout=(edge - length) / length,
        x_99=order[int(0.99 * n)], x_95=order[int(0.95 * n)], x_50=order[int(0.5 * n)], x_max=order[-1],
        x_mean=x.mean(), x_mean_99=x[x <= order[int(0.99 * n)]].mean(), z_mean=z.mean(),
        h_wall=h_wall, h_wall_mass=h_mass[1:5].mean(),
        angle_secant=np.degrees(np.arctan(h_wall / edge)), angle_top=top[0], r2_top=top[1],
        angle_mass=mass[0], r2_mass=mass[1], angle_steep=steep[0], x_steep=steep[1],
        epot=s.MASS * s.GRAVITY * z.sum(), ekin=0.5 * s.MASS * v2.sum(), ekin_bed=0.5 * s.MASS * v2[x < edge].sum(),
        moving_bed=int(((v2 > 0.01) & (x < edge)).sum()), beyond=int((x >= toe).sum()))


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    frame, case, rest = sys.argv[1], sys.argv[2], sys.argv[3:]
    nx, ny = s.CASES[case][:2] if case in s.CASES else (int(a) for a in case.split("x")[:2])
    g = s.read_spheres(frame)
    q = measure(g, nx, ny)
    for key, value in q.items():
        print(f"{key} {value:.6g}")
    if "--profile" in rest:
        out = rest[rest.index("--profile") + 1]
        np.savetxt(out, np.c_[profile(g, ny * s.SPACING)], delimiter=",", fmt="%.5f", header="x_mid,h_top,h_mass", comments="")
    if "--row" in rest:
        out, code, seed, step = rest[rest.index("--row") + 1:][:4]
        new = not os.path.exists(out)
        with open(out, "a", newline="") as f:
            w = csv.writer(f, lineterminator="\n")
            if new:
                w.writerow(["case", "code", "seed", "step"] + list(q))
            w.writerow([case, code, seed, step] + [f"{v:.6g}" for v in q.values()])


if __name__ == "__main__":
    main()
