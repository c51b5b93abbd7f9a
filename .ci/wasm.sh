#!/usr/bin/env bash
# The program for WebAssembly and the page that runs it, compared with the native program: status, text, and files byte by byte.
#
#   .ci/wasm.sh [OUT]
#
# OUT gets both, or they are deleted. Needs npm and Chromium; builds the native program, unless NEARMISS names one. Answers are
# compared under Node, by the package's own host and by that of Node, then on the page in headless Chromium.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
out=$(realpath -m "${1:-$work}")
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
# As the tests have it: -p would choose other features of what others need, which is a second build of all.
[ -n "${NEARMISS:-}" ] || cargo build --locked --lib --bins --examples
plugs/wasm/build.sh "$out"
cd plugs/wasm
NEARMISS=${NEARMISS:-$target/debug/nearmiss} NEARMISS_WASM=$out node --no-warnings --test test/*.test.js
