#!/usr/bin/env bash
# Print the rows of all tasks of frames_slurm.sh as one file: `frames_merge.sh FOLDER STEPS`.
#
# STEPS is the number of steps of the film, or of its frames for queries at rest.
set -euo pipefail

fail() { echo "frames_merge.sh: $*" >&2; exit 2; }
missing() { fail "steps $next to $(($1 - 1)) are missing in $folder; run their task again"; }

[ $# = 2 ] || fail "it takes a folder and a number of steps, got $# arguments"
[[ $2 =~ ^[1-9][0-9]*$ ]] || fail "STEPS must be a number of at least 1, got $2"
folder=$1 next=0
shopt -s nullglob
for part in "$folder"/*-*.csv; do
    name=${part##*/}
    [[ $name =~ ^([0-9]{8})-([0-9]{8})\.csv$ ]] || fail "$part is no part of a film; remove it"
    first=$((10#${BASH_REMATCH[1]})) end=$((10#${BASH_REMATCH[2]}))
    [ $first -ge $next ] || fail "$part overlaps another part; empty the folder"
    [ $first = $next ] || missing "$first"
    next=$end
done
[ $next -le "$2" ] || fail "STEPS must be $next as in $folder, got $2"
[ $next = "$2" ] || missing "$2"
awk 'FNR > 1 || NR == 1' "$folder"/*-*.csv
