#!/usr/bin/env bash
# The C interface: builds the library, compiles the header as C99 and as C++, builds the examples without a warning, and runs them.
# The shared library shows nothing but names that begin with nearmiss_.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

target=$(mkdir -p "${CARGO_TARGET_DIR:-target}" && cd "${CARGO_TARGET_DIR:-target}" && pwd)
cargo build --locked -p nearmiss-c
strict=(-Wall -Wextra -Wpedantic -Werror -fsyntax-only)
cc -x c -std=c99 "${strict[@]}" c/include/nearmiss.h 2>&1
c++ -x c++ -std=c++11 "${strict[@]}" c/include/nearmiss.h 2>&1
foreign=$(nm -D --defined-only "$target/debug/libnearmiss_c.so" | awk '{ print $NF }' | grep -v '^nearmiss_' || true)
[ -z "$foreign" ] || { echo "libnearmiss_c.so shows names that are not its own: $foreign"; exit 1; }
cmake -S c -B "$target/c" -DNEARMISS_LIBRARY_DIR="$target/debug" \
    -DCMAKE_C_FLAGS="-Wall -Wextra -Werror" -DCMAKE_CXX_FLAGS="-Wall -Wextra -Werror"
cmake --build "$target/c"
ctest --test-dir "$target/c" --output-on-failure
