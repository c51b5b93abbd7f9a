#!/usr/bin/env bash
# A task of a Slurm array: its share of the frames of a film, by `nearmiss detect`.
#
#   sbatch --array=0-7 frames_slurm.sh FOLDER 8 [OPTION OF DETECT]... -- FILE...
#   frames_merge.sh FOLDER STEPS >rows.csv
#
# Each task writes FOLDER/FIRST-END.csv: rows of steps FIRST to END - 1. Merged, these are the bytes
# that one `nearmiss detect OPTION... FILE... --out rows.csv` writes. A task that failed can run
# again by itself: `sbatch --array=3 frames_slurm.sh FOLDER 8 ...`.
#
#SBATCH --job-name=nearmiss
#SBATCH --cpus-per-task=1
set -euo pipefail

fail() { echo "frames_slurm.sh: $*" >&2; exit 2; }

[ $# -ge 2 ] || fail "it takes a folder and a number of tasks, got $# arguments"
folder=$1 tasks=$2
shift 2
task=${SLURM_ARRAY_TASK_ID:?is not set; run this script by sbatch --array}
options=()
while [ $# -gt 0 ] && [ "$1" != -- ]; do
    options+=("$1")
    shift
done
[ $# -ge 1 ] || fail "-- is missing; write it between options and files"
shift
files=("$@")

# A step needs the frame at its end too; a query at rest needs its frame alone.
overlap=1 tolerance=no
for option in "${options[@]}"; do
    case $option in
        --tolerance | --tolerance=*) tolerance=yes ;;
        --weld) fail "--weld merges what coincides in all frames of a task; weld the files first" ;;
        --discrete | --near | --near=* | --distance | --body-pairs | --body-distances*) overlap=0 ;;
        --continuous | --earliest) overlap=1 ;;
    esac
done
# The default is that of the first frame, and each task begins at another.
[ $overlap = 0 ] || [ $tolerance = yes ] || fail "steps need --tolerance L; detect --json prints the default"
steps=$((${#files[@]} - overlap))
[ "$task" -lt "$tasks" ] || fail "numbers of tasks must be below $tasks, got $task; see --array"
# Two steps are a film, and two frames at rest.
[ $((steps / tasks)) -ge 2 ] ||
    fail "${#files[@]} files are too few for $tasks tasks; use at most $((steps / 2))"
first=$((task * steps / tasks))
end=$(((task + 1) * steps / tasks))

mkdir -p "$folder"
part=$folder/$(printf '%08d-%08d' $first $end)
rm -f "$part.csv"
nearmiss detect "${files[@]:first:end - first + overlap}" "${options[@]}" \
    --threads "${SLURM_CPUS_PER_TASK:-1}" --out "$part.some.csv"
# Steps count from the first file of the film.
awk -v first=$first 'NR > 1 { step = $0 + first; sub(/^[0-9]+/, step) } { print }' \
    "$part.some.csv" >"$part.tmp"
rm "$part.some.csv"
mv "$part.tmp" "$part.csv"
