# shellcheck shell=bash
# Sourced by demo.sh and test.sh: messages, missing packages, the preset that suits this machine, configuring.
# Works on Debian 12 and Ubuntu 24.04; elsewhere it installs nothing and lets CMake name what is missing.

say() { printf '==> %s\n' "$*"; }
fail() {
    printf 'grainray: %s\n' "$*" >&2
    exit 1
}

# package:what it is for
# shellcheck disable=SC2034  # read by the scripts that source this file
readonly LIBRARY_PACKAGES=(
    "libtbb-dev:threads" "libtomlplusplus-dev:reading scenes" "libcli11-dev:the command line" "libfmt-dev:messages"
    "nlohmann-json3-dev:summary.json" "zlib1g-dev:compressed frames" "libpng-dev:pictures" "libhdf5-dev:checkpoints"
    "libembree-dev:ray tracing on the CPU" "libassimp-dev:meshes"
)

package_installed() { [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

# install_missing package:purpose ...: the compiler and build tools, and the packages named.
install_missing() {
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        say "no apt-get here: nothing is installed; CONTRIBUTING.md lists what the build needs"
        return
    fi
    local missing=() entry
    command -v g++ >/dev/null || missing+=("g++:the C++20 compiler")
    command -v cmake >/dev/null || missing+=("cmake:configuring the build")
    command -v ninja >/dev/null || missing+=("ninja-build:building")
    for entry in "$@"; do
        package_installed "${entry%%:*}" || missing+=("$entry")
    done
    [ ${#missing[@]} -gt 0 ] || return 0

    local packages=("${missing[@]%%:*}") root=()
    say "installing with apt-get, because the build needs them:"
    for entry in "${missing[@]}"; do printf '      %-22s %s\n' "${entry%%:*}" "${entry#*:}"; done
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null ||
            fail "installing needs root and there is no sudo; as root, run: apt-get install ${packages[*]}"
        root=(sudo)
    fi
    local log
    log=$(mktemp)
    "${root[@]}" apt-get update >"$log" 2>&1 || say "apt-get update had trouble; trying with the package lists at hand"
    "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${packages[@]}" \
        >>"$log" 2>&1 || {
        tail -n 15 "$log" >&2
        fail "apt-get could not install: ${packages[*]} (all of its output: $log)"
    }
    rm -f "$log"
}

# suitable_preset: prints cuda where an nvcc that knows C++20 is found, else cpu.
suitable_preset() {
    local nvcc version
    nvcc=$(command -v nvcc || true)
    [ -n "$nvcc" ] || nvcc=/usr/local/cuda/bin/nvcc
    if [ ! -x "$nvcc" ]; then
        say "no nvcc on PATH or in /usr/local/cuda: building for the CPU" >&2
        printf 'cpu\n'
        return
    fi
    version=$("$nvcc" --version | sed -n 's/.*release \([0-9]*\).*/\1/p')
    if [ "${version:-0}" -lt 12 ]; then
        say "$nvcc is older than CUDA 12, which C++20 needs: building for the CPU" >&2
        printf 'cpu\n'
        return
    fi
    printf 'cuda\n'
}

# configure preset [cmake arguments]: quiet unless it fails.
configure() {
    local log=build/$1.configure.log
    mkdir -p build
    say "configuring build/$1"
    cmake --preset "$@" >"$log" 2>&1 || {
        tail -n 25 "$log" >&2
        return 1
    }
}

# build preset [targets]
build() {
    local preset=$1
    shift
    say "building build/$preset"
    cmake --build "build/$preset" ${1:+--target "$@"} || fail "the build failed; the first error above says why"
}
