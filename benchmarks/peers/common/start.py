#!/usr/bin/python3
"""Write the start of a run: PREFIX.data (LAMMPS, LIGGGHTS), PREFIX.csv (x,y,z,radius), PREFIX.geo (width, count).

  start.py lattice NX NY NZ PREFIX [SEED]
      Column of NX x NY x NZ spheres, spacing 2.4 r, the first centre half a spacing from the back wall x = 0,
      the side wall y = 0 and the floor z = 0; each sphere is shifted by U(0, 0.1 r) in x and in y, not in z.
      The channel is NY spacings wide.  Spheres are numbered with x fastest and z slowest.
  start.py settled FRAME PREFIX WIDTH
      The bed of a dump's last frame, at rest: positions only, velocities and spins zero, no contact history
      (so it re-settles slightly), without the spheres beyond x_toe of deposit.py.
"""
import sys
import numpy as np
import deposit
import spheres as s


def lattice(nx, ny, nz, seed):
    rng = np.random.default_rng(seed)
    k, j, i = np.meshgrid(np.arange(nz), np.arange(ny), np.arange(nx), indexing="ij")
    pos = (np.stack([i, j, k], -1).reshape(-1, 3) + 0.5) * s.SPACING
    pos[:, :2] += rng.uniform(0.0, 0.1 * s.RADIUS, (len(pos), 2))
    return pos


def main():
    if sys.argv[1] == "lattice":
        nx, ny, nz = (int(a) for a in sys.argv[2:5])
        prefix, seed = sys.argv[5], int(sys.argv[6]) if len(sys.argv) > 6 else 1
        s.write_start(prefix, lattice(nx, ny, nz, seed), ny * s.SPACING, f"column {nx} x {ny} x {nz}, seed {seed}")
    elif sys.argv[1] == "settled":
        frame, prefix, width = sys.argv[2], sys.argv[3], float(sys.argv[4])
        g = s.read_spheres(frame)
        pos = np.c_[g["x"], g["y"], g["z"]]
        toe = deposit.bed_edge(g["x"], width, 2 * s.RADIUS)
        s.write_start(prefix, pos[pos[:, 0] < toe], width, "settled bed")
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
