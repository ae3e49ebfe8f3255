#!/bin/sh
# Column collapse with LAMMPS or LIGGGHTS; files are written where you stand.
# Use: run.sh CODE CASE STEPS CORES [-var NAME VALUE ...]
#   CODE   lammps | liggghts
#   CASE   A, B or tiny (see common/spheres.py), a lattice such as 32x10x63, or the prefix of
#          start files that start.py wrote (PREFIX.data and PREFIX.geo)
#   STEPS  0: as many as the case says      CORES  number of MPI processes
# Environment: SEED (1) of the lattice, CPUS (0 or 0-N) the processors to use, OUT prefix of the output.
# Example: CPUS=1 run.sh liggghts B 8000 1 -var dump 2000
set -e
here=$(cd "$(dirname "$0")" && pwd)
code=$1 case=$2 steps=$3 cores=$4
[ -n "$cores" ] || { sed -n '2,9s/^# \{0,1\}//p' "$0"; exit 2; }
shift 4
seed=${SEED:-1}
case $code in lammps) exe=lmp ;; liggghts) exe=liggghts ;; *) echo "unknown code '$code'" >&2; exit 2 ;; esac

mus=""
if [ -f "$case.data" ]; then
  start=$case
else
  case $case in
    *x*x*) lattice=$(echo "$case" | tr x ' ') ;;
    *) values=$(cd "$here/common" && /usr/bin/python3 -c "import sys, spheres; print(*spheres.CASES.get(sys.argv[1], ()))" "$case")
       [ -n "$values" ] || { echo "unknown case '$case', and no file $case.data" >&2; exit 2; }
       set -- $values "$@"
       lattice="$1 $2 $3" mus="-var mus $4"
       [ "$steps" -gt 0 ] || steps=$5
       shift 5 ;;
  esac
  start=${case}_seed$seed
  [ -f "$start.data" ] || /usr/bin/python3 "$here/common/start.py" lattice $lattice "$start" "$seed"
fi
. "./$start.geo"

out=${OUT:-${start}_$code}
export OMP_NUM_THREADS=1
if [ "$cores" -gt 1 ]; then
  launch="taskset -c ${CPUS:-0-$((cores - 1))} mpirun --allow-run-as-root --oversubscribe --bind-to none -np $cores"
  grid="-var px 1 -var py $cores -var pz 1"
else
  launch="taskset -c ${CPUS:-0}" grid=""
fi
# the first of two -var of one name counts, so the caller's go first
$launch ${TIME_CMD:-} $exe -in "$here/$code/column.in" "$@" -var data "$start.data" -var width "$WIDTH" \
  -var steps "$steps" -var out "$out" $mus $grid -log "$out.log"
