#!/usr/bin/env bash
# Assembles a PTX text as the driver would, without a card: what ptxas refuses, no card runs.
#
#   .ci/ptxas.sh FILE.ptx [ARCH]      ARCH: sm_80 unless told
#
# Prints registers, stack, spills and shared memory of each kernel, and makes sure that no product and sum became one
# operation: the code is the same where that is forbidden. ptxas is $PTXAS, or the one on the PATH or in
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
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
arch=${2:-sm_80}
"$ptxas" -arch="$arch" --verbose -o /dev/null "$1" 2>&1 | sed -n "s/^ptxas info *: \(Compiling entry.*\)/\1/p;
    s/^ptxas info *: \(Used.*\)/    \1/p; /spill/p; /error\|warning\|fatal/p"

# Whether the assembler contracts products and sums of a text where it may: then forbidding it makes other code.
contracts() {
    "$ptxas" -arch="$arch" --fmad=true -o "$work/may" "$1" && "$ptxas" -arch="$arch" --fmad=false -o "$work/not" "$1" ||
        { echo "ptxas.sh: cannot assemble $1" >&2; exit 1; }
    ! cmp -s "$work/may" "$work/not"
}

# One product and one sum, with and without the mark that forbids contraction: the comparison sees the difference.
for mark in .rn ""; do
    cat >"$work/two$mark.ptx" <<END
.version 7.5
.target sm_80
.address_size 64
.visible .entry two(.param .u64 p)
{
    .reg .f32 %f<4>;
    .reg .b64 %q;
    ld.param.u64 %q, [p];
    ld.f32 %f0, [%q];
    ld.f32 %f1, [%q+4];
    ld.f32 %f2, [%q+8];
    mul$mark.f32 %f3, %f0, %f1;
    add$mark.f32 %f3, %f3, %f2;
    st.f32 [%q], %f3;
    ret;
}
END
done
contracts "$work/two.ptx" || { echo "ptxas.sh: a contraction is not noticed" >&2; exit 1; }
if contracts "$work/two.rn.ptx" || contracts "$1"; then
    echo "ptxas.sh: error: a product and a sum were contracted" >&2
    exit 1
fi
echo "contracted: nothing (the same code with --fmad=false)"
