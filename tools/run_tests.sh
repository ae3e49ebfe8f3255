#!/usr/bin/env bash
# Runs the test programs of a packaged folder, on a machine with neither CMake nor a compiler. GTEST_FILTER chooses cases.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"

log=$(mktemp)
trap 'rm -f "$log"' EXIT
passed=0 failed=0 skipped=0
# count WORDS: the number before WORDS in gtest's summary, or 0.
count() { sed -nE "s/^\[ +$1 +\] ([0-9]+) tests?[.,].*/\1/p" "$log" | tail -n 1 | grep . || echo 0; }

for program in bin/*_test; do
    printf '==> %s\n' "$program"
    status=0
    "$program" >"$log" 2>&1 || status=$?
    good=$(count PASSED) bad=$(count FAILED) idle=$(count SKIPPED)
    [ "$status" -eq 0 ] || [ "$bad" -gt 0 ] || bad=1  # it crashed before its summary
    [ "$bad" -eq 0 ] || cat "$log"
    passed=$((passed + good)) failed=$((failed + bad)) skipped=$((skipped + idle))
done
printf '%d passed, %d failed, %d skipped\n' "$passed" "$failed" "$skipped"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
