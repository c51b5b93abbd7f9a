#!/usr/bin/env bash
# Coverage-guided fuzzing, all targets of fuzz/.
#
#   fuzz.sh [SECONDS]   builds the targets and runs each that long (default 20), from a new seed, which is printed
#
# First each judge is shown to be awake: with NEARMISS_PLANT_A_FAULT set a target changes answers before they are judged,
# and must fail. An input that fails is written to fuzz/artifacts/TARGET and printed; keep it in tests/finds/TARGET, where
# tests/frames/fuzz_pairs.rs runs it again. tests/finds are also what the fuzzer begins with; what it learns stays in fuzz/corpus.
#
# Needs no nightly compiler and no cargo-fuzz: coverage is an LLVM pass that stable rustc passes on, and libfuzzer-sys
# brings libFuzzer as C++. `cargo +nightly fuzz run TARGET` does the same, and watches memory too.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../fuzz"

seconds=${1:-20}
host=$(rustc -vV | sed -n 's/^host: //p')
target_dir=${CARGO_TARGET_DIR:-target}/fuzz
coverage="-Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4
    -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table
    -Cllvm-args=-sanitizer-coverage-trace-compares --cfg fuzzing"
# A target named, so that what runs while building is not instrumented.
env RUSTFLAGS="$(tr -s '\n ' ' ' <<<"$coverage")" CARGO_INCREMENTAL=0 CARGO_TARGET_DIR="$target_dir" \
    CARGO_PROFILE_RELEASE_DEBUG=none CARGO_PROFILE_RELEASE_OPT_LEVEL=2 CARGO_PROFILE_RELEASE_CODEGEN_UNITS=16 \
    CARGO_PROFILE_RELEASE_DEBUG_ASSERTIONS=true CARGO_PROFILE_RELEASE_OVERFLOW_CHECKS=true \
    cargo build --release --target "$host"
programs=$(cd "$target_dir/$host/release" && pwd)

log=$(mktemp)
trap 'rm -f "$log" "$log".*' EXIT
failed=0
# Each with the most bytes of an input.
targets="discrete_pair 60
continuous_pair 80
scene 120
near 120
distance 120
readers 2000"
for target in discrete_pair continuous_pair scene near distance; do
    if NEARMISS_PLANT_A_FAULT=1 timeout 60 "$programs/$target" -max_total_time=30 -artifact_prefix=/dev/null >"$log" 2>&1 ||
        ! grep -aq 'panicked at' "$log"; then
        echo "fuzz: $target does not notice a planted fault"
        failed=1
    else
        echo "fuzz: $target notices a planted fault: $(grep -aA1 'panicked at' "$log" | tail -n 1 | cut -c1-100)"
    fi
done
run() {
    local target=$1 kept=../tests/finds/$1
    mkdir -p "corpus/$target" "artifacts/$target"
    [ -d "$kept" ] || kept=
    timeout $((seconds + 60)) "$programs/$target" -max_total_time="$seconds" -max_len="$2" -len_control=0 -timeout=20 \
        -artifact_prefix="artifacts/$target/" -print_final_stats=1 "corpus/$target" $kept
}
# Two at a time: a fuzzer takes one processor.
while read -r target length; do
    [ "$(jobs -rp | wc -l)" -lt 2 ] || wait -n || true
    (run "$target" "$length" >"$log.$target" 2>&1 || echo "$?" >"$log.$target.status") &
done <<<"$targets"
wait
while read -r target _; do
    status=$(cat "$log.$target.status" 2>/dev/null || echo 0)
    seed=$(sed -n 's/^INFO: Seed: //p' "$log.$target")
    if [ "$status" = 0 ]; then
        echo "fuzz: $target: nothing found in $(sed -n 's/^stat::number_of_executed_units: *//p' "$log.$target") runs, seed $seed"
    else
        echo "fuzz: $target FAILED ($status), seed $seed"
        grep -aA3 -E 'panicked at|ERROR: libFuzzer|Base64|Test unit written' "$log.$target" | cut -c1-2000
        failed=1
    fi
done <<<"$targets"
exit $failed
