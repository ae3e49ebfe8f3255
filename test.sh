#!/usr/bin/env bash
# Builds everything and runs every test, then all but the slow ones again under the sanitizers (address, undefined).
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")"
. tools/prepare.sh

usage() {
    cat <<'END'
usage: ./test.sh [--preset NAME] [--no-sanitizers] [--filter REGEX]
  --preset NAME      cpu, cuda, asan or tsan; default: cuda where nvcc is found, else cpu
  --no-sanitizers    leave out the second run under the sanitizers
  --filter REGEX     only the tests whose names match
END
}

preset="" sanitizers=yes filter=.
while [ $# -gt 0 ]; do
    case $1 in
    --preset | --filter)
        [ $# -ge 2 ] || fail "$1 needs a value; see ./test.sh --help"
        if [ "$1" = --preset ]; then preset=$2; else filter=$2; fi
        shift
        ;;
    --no-sanitizers) sanitizers=no ;;
    -h | --help)
        usage
        exit
        ;;
    *) fail "unknown argument $1; see ./test.sh --help" ;;
    esac
    shift
done

passed=0 failed=0 skipped=0
# run_tests preset [ctest arguments]: adds to passed, failed and skipped.
run_tests() {
    local name=$1 log=build/$1.ctest.log status=0 line
    shift
    configure "$name" -D GRAINRAY_TESTS=ON || fail "configuring $name failed; the messages above say why"
    build "$name"
    say "testing build/$name"
    ctest --preset "$name" -j "$(nproc)" -R "$filter" "$@" 2>&1 | tee "$log" || status=$?
    line=$(grep -E 'tests passed, [0-9]+ tests failed out of [0-9]+' "$log") ||
        fail "ctest ran no tests in build/$name"
    local bad total idle
    idle=$(grep -c '\*\*\*Skipped' "$log") || true
    bad=$(sed -E 's/.*, ([0-9]+) tests failed out of.*/\1/' <<<"$line")
    total=$(sed -E 's/.* out of ([0-9]+).*/\1/' <<<"$line")
    passed=$((passed + total - bad - idle))
    failed=$((failed + bad))
    skipped=$((skipped + idle))
    [ "$status" -eq 0 ] || [ "$bad" -gt 0 ] || fail "ctest failed in build/$name; see $log"
}

install_missing "${LIBRARY_PACKAGES[@]}" "libgtest-dev:the tests"
[ -n "$preset" ] || preset=$(suitable_preset)
run_tests "$preset"
if [ "$sanitizers" = yes ] && [ "$preset" != asan ] && [ "$preset" != tsan ]; then
    run_tests asan -E Slow
fi
[ "$skipped" -eq 0 ] || say "$skipped skipped: they need a GPU that CUDA can use, or a library that is not here"
printf '%d passed, %d failed\n' "$passed" "$failed"
[ "$failed" -eq 0 ]
