#!/usr/bin/env bash
# Makes OUT/nearmiss.wasm and the page OUT/nearmiss.html: `plugs/wasm/build.sh OUT`. Needs npm; package-lock.json has the versions.
#
# Rationale
# - simd128: all browsers have it since 2023. Without it kernels take one number at a time.
# - The stack is as large as that of a program on Linux. The linker's own choice is 1 MiB.
set -euo pipefail
[ $# = 1 ] || { echo "usage: plugs/wasm/build.sh OUT" >&2; exit 2; }
mkdir -p "$1"
out=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")"

target=wasm32-wasip1
rustup target add $target 2>/dev/null || [ -d "$(rustc --print sysroot)/lib/rustlib/$target" ] || {
    echo "wasm: Rust's library for $target is not here: rustup target add $target" >&2
    exit 77
}
export CARGO_TARGET_WASM32_WASIP1_RUSTFLAGS="-C target-feature=+simd128 -C link-arg=-zstack-size=8388608"
cargo build --locked --profile wasm -p nearmiss-cli --target $target
built=$(cargo metadata --format-version 1 --no-deps | sed 's/.*"target_directory":"\([^"]*\)".*/\1/')
cp "$built/$target/wasm/nearmiss.wasm" "$out/"
npm ci --silent --no-audit --no-fund
node build.mjs "$out/nearmiss.wasm" "$out/nearmiss.html"
ls -l "$out"
