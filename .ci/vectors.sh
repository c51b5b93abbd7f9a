#!/usr/bin/env bash
# Are rows of features compiled to vectors?
#
#   .ci/vectors.sh PROGRAM
#
# The emulator's loop over rows (emulator/src/rows.rs) is turned into vectors by the compiler, or not: nothing but times would
# show it. PROGRAM is nearmiss, built with --release. In every function at_once_avx2 of it additions, multiplications,
# divisions, least and greatest are of packed numbers, but for a few before the loop; wide registers would say less, since a map
# from f64 to f32 has four of each, and those of f32 in narrow ones. There are 43: eighteen maps, six of them with a thickness, each
# of positions in f32 and in f64, and of instances planes, for triangles and for bodies, planes in a step, heights of bodies apart,
# boxes of tiles, at rest and in a step, and directions of bodies that turn. The smallest, the boxes at the start of a step, has 24
# in f32. Seventeen are mixed: directions and heights have a root if there is a gap, which no
# vector has, so that three of four directions are mostly of single numbers; and of all signs at once a half is. Only if x86-64
# is the machine.
set -euo pipefail

# Arithmetic of packed and of single numbers, of each function of a disassembly.
counted() {
    awk '/^[0-9a-f]+ <.*at_once_avx2/ { inside = 1; packed = single = 0; next }
        inside && /^$/ { print packed, single; inside = 0 }
        inside && $2 ~ /^v(add|sub|mul|div|max|min)p[sd]$/ { packed++ }
        inside && $2 ~ /^v(add|sub|mul|div|max|min)s[sd]$/ { single++ }
        END { if (inside) print packed, single }'
}

# The fault of these counts, if any.
judged() {
    local functions=0 mixed=0 packed single
    while read -r packed single; do
        functions=$((functions + 1))
        if [ "$packed" -ge 40 ] && [ $((20 * single)) -gt "$packed" ] && [ "$single" -le $((4 * packed)) ]; then
            mixed=$((mixed + 1))
        elif [ "$packed" -lt 20 ] || [ $((20 * single)) -gt "$packed" ]; then
            echo "a map has $packed operations of packed numbers and $single of single ones"
        fi
    done
    [ "$mixed" -le 17 ] || echo "$mixed maps are mixed, not 17"
    [ "$functions" = 43 ] || echo "$functions maps, not 43"
}

# The judge is awake: it names a map without vectors, one that has few, one too many that is mixed, and one that is not there.
good=$(printf '300 6\n%.0s' {1..26}; printf '300 80\n%.0s' {1..17})
[ -z "$(judged <<<"$good")" ] || { echo "vectors.sh: condemns what is right"; exit 1; }
for bad in '0 300' '30 300'; do
    [ "$(judged <<<"${good/300 6/$bad}")" = "a map has ${bad% *} operations of packed numbers and ${bad#* } of single ones" ] ||
        { echo "vectors.sh: blind to $bad"; exit 1; }
done
[ "$(judged <<<"${good/300 6/300 80}")" = "18 maps are mixed, not 17" ] || { echo "vectors.sh: blind to a mixed map"; exit 1; }
[ "$(judged <<<"${good#*$'\n'}")" = "42 maps, not 43" ] || { echo "vectors.sh: cannot count"; exit 1; }

[ "$(uname -m)" = x86_64 ] || exit 77
faults=$(objdump -d --no-show-raw-insn "$1" | counted | judged)
[ -z "$faults" ] || { echo "$faults"; exit 1; }
echo "vectors.sh: 26 maps are vectors, 17 in part"
