#!/usr/bin/env bash
# Everything that is measured on a GPU, in one go: agreement with the CPU, the sanitizer, times, the profiler.
#
#   benches/gpu.sh PROGRAM FRAMES OUT [agreement|figures]
#
# PROGRAM is nearmiss built with `--release --features cuda`; FRAMES a folder with the public frames cloth_ball92.ply,
# cloth_ball93.ply, n-body_t0.ply, n-body_t1.ply (without them the generated draped stands in); OUT gets the
# results. compute-sanitizer and ncu are used where they are installed. Prints a short table last. The first half is
# the self-test and the sanitizer, the second the times, tables and counters; without a fourth argument both run.
set -euo pipefail
program=$1 frames=$2 out=$3 half=${4:-both}
mkdir -p "$out"

machine() { nvidia-smi --query-gpu=name,driver_version --format=csv,noheader; }
have() { command -v "$1" >/dev/null; }

# Writes two scenes into a folder: a cloth with a thickness and exclusions, and a heap of rigid bodies that turn.
small_scenes() {
    local body
    "$program" lab scene draped --triangles 2000 --out "$1" >/dev/null
    printf '[[body]]\nmeshes = ["draped_t0.ply", "draped_t1.ply"]\nthickness = 0.001\nexclude = { ring = 2 }\n' >"$1/cloth.toml"
    for body in $(seq 0 26); do
        printf '[[body]]\nname = "body %d"\nmesh = "draped_t0.ply"\nkind = "rigid"\n' "$body"
        printf 'poses = [{ translation = [%s, %s, %s] }, { translation = [%s, %s, %s], turn = [0.1, 0.2, 0.3] }]\n' \
            "0.$((body % 3 * 3))" "0.$((body / 3 % 3 * 3))" "0.$((body / 9))" "0.$((body % 3 * 3))" "0.$((body / 3 % 3 * 2))" "0.$((body / 9))"
    done >"$1/heap.toml"
}
verdicts=()
verdict() { verdicts+=("$(printf '%-10s %s' "$1" "$2")"); }

# name, then arguments of `detect`.
scenes=()
if [ -f "$frames/cloth_ball92.ply" ]; then
    scenes+=("cloth-ball discrete|$frames/cloth_ball92.ply")
    scenes+=("cloth-ball continuous|$frames/cloth_ball92.ply $frames/cloth_ball93.ply")
    scenes+=("cloth-ball earliest|$frames/cloth_ball92.ply $frames/cloth_ball93.ply --earliest")
    scenes+=("n-body discrete|$frames/n-body_t0.ply")
    scenes+=("n-body continuous|$frames/n-body_t0.ply $frames/n-body_t1.ply")
    for apart in 1e-5 1e-4 1e-3 1e-2; do
        scenes+=("cloth-ball separation $apart|$frames/cloth_ball92.ply $frames/cloth_ball93.ply --min-separation $apart")
    done
fi
scenes+=("generated draped discrete|--scene draped --discrete")
scenes+=("generated draped continuous|--scene draped --continuous")
scenes+=("generated cloth-ball continuous|--scene cloth-ball --triangles 92000 --continuous")

if [ "$half" != figures ]; then
    # 1. GPU and CPU agree to the bit, stage by stage.
    meshes=()
    [ ! -f "$frames/cloth_ball92.ply" ] || meshes=(--mesh "$frames/cloth_ball92.ply" "$frames/cloth_ball93.ply")
    if "$program" selftest --backend cuda --triangles 4000 "${meshes[@]}" >"$out/selftest.txt" 2>&1; then
        verdict selftest "$(tail -n 1 "$out/selftest.txt")"
    else
        verdict selftest "FAILED, see $out/selftest.txt"
    fi

    # 2. Memory and shared memory, under the sanitizer.
    if have compute-sanitizer; then
        few="--scene draped --triangles 6000"
        small_scenes "$out/scenes"
        cloth=$out/scenes/cloth.toml heap=$out/scenes/heap.toml
        for tool in memcheck racecheck initcheck synccheck; do
            for query in "$few --discrete" "$few --discrete --adjacent --bounding-volume obb --traversal queue" \
                "$few --discrete --solver moller --traversal per-leaf --refit levels" \
                "$few --continuous" "$few --continuous --solver cubic-f32 --traversal per-leaf-spill --budget 4" "$few --earliest" \
                "$few --discrete --traversal queue-gtx285 --refit levels" "$few --continuous --bounding-volume obb --traversal steal" \
                "$few --discrete --traversal front --repeat 5" "$few --continuous --min-separation 0.01 --bounding-volume obb" \
                "$few --near 0.01" "$few --earliest --first-contacts" \
                "$few --continuous --min-separation 0.005 --approaching" "$cloth --near 0.01" "$cloth --continuous --min-separation 0.005" \
                "$heap --discrete" "$heap --continuous" "$heap --near 0.01" "$heap --body-pairs" "$heap --body-distances 0.05"; do
                # shellcheck disable=SC2086
                if compute-sanitizer --tool $tool --error-exitcode 9 "$program" detect $query --backend cuda \
                    >"$out/sanitizer.txt" 2>&1; then
                    verdict "$tool" "clean: ${query//"$out/scenes/"/}"
                else
                    verdict "$tool" "FAILED: ${query//"$out/scenes/"/}: $(tail -n 1 "$out/sanitizer.txt")"
                fi
            done
        done
    fi
fi
if [ "$half" = agreement ]; then
    printf '%s\n' "${verdicts[@]}" | tee "$out/verdicts-agreement.txt"
    ! grep -q FAILED "$out/verdicts-agreement.txt"
    exit
fi

# 3. Times: medians of the program's own report: device events, and `wall`, what the caller of `detect` waits for.
: >"$out/times.jsonl"
for scene in "${scenes[@]}"; do
    # shellcheck disable=SC2086
    "$program" detect ${scene#*|} --backend cuda --repeat 50 --json 2>/dev/null |
        sed "s/^{/{\"scene\":\"${scene%%|*}\",/" >>"$out/times.jsonl"
done

# 4. Every volume with every walk, and every refit, on the real frames; the thesis's tables, by what is fastest and by its own
#    machine's sizes; what a front saves. Each prints contacts and a hash, which must agree.
: >"$out/choices.jsonl"
choice() {
    # shellcheck disable=SC2086
    "$program" detect ${scene#*|} --backend cuda --repeat "$1" --json --bounding-volume "$2" --traversal "$3" --refit "$4" 2>/dev/null |
        sed "s/^{/{\"scene\":\"${scene%%|*}\",\"walk\":\"$3\",/" >>"$out/choices.jsonl"
}
for scene in "${scenes[@]}"; do
    case ${scene%%|*} in *earliest | *separation* | generated*) continue ;; esac
    for bv in aabb linear obb; do
        for walk in per-leaf-spill queue queue-gtx285 steal front; do choice 20 $bv $walk treelets; done
        choice 20 $bv queue levels
    done
done
if [ -f "$frames/cloth_ball92.ply" ]; then
    "$program" lab tables --backend cuda --scene cloth-ball --mesh "$frames/cloth_ball92.ply" "$frames/cloth_ball93.ply" \
        --table 6.12 6.13 6.14 front --bounding-volume aabb linear obb --out "$out/tables-real-cloth-ball" >"$out/tables-real-cloth-ball.txt"
    "$program" lab tables --backend cuda --scene n-body --mesh "$frames/n-body_t0.ply" "$frames/n-body_t1.ply" \
        --table 6.12 6.13 6.14 front --bounding-volume aabb linear obb --out "$out/tables-real-n-body" >"$out/tables-real-n-body.txt"
fi
"$program" lab tables --backend cuda --frames 8 --out "$out/tables" >"$out/tables.txt"
"$program" lab tables --backend cuda --frames 8 --profile gtx285 --out "$out/tables-gtx285" >"$out/tables-gtx285.txt"

# 5. The fixed list of `nearmiss lab bench` and the public frames, compared with the last figures of such a GPU in benches/results, if there
#    are some. A different answer fails.
bench=(--backend cuda --repeat 51 --out "$out")
if [ -f "$frames/cloth_ball92.ply" ]; then
    bench+=(--mesh "$frames/cloth_ball92.ply" "$frames/cloth_ball93.ply")
    bench+=(--mesh "$frames/n-body_t0.ply" "$frames/n-body_t1.ply")
fi
gpu=$(nvidia-smi --query-gpu=name --format=csv,noheader | head -n 1)
last="none earlier to compare with"
for file in "$(dirname "${BASH_SOURCE[0]}")"/results/*/bench.csv; do
    [ -f "$file" ] && sed -n 2p "$file" | grep -q "^\"\?$gpu\"\?," || continue
    # A copy, since OUT may be where it is.
    cp "$file" "$out/bench-earlier.csv"
    last="answers as in $file"
done
[ ! -f "$out/bench-earlier.csv" ] || bench+=(--against "$out/bench-earlier.csv")
if "$program" lab bench "${bench[@]}" >"$out/bench.txt" 2>"$out/bench-said.txt"; then
    verdict bench "$last"
else
    verdict bench "FAILED: $(tail -n 1 "$out/bench-said.txt")"
fi
rm -f "$out/bench-earlier.csv" "$out/bench-said.txt"

# 6. The time of kernels: one frame of each of the first two scenes, kernel by kernel.
metrics=gpu__time_duration.sum,launch__registers_per_thread,sm__warps_active.avg.pct_of_peak_sustained_active
metrics+=,smsp__thread_inst_executed_per_inst_executed.ratio,smsp__issue_active.avg.pct_of_peak_sustained_active
metrics+=,lts__t_bytes.sum
if have ncu; then
    for scene in "${scenes[@]:0:2}"; do
        name=${scene%%|*}
        # shellcheck disable=SC2086
        ncu --clock-control none --csv --page raw --metrics $metrics "$program" detect ${scene#*|} --backend cuda \
            >"$out/ncu ${name}.csv" 2>/dev/null || verdict ncu "FAILED: $name"
    done
fi

python3 - "$out" "$(machine)" <<'PYTHON'
import csv, glob, json, os, sys
out, machine = sys.argv[1:]
rows = [json.loads(line) for line in open(f"{out}/times.jsonl")]
stages = ["construct", "fit", "refit", "traverse", "balance", "narrow", "total", "order", "wall"]
with open(f"{out}/times.csv", "w", newline="") as file:
    write = csv.writer(file)
    write.writerow(["machine", "scene", "triangles", "query", "solver", "triangle_pairs", "candidates", "contacts",
                    "undecided", "hash", "bytes"] + [s + "_us" for s in stages])
    for r in rows:
        write.writerow([machine, r["scene"], r["triangles"], r["query"], r["solver"], r["triangle_pairs"],
                        r["candidates"], r["contacts"], r["undecided"], r["hash"], r["bytes"]] +
                       [round(1e3 * r["ms"][s], 1) for s in stages])
choices = [json.loads(line) for line in open(f"{out}/choices.jsonl")]
with open(f"{out}/choices.csv", "w", newline="") as file:
    write = csv.writer(file)
    write.writerow(["scene", "volume", "walk", "refit", "triangle_pairs", "contacts", "hash"] + [s + "_us" for s in stages])
    for r in choices:
        write.writerow([r["scene"], r["bv"], r["walk"], r["refit"], r["triangle_pairs"], r["contacts"], r["hash"]] +
                       [round(1e3 * r["ms"][s], 1) for s in stages])
for scene in sorted({r["scene"] for r in choices}):
    hashes = {r["hash"] for r in choices if r["scene"] == scene}
    with open(f"{out}/agree.txt", "a") as file:
        file.write(f"{scene}: {len(hashes)} hash{'' if len(hashes) == 1 else 'es: FAILED'}\n")
os.remove(f"{out}/choices.jsonl")
for path in glob.glob(f"{out}/ncu *.csv"):
    table = [row for row in csv.reader(open(path)) if len(row) > 10]
    at = {name: i for i, name in enumerate(table[0])}
    sums = {}
    for row in table[2:]:
        def of(name):
            return float(row[at[name]].replace(",", "") or 0)
        t = of("gpu__time_duration.sum") * (1e-3 if table[1][at["gpu__time_duration.sum"]].startswith("n") else 1)
        s = sums.setdefault(row[at["Kernel Name"]], [0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
        s[0] += 1
        s[1] += t
        s[2] = max(s[2], of("launch__registers_per_thread"))
        s[3] += t * of("sm__warps_active.avg.pct_of_peak_sustained_active")
        s[4] += t * of("smsp__thread_inst_executed_per_inst_executed.ratio")
        s[5] += t * of("smsp__issue_active.avg.pct_of_peak_sustained_active")
        s[6] += of("lts__t_bytes.sum")
    name = os.path.basename(path)[4:-4].replace(" ", "-")
    with open(f"{out}/kernels-{name}.csv", "w", newline="") as file:
        write = csv.writer(file)
        write.writerow(["kernel", "launches", "us", "registers", "warps_active_pct", "lanes_active", "issue_pct", "l2_mb"])
        for kernel, s in sorted(sums.items(), key=lambda item: -item[1][1]):
            write.writerow([kernel, s[0], round(s[1], 1), int(s[2])] + [round(x / s[1], 1) for x in s[3:6]] +
                           [round(s[6] / 1e6, 1)])
    os.remove(path)
print(machine)
print(f"{'scene':34}" + "".join(f"{s:>11}" for s in stages) + f"{'contacts':>10}  us")
for r in rows:
    print(f"{r['scene']:34}" + "".join(f"{1e3 * r['ms'][s]:11.1f}" for s in stages) + f"{r['contacts']:10}")
PYTHON
while read -r line; do verdict choices "$line"; done <"$out/agree.txt"
printf '%s\n' "${verdicts[@]}" | tee "$out/verdicts.txt"
! grep -q FAILED "$out/verdicts.txt"
