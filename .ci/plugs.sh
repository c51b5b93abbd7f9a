#!/usr/bin/env bash
# The package for cudarc and cust, plugs/interop: lint, the tests that need no GPU, and its examples.
#
#   .ci/plugs.sh
#
# No CUDA is needed. cust links against libcuda: a driver that says no stands in (.ci/cuda-stub.sh), and each example must end
# with an error there. The tests of a GPU are built and reported as ignored; with a GPU, CUDA_LIBRARY_PATH set and cust:
#   cargo test --features cudarc,cust -- --ignored --test-threads 1
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../plugs/interop"

log=$(mktemp -d)
trap 'rm -rf "$log"' EXIT
cargo fmt --check
bindings=$(cargo metadata --locked --format-version 1 --all-features | python3 -c '
import json, sys
print(*[p["manifest_path"] for p in json.load(sys.stdin)["packages"] if p["name"] == "cust_raw"])')
# One place for both builds: another path would link cust again.
stub=${CARGO_TARGET_DIR:-target}/cuda-stub
../../.ci/cuda-stub.sh "$stub" "$(dirname "$bindings")/src/cuda.rs"
stub=$(realpath "$stub")
export CUDA_LIBRARY_PATH=$stub LD_LIBRARY_PATH=$stub/lib64
for features in cudarc cust cudarc,cust; do
    cargo clippy --locked --all-targets --features "$features" -- -D warnings
done
cargo test --locked --features cudarc,cust
cargo build --locked --examples --features cudarc,cust
for library in cudarc cust; do
    status=0
    "${CARGO_TARGET_DIR:-target}/debug/examples/falling_$library" >"$log/out" 2>"$log/error" || status=$?
    if [ "$status" != 1 ] || [ -s "$log/out" ] || ! grep -q '^Error: ' "$log/error"; then
        echo "falling_$library does not report a driver that says no: status $status"
        cat "$log/out" "$log/error"
        exit 1
    fi
done
