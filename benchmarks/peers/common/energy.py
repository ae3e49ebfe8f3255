#!/usr/bin/python3
"""Turn the thermodynamic table of a LAMMPS or LIGGGHTS log into a CSV file.

  energy.py LOG OUT.csv
Columns: step, time (s), kinetic energy of translation and of rotation (J), potential energy m g sum(z) (J, zero at the
floor), largest x and z of a centre (m), contacts between particles times two divided by their number, and the share of
the initial potential energy that has gone (elastic energy counts as gone).
"""
import sys


def rows(log):
    inside = False
    for text in open(log, errors="replace"):
        words = text.split()
        if words[:2] == ["Step", "Time"]:
            inside = True
        elif inside and text.startswith("Loop time"):
            inside = False
        elif inside and len(words) == 9:
            try:
                yield [float(w) for w in words[:8]]
            except ValueError:
                pass


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    table = {r[0]: r for r in rows(sys.argv[1])}
    e0 = table[min(table)][4]
    with open(sys.argv[2], "w") as f:
        f.write("step,time_s,ke_translation_J,ke_rotation_J,potential_J,x_max_m,z_max_m,contacts_per_particle,lost_share\n")
        for r in sorted(table.values()):
            f.write(",".join(f"{v:.7g}" for v in r) + f",{1 - sum(r[2:5]) / e0:.5f}\n")
    print(sys.argv[2], len(table), "rows")


if __name__ == "__main__":
    main()
