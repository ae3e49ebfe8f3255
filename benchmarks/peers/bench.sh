#!/bin/sh
# Time LAMMPS, LIGGGHTS and, if given, grainray on the 20,160-sphere collapse and on its settled bed.
# Use: bench.sh [GRAINRAY]        GRAINRAY  path of a grainray binary
# Files are written where you stand; timing.csv grows, and one table of medians comes at the end.
# Environment (default):
#   REPS (3)            repetitions, the programs taking turns
#   CORES (1)           list of numbers of cores, such as "1 2"
#   LOCALS ("0 1")      Cundall damping off, on (on is the physics; spelt with atom variables in the peers)
#   CASES ("collapse settled")
#   COLLAPSE_STEPS (4000)  SETTLED_STEPS (2000), after WARM (200) untimed steps; the peers only
#   SETTLED             prefix of a settled bed; made with 10,000 steps of LAMMPS where it is missing (minutes)
#   CPUS                processors to use (0, or 0-N)
#   GRAINRAY_ARGS       further arguments for grainray
set -e
here=$(cd "$(dirname "$0")" && pwd)
py=/usr/bin/python3
GRAINRAY=${1:-}
REPS=${REPS:-3} CORES=${CORES:-1} LOCALS=${LOCALS:-0 1} CASES=${CASES:-collapse settled}
COLLAPSE_STEPS=${COLLAPSE_STEPS:-4000} SETTLED_STEPS=${SETTLED_STEPS:-2000} WARM=${WARM:-200}
SETTLED=${SETTLED:-settled_A}
csv=timing.csv

# run_peer CASE PREFIX CODE CORES LOCAL REP WARM STEPS
run_peer() {
  screen=screen_$3.txt
  TIME_CMD="/usr/bin/time -f PEAKRSS=%M" OUT=bench_$3 "$here/run.sh" "$3" "$2" "$8" "$4" \
    -var local "$5" -var warm "$7" -var every 1000 -var dump -1 > $screen 2>&1 || { tail -20 $screen >&2; exit 1; }
  $py "$here/common/timing.py" peer $csv "$1" "$3" "$4" "$5" "$6" $screen
}

# run_grainray CASE SCENE FILE.csv CORES REP: the only part that knows grainray's command line and its JSON (timing.py grainray)
run_grainray() {
  [ -n "$GRAINRAY" ] || return 0
  rm -f grainray.json
  if taskset -c "${CPUS:-0-$(($4 - 1))}" /usr/bin/time -f PEAKRSS=%M \
       "$GRAINRAY" bench step --scene "$2" --init "$3" --json grainray.json ${GRAINRAY_ARGS:-} > screen_grainray.txt 2>&1; then
    $py "$here/common/timing.py" grainray $csv "$1" "$4" "$5" grainray.json screen_grainray.txt
  else
    echo "grainray failed on $1:" >&2
    tail -5 screen_grainray.txt >&2
  fi
}

start() { [ -f "$1.data" ] || $py "$here/common/start.py" lattice $2 "$1"; }
start tiny "4 4 4"
start collapse "32 10 63"
case $CASES in *settled*)
  if [ ! -f "$SETTLED.data" ]; then
    "$here/run.sh" lammps A 10000 1 > screen_settle.txt
    $py "$here/common/start.py" settled A_seed1_lammps.last.dump "$SETTLED" 2.4
  fi ;;
esac

for rep in $(seq "$REPS"); do
  for cores in $CORES; do
    for code in lammps liggghts; do run_peer tiny tiny $code $cores 1 $rep 0 1; done
    run_grainray tiny settled tiny.csv $cores $rep
    for case in $CASES; do
      case $case in
        collapse) prefix=collapse warm=0 steps=$COLLAPSE_STEPS ;;
        settled) prefix=$SETTLED warm=$WARM steps=$SETTLED_STEPS ;;
      esac
      for code in lammps liggghts; do
        for on in $LOCALS; do run_peer $case $prefix $code $cores $on $rep $warm $steps; done
      done
      run_grainray $case $case $prefix.csv $cores $rep
    done
  done
done
$py "$here/common/timing.py" table $csv
