#!/usr/bin/env bash
# Assembles a PTX text as the driver would, without a card: what ptxas refuses, no card runs.
#
#   .ci/ptxas.sh FILE.ptx [ARCH]      ARCH: sm_80 unless told
#
# Prints registers, stack, spills and shared memory of each kernel. ptxas is $PTXAS, or the one on the PATH or in
# /usr/local/cuda, or else NVIDIA's Python package, unpacked into the cache (80 MB). Exit status 77: no ptxas to be had.
set -euo pipefail

[ $# -ge 1 ] || { echo "usage: .ci/ptxas.sh FILE.ptx [ARCH]" >&2; exit 2; }
package=nvidia-cuda-nvcc-cu12==12.9.86
cache=${XDG_CACHE_HOME:-$HOME/.cache}/nearmiss/ptxas

find_ptxas() {
    local candidate
    for candidate in "${PTXAS:-}" "$(command -v ptxas || true)" /usr/local/cuda/bin/ptxas "$cache/ptxas"; do
        [ -x "$candidate" ] && echo "$candidate" && return
    done
    return 1
}

fetch_ptxas() {
    local wheels
    wheels=$(mktemp -d)
    python3 -m pip download --quiet --no-deps --only-binary=:all: --dest "$wheels" "$package" >&2 &&
        python3 -m zipfile -e "$wheels"/*.whl "$wheels/all" &&
        mkdir -p "$cache" && cp "$wheels/all/nvidia/cuda_nvcc/bin/ptxas" "$cache/ptxas" && chmod +x "$cache/ptxas"
    local got=$?
    rm -rf "$wheels"
    return "$got"
}

ptxas=$(find_ptxas) || { fetch_ptxas && ptxas=$cache/ptxas; } ||
    { echo "ptxas.sh: no ptxas: install a CUDA toolkit, or python3 with pip" >&2; exit 77; }
"$ptxas" --version | grep release
"$ptxas" -arch="${2:-sm_80}" --verbose -o /dev/null "$1" 2>&1 | sed -n "s/^ptxas info *: \(Compiling entry.*\)/\1/p;
    s/^ptxas info *: \(Used.*\)/    \1/p; /spill/p; /error\|warning\|fatal/p"
