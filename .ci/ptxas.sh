#!/usr/bin/env bash
# Assembles a PTX text as the driver would, without a GPU: what ptxas refuses, no GPU runs. And reads the machine code.
#
#   .ci/ptxas.sh [--newest] FILE.ptx[.zst] [ARCH...]      ARCH: sm_80 sm_90 sm_100 by default
#
# Prints registers, stack, spills and shared memory of each kernel for the first ARCH, and makes sure
# - that no product and sum became one operation: the code is the same where that is forbidden;
# - that the lanes of a warp are together wherever they must be (.ci/lanes.py says what is proven), for each ARCH.
# Each is done by two assemblers, NVIDIA's Python packages, unpacked into the cache (150 MB); without them by $PTXAS, or the one
# on the PATH or in /usr/local/cuda. With --newest the newer of the two does it alone. Each check is first shown a text with a fault
# in it. Two assemblers and three ARCHs take five minutes on two cores; --newest and one ARCH, one.
# Exit status 77: no assembler or no disassembler to be had.
set -euo pipefail

newest=false
[ "${1:-}" != --newest ] || { newest=true; shift; }
[ $# -ge 1 ] || { echo "usage: .ci/ptxas.sh [--newest] FILE.ptx[.zst] [ARCH...]" >&2; exit 2; }
text=$1
shift
archs=("$@")
[ ${#archs[@]} -gt 0 ] || archs=(sm_80 sm_90 sm_100)
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
. "$here/nvidia.sh"
packages=("$nvcc_12" "$nvcc_newest")
! $newest || packages=("${packages[-1]}")
if [[ $text == *.zst ]]; then
    zstd -dq "$text" -o "$work/text.ptx"
    text=$work/text.ptx
fi

assemblers=()
for package in "${packages[@]}"; do
    found=$(fetch "$package" ptxas) && assemblers+=("$found")
done
if [ ${#assemblers[@]} = 0 ]; then
    if [ -x "${PTXAS:-}" ]; then found=$PTXAS; else found=$(installed ptxas) || found=; fi
    [ -z "$found" ] || assemblers=("$found")
fi
nvdisasm=$(fetch "$nvdisasm_newest" nvdisasm || installed nvdisasm) || nvdisasm=
if [ ${#assemblers[@]} = 0 ] || [ -z "$nvdisasm" ]; then
    echo "ptxas.sh: no ptxas or no nvdisasm: install a CUDA toolkit, or python3 with pip" >&2
    exit 77
fi
die() { echo "ptxas.sh: error: $*" >&2; exit 1; }

# disassembled PTXAS ARCH TEXT NAME OPTION...: the machine code of a text in words, in NAME.sass. (Files of code are not compared:
# from 13 on they hold the options.)
disassembled() {
    local ptxas=$1 arch=$2 from=$3 name=$work/$4
    shift 4
    "$ptxas" -arch="$arch" "$@" -o "$name.cubin" "$from" >"$name.log" 2>&1 &&
        "$nvdisasm" -c "$name.cubin" >"$name.sass" 2>"$name.noise" || { tail -n 3 "$name.log" "$name.noise" >"$name.said"; return 1; }
}

# The judges are shown a fault. One product and one sum, with and without the mark that forbids contraction:
for mark in .rn ""; do
    cat >"$work/two$mark.ptx" <<END
.version 7.5
.target sm_80
.address_size 64
.visible .entry two(.param .u64 p)
{
    .reg .f32 %f<4>;
    .reg .b64 %q;
    ld.param.b64 %q, [p];
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
# A shuffle behind a loop that the lanes leave at different turns and at two places; the assembler puts a guard before it. The
# judge must accept that, and name the kernel when the guard is taken out of the code, or waits for half of the lanes only.
cat >"$work/apart.ptx" <<'END'
.version 7.5
.target sm_80
.address_size 64
.visible .entry apart(.param .u64 p)
{
    .reg .pred %p;
    .reg .b32 %x, %y;
    .reg .b64 %q;
    ld.param.u64 %q, [p];
    mov.u32 %x, %tid.x;
    setp.gt.u32 %p, %x, 20;
    @%p bra END;
TURN:
    ld.volatile.global.b32 %y, [%q];
    add.u32 %x, %x, %y;
    and.b32 %y, %x, 7;
    setp.eq.u32 %p, %y, 3;
    @%p bra FOUND;
    setp.lt.u32 %p, %x, 1000;
    @%p bra TURN;
    mov.u32 %x, 5;
    bra END;
FOUND:
    ld.volatile.global.b32 %x, [%q+8];
END:
    shfl.sync.up.b32 %y, %x, 1, 0, -1;
    st.global.b32 [%q], %y;
    ret;
}
END
for ptxas in "${assemblers[@]}"; do
    for arch in "${archs[@]}"; do
        disassembled "$ptxas" "$arch" "$work/apart.ptx" apart || die "$(cat "$work/apart.said")"
        python3 "$here/lanes.py" "guarded" "$work/apart.sass" >"$work/said" || die "a guard is not seen: $(cat "$work/said")"
        for fault in 's/(WARPSYNC|BRA\.DIV|BRA\.CONV|BSYNC)[^;]*/NOP/' 's/WARPSYNC[^;]*/WARPSYNC 0xffff/; s/(BRA\.DIV|BSYNC)[^;]*/NOP/' \
            's/WARPSYNC[^;]*/WARPSYNC.EXCLUSIVE 0xffffffff/; s/(BRA\.DIV|BSYNC)[^;]*/NOP/'; do
            sed -E "$fault" "$work/apart.sass" >"$work/planted.sass"
            if python3 "$here/lanes.py" planted "$work/planted.sass" >"$work/said" ||
                ! grep -q "^planted: apart: SHFL" "$work/said"; then
                die "a shuffle of lanes that may be apart is not noticed ($arch): $(cat "$work/said")"
            fi
        done
    done
    for mark in .rn ""; do
        for fmad in true false; do
            disassembled "$ptxas" "${archs[0]}" "$work/two$mark.ptx" "two$mark.$fmad" --fmad=$fmad || die "$(cat "$work"/two*.said)"
        done
    done
    ! cmp -s "$work/two.true.sass" "$work/two.false.sass" || die "a contraction is not noticed"
    cmp -s "$work/two.rn.true.sass" "$work/two.rn.false.sass" || die "a marked product and sum were contracted"
done

# One assembly with all its options; its messages go to a file. And one with contraction forbidden.
examine() {
    disassembled "$1" "$2" "$text" "$3" --verbose && python3 "$here/lanes.py" "$3" "$work/$3.sass" >"$work/$3.said"
}
forbidden() { disassembled "$1" "$2" "$text" "$3" --fmad=false; }

jobs=()
for ptxas in "${assemblers[@]}"; do
    release=$("$ptxas" --version | sed -n 's/.*release \([0-9.]*\),.*/\1/p')
    echo "ptxas $release"
    for arch in "${archs[@]}"; do jobs+=("examine $ptxas $arch ptxas-$release-$arch"); done
done
# Whether marks forbid a contraction does not depend on the assembler's age: both have judged the planted one above.
jobs+=("forbidden $ptxas ${archs[0]} ptxas-$release-${archs[0]}-not")
failed=0
running=0
for job in "${jobs[@]}"; do
    if [ $running -ge "$(nproc)" ]; then
        wait -n || failed=1
        running=$((running - 1))
    fi
    $job &
    running=$((running + 1))
done
while [ $running -gt 0 ]; do
    wait -n || failed=1
    running=$((running - 1))
done

first=$(echo "${jobs[0]}" | cut -d' ' -f4)
sed -n "s/^.*info *: \(Compiling entry.*\)/\1/p; s/^.*info *: \(Used.*\)/    \1/p; /spill/p; /error\|warning\|fatal/p" "$work/$first.log"
cat "$work"/ptxas-*.said 2>/dev/null || true
[ $failed = 0 ] || die "an assembly fails, or lanes may be apart"
# A block of 512 lanes has 128 registers for each, or its launch fails. Those with a limit get no more.
too_large() {
    awk -v large="$("$here/../kernels/ptx.sh" large)" -v limited="$("$here/../kernels/ptx.sh" registers | tr '\n' ' ')" '
        /Compiling entry function/ { split($0, part, "\047"); name = part[2] }
        /Used [0-9]+ registers/ {
            match($0, /Used [0-9]+/); used = substr($0, RSTART + 5, RLENGTH - 5) + 0
            n = split(large, starts, " ")
            for (i = 1; i <= n; i++)
                if (index(name, starts[i]) == 1 && used > 128 && index(" " limited, " " name " ") == 0) print name, used
        }' "$1"
}
printf "Compiling entry function 'fit_tiles_planted' for 'sm_80'\nUsed 129 registers\n" >"$work/planted.log"
[ "$(too_large "$work/planted.log")" = "fit_tiles_planted 129" ] || die "a block without registers is not noticed"
for log in "$work"/ptxas-*.log; do
    said=$(too_large "$log")
    [ -z "$said" ] || die "too many registers for a block of 512 lanes: $said"
done
for other in "$work"/ptxas-*-not.sass; do
    cmp -s "${other%-not.sass}.sass" "$other" || die "a product and a sum were contracted"
done
echo "contracted: nothing (the same code with --fmad=false)"
