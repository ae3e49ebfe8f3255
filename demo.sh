#!/usr/bin/env bash
# Installs what is missing, builds grainray, collapses a column of 20,160 grains and draws its first and last frame.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
. tools/prepare.sh

scene=examples/column_collapse.toml
out=demo

install_missing "${LIBRARY_PACKAGES[@]}"
preset=$(suitable_preset)
# A build folder that is already configured keeps its options: ninja configures again by itself where it must.
if [ ! -f "build/$preset/build.ninja" ]; then
    without_tests=(-D GRAINRAY_TESTS=OFF)
    if ! configure "$preset" "${without_tests[@]}"; then
        [ "$preset" = cuda ] || fail "configuring failed; the messages above say why"
        say "configuring with CUDA failed (messages above): building for the CPU instead"
        preset=cpu
        configure "$preset" "${without_tests[@]}" || fail "configuring failed; the messages above say why"
    fi
fi
build "$preset" grainray_cli

grainray=build/$preset/bin/grainray
say "$grainray run $scene --out $out --force"
"$grainray" run "$scene" --out "$out" --force || fail "the run failed with status $?; the message above says why"

frames=("$out"/frames/*.vtp)
[ -f "${frames[0]}" ] || fail "the run left no frames in $out/frames"
"$grainray" render "${frames[0]}" --out "$out/first.png" || fail "drawing ${frames[0]} failed"
"$grainray" render "${frames[-1]}" --out "$out/last.png" || fail "drawing ${frames[-1]} failed"

say "done: pictures in $out/first.png and $out/last.png, figures in $out/summary.json and $out/history.csv"
say "open $out/frames in ParaView or OVITO: ${#frames[@]} frames, coloured by any field"
say "next: $grainray check $scene, then: $grainray run $scene --set materials.grain.friction=0.2 --out demo/smooth"
