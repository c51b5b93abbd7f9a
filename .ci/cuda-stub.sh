#!/usr/bin/env bash
# Makes a libcuda that says no.
#
#   .ci/cuda-stub.sh DIR [BINDINGS]
#
# DIR/lib64/libcuda.so.1 defines every function that host/device/cuda/driver.rs calls, and those that BINDINGS, a file of
# Rust, declares; each answers CUDA_ERROR_STUB_LIBRARY.
# Put DIR/lib64 on LD_LIBRARY_PATH, and the program meets a driver that does not work: it must say so in a sentence.
# Programs that link against libcuda, as those with cust, are built with CUDA_LIBRARY_PATH=DIR.
set -euo pipefail

[ $# = 1 ] || [ $# = 2 ] || { echo "usage: .ci/cuda-stub.sh DIR [BINDINGS]" >&2; exit 2; }
mkdir -p "$1/lib64"
dir=$(cd "$1" && pwd)
bindings=${2:-/dev/null}
[ "$bindings" = /dev/null ] || bindings=$(realpath "$bindings")
cd "$(dirname "${BASH_SOURCE[0]}")/.."

grep -ohE '^ +(pub fn )?cu[A-Z][A-Za-z0-9_]*\(' host/device/cuda/driver.rs "$bindings" | sed 's/pub fn//' | tr -d ' (' | sort -u |
    sed 's/.*/int &(void) { return 34; }/' >"$dir/stub.c"
count=$(wc -l <"$dir/stub.c")
[ "$count" -gt 30 ] || { echo "cuda-stub.sh: only $count functions found in host/device/cuda/driver.rs" >&2; exit 1; }

"${CC:-cc}" -shared -fPIC -w -Wl,-soname,libcuda.so.1 -o "$dir/lib64/libcuda.so.1" "$dir/stub.c"
ln -sf libcuda.so.1 "$dir/lib64/libcuda.so"
echo "cuda-stub.sh: $count functions in $dir/lib64/libcuda.so.1"
