#!/usr/bin/env bash
# The C interface: builds the library, compiles the header as C99 and as C++, builds the examples without a warning, and runs them.
# Then it is installed, and found there by a project of its own. The shared library shows nothing but names that begin with nearmiss_.
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

# As its users have it.
there=$(mktemp -d)
trap 'rm -rf "$there"' EXIT
cmake --install "$target/c" --prefix "$there/installed"
mkdir "$there/user"
cp c/examples/self_intersections.c "$there/user/"
cat >"$there/user/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.16)
project(user C)
find_package(nearmiss 0.1 REQUIRED)
foreach(kind nearmiss static)
    add_executable(by_${kind} self_intersections.c)
    target_link_libraries(by_${kind} nearmiss::${kind})
endforeach()
END
cmake -S "$there/user" -B "$there/build" -DCMAKE_PREFIX_PATH="$there/installed"
cmake --build "$there/build"
for kind in nearmiss static; do
    "$there/build/by_$kind" | grep -x "3 pairs"
done
