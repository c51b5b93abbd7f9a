#!/usr/bin/env bash
# Print the rows of all tasks of frames_slurm.sh as one file: `frames_merge.sh FOLDER STEPS`.
#
# STEPS is the number of steps of the film, or of its frames for queries at rest.
set -euo pipefail

fail() { echo "frames_merge.sh: $*" >&2; exit 2; }

[ $# = 2 ] || fail "it takes a folder and a number of steps, got $# arguments"
next=0
for part in "$1"/*-*.csv; do
    name=${part##*/}
    [[ $name =~ ^([0-9]{8})-([0-9]{8})\.csv$ ]] || fail "$part is no part of a film; empty the folder"
    first=$((10#${BASH_REMATCH[1]})) end=$((10#${BASH_REMATCH[2]}))
    [ $first -ge $next ] || fail "$part overlaps another part; empty the folder, run all tasks again"
    [ $first = $next ] || fail "steps $next to $((first - 1)) are missing in $1; run their task again"
    next=$end
done
[ "$next" = "$2" ] || fail "steps $next to $(($2 - 1)) are missing in $1; run their task again"
awk 'FNR > 1 || NR == 1' "$1"/*-*.csv
