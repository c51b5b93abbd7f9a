#!/usr/bin/env bash
# Makes machine code from the committed PTX, for a release: the driver then compiles nothing at a kernel's first use.
#
#   .ci/cubins.sh OUT [ARCH...]      ARCH: sm_80 sm_86 sm_89 sm_90 sm_100 sm_120 unless told
#
# Build with NEARMISS_CUBINS=$PWD/OUT and feature `cuda`. host/device/code/cubins.rs describes the file and chooses from it.
# Rationale
# - The assembler is the last of CUDA 12: its code is loaded by every driver for CUDA 12 and later. An older one gets PTX.
# - A file of code a kernel, packed on its own: a program unpacks what it uses.
# - Lines of the sources are left out. They are two thirds of the bytes, and the code is the same.
# - Code that .ci/lanes.py does not accept is left out. A GPU then gets the kernel's code for an older one, or PTX.
# Six architectures take ten minutes of two cores. Exit status 77: no assembler or no disassembler to be had.
set -euo pipefail
[ $# -ge 1 ] || { sed -n '2,4s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2; }
out=$(realpath -m "$1")
shift
archs=("$@")
[ ${#archs[@]} -gt 0 ] || archs=(sm_80 sm_86 sm_89 sm_90 sm_100 sm_120)
cd "$(dirname "${BASH_SOURCE[0]}")/.."
ptx=kernels/nearmiss.ptx.zst
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
. .ci/nvidia.sh
die() { echo "cubins.sh: error: $*" >&2; exit 1; }

ptxas=$(fetch "$nvcc_12" ptxas) || { echo "cubins.sh: no assembler: python3 with pip is needed" >&2; exit 77; }
nvdisasm=$(fetch "$nvdisasm_newest" nvdisasm || installed nvdisasm) || { echo "cubins.sh: no disassembler" >&2; exit 77; }
zstd -dcq "$ptx" | sed '/^[[:space:]]*\.\(loc\|file\)[[:space:]]/d' >"$work/text.ptx"
# Limits of registers come from the sources.
head -n 1 "$work/text.ptx" | grep -q ", sources $(kernels/ptx.sh stamp)," || die "$ptx is stale: kernels/ptx.sh build $ptx"

# Each kernel with all functions; what it does not call is dropped.
mkdir "$work/entry" "$work/code"
awk -v to="$work" '
    /^\.visible \.entry / { name = $3; sub(/\(.*/, "", name); file = to "/entry/" name }
    { print > (file ? file : to "/shared.ptx") }
    /^}/ { if (file) close(file); file = "" }
' "$work/text.ptx"
(cd "$work/entry" && printf '%s\n' *) | LC_ALL=C sort >"$work/kernels"
[ "$(wc -l <"$work/kernels")" = "$(grep -c '^\.visible \.entry ' "$work/text.ptx")" ] || die "$ptx has kernels that were not found"
kernels/ptx.sh registers >"$work/limits"
while read -r name limit; do
    grep -qx "$name" "$work/kernels" || die "$ptx has no kernel $name, whose registers are limited to $limit"
done <"$work/limits"

# assemble ARCH KERNEL: its packed code in $work/code; or the judge's words there, in a file `.left`.
assemble() {
    local file=$work/code/$1.$2 limit
    limit=$(awk -v name="$2" '$1 == name { print $2 }' "$work/limits")
    cat "$work/shared.ptx" "$work/entry/$2" >"$file.ptx"
    "$ptxas" -arch="$1" --entry "$2" ${limit:+--maxrregcount="$limit"} -o "$file.cubin" "$file.ptx" >&2 || return 1
    "$nvdisasm" -c "$file.cubin" >"$file.sass" 2>/dev/null || return 1
    if ! python3 .ci/lanes.py "$1" "$file.sass" >"$file.said"; then
        mv "$file.said" "$file.left"
        return
    fi
    grep -q "^$1: 1 kernels, " "$file.said" || { echo "$1 $2: the judge has not seen it" >&2; return 1; }
    zstd -q -19 --no-check "$file.cubin" -o "$file"
    rm "$file".{ptx,cubin,sass,said}
    printf '%s %s %s %s\n' "${1#sm_}" "$2" "${limit:-0}" "$(stat -c %s "$file")" >"$file.line"
}
export -f assemble
export ptxas nvdisasm work
for arch in "${archs[@]}"; do sed "s/^/$arch /" "$work/kernels"; done >"$work/jobs"
xargs -P "$(nproc)" -L 1 bash -euo pipefail -c 'assemble "$@"' assemble <"$work/jobs" || die "a kernel is not assembled"

left=$(cat "$work"/code/*.left 2>/dev/null | grep ' may find lanes apart' | grep -v ' kernels, ' || true)
[ -z "$left" ] || printf 'cubins.sh: left out: %s\n' "$left" >&2
all=$(wc -l <"$work/jobs")
for arch in "${archs[@]}"; do
    while read -r name; do [ ! -f "$work/code/$arch.$name.line" ] || echo "$arch $name"; done <"$work/kernels"
done >"$work/packed"
[ $((50 * (all - $(wc -l <"$work/packed")))) -le "$all" ] || die "too much is left out"
mv "$work/packed" "$work/jobs"
while read -r arch name; do cat "$work/code/$arch.$name"; done <"$work/jobs" >"$work/frames"
{
    echo "nearmiss machine code 1"
    echo "ptx $(sha256sum <"$ptx" | cut -c1-64)"
    echo "code $(sha256sum <"$work/frames" | cut -c1-64)"
    echo "assembler $("$ptxas" --version | sed -n 's/.* V\([0-9.]*\)$/\1/p')"
    while read -r arch name; do cat "$work/code/$arch.$name.line"; done <"$work/jobs"
    echo
    cat "$work/frames"
} >"$out.part"
mv "$out.part" "$out"
bytes=$(stat -c %s "$out")
echo "cubins.sh: $(wc -l <"$work/jobs") files of code for ${archs[*]}, $bytes bytes in $out" >&2
# What a wheel may grow by.
[ "$bytes" -le 15000000 ] || die "$out has more than 15 MB"
