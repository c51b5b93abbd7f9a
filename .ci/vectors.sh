#!/usr/bin/env bash
# Are rows of features compiled to vectors?
#
#   .ci/vectors.sh PROGRAM
#
# The emulator's loop over rows (emulator/src/rows.rs) is turned into vectors by the compiler, or not: nothing but times would
# show it. PROGRAM is nearmiss, built with --release. Of every function at_once_avx2 in it some hundred instructions must use
# registers of 256 bits; there are eight, two precisions of four maps. Only where x86-64 is the machine.
set -euo pipefail

# Instructions, and those of them with such registers, of each function of a disassembly.
counted() {
    awk '/^[0-9a-f]+ <.*at_once_avx2/ { inside = 1; all = wide = 0; next }
        inside && /^$/ { print all, wide; inside = 0 }
        inside { all++; if (/%ymm/) wide++ }
        END { if (inside) print all, wide }'
}

# What is wrong with these counts, if anything.
judged() {
    local functions=0 all wide
    while read -r all wide; do
        functions=$((functions + 1))
        [ "$wide" -ge 100 ] || echo "a map of $all instructions has $wide with 256 bits"
    done
    [ "$functions" = 8 ] || echo "$functions maps, not 8"
}

# The judge is awake: it names a map without vectors, and one that is not there.
good=$(printf '900 300\n%.0s' {1..8})
[ -z "$(judged <<<"$good")" ] || { echo "vectors.sh: condemns what is right"; exit 1; }
[ "$(judged <<<"${good/300/0}")" = "a map of 900 instructions has 0 with 256 bits" ] || { echo "vectors.sh: blind"; exit 1; }
[ "$(judged <<<"${good#*$'\n'}")" = "7 maps, not 8" ] || { echo "vectors.sh: cannot count"; exit 1; }

[ "$(uname -m)" = x86_64 ] || exit 77
faults=$(objdump -d --no-show-raw-insn "$1" | counted | judged)
[ -z "$faults" ] || { echo "$faults"; exit 1; }
echo "vectors.sh: eight maps are vectors"
