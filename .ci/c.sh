#!/usr/bin/env bash
# The C interface: builds the library, compiles the header as C99 and as C++, builds the examples without a warning, and runs them.
# Then it is installed, moved, and found there by projects of CMake and by pkg-config. The shared library shows nothing but names that
# begin with nearmiss_. As it is installed it has its SONAME, links under that and its short name, and no debug information. Programs
# that find another header than the library's call nothing else of it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

target=$(mkdir -p "${CARGO_TARGET_DIR:-target}" && cd "${CARGO_TARGET_DIR:-target}" && pwd)
# As the tests have it: -p would choose other features of what others need, which is a second build of all.
cargo build --locked --workspace --features cuda --lib --bins --examples
strict=(-Wall -Wextra -Wpedantic -Werror -fsyntax-only)
cc -x c -std=c99 "${strict[@]}" c/include/nearmiss.h 2>&1
c++ -x c++ -std=c++11 "${strict[@]}" c/include/nearmiss.h 2>&1
foreign=$(nm -D --defined-only "$target/debug/libnearmiss_c.so" | awk '{ print $NF }' | grep -v '^nearmiss_' || true)
[ -z "$foreign" ] || { echo "libnearmiss_c.so shows names that are not its own: $foreign"; exit 1; }
cmake -S c -B "$target/c" -DNEARMISS_LIBRARY_DIR="$target/debug" \
    -DCMAKE_C_FLAGS="-Wall -Wextra -Werror" -DCMAKE_CXX_FLAGS="-Wall -Wextra -Werror"
cmake --build "$target/c"
ctest --test-dir "$target/c" --output-on-failure

# With a library of another header, all else of which traps.
there=$(mktemp -d)
trap 'rm -rf "$there"' EXIT
mkdir "$there/other"
cat >"$there/other/library.c" <<'END'
#include "nearmiss.h"
uint32_t nearmiss_abi(void) { return NEARMISS_ABI + 1; }
const char *nearmiss_version(void) { return "of another header"; }
END
cp c/examples/*.c c/examples/*.cpp "$there/other/"
awk '/^```/ { inside = /^```c$/; next } inside' docs/for/c.md >"$there/other/page.c"
cat >"$there/other/planted.c" <<'END'
#include "nearmiss.h"
int main(void)
{
    NearmissBody body = nearmiss_body();
    return nearmiss_abi() != NEARMISS_ABI ? 1 : (int)body.kind;
}
END
cc -c -Ic/include "$there/other/library.c" -o "$there/other/library.o"
# compares PROGRAM: whether it compares before it calls anything else.
compares() {
    local compiler=cc status=0
    [[ $1 != *.cpp ]] || compiler=c++
    "$compiler" -c -Ic/include "$1" -o "$1.o"
    nm -u "$1.o" | awk '/ nearmiss_/ && !/ nearmiss_(abi|version)$/ { printf "void %s(void) { __builtin_trap(); }\n", $NF }' >"$1.traps.c"
    cc -c "$1.traps.c" -o "$1.traps.o"
    "$compiler" "$1.o" "$1.traps.o" "$there/other/library.o" -o "$1.out" -lm -ldl
    "$1.out" >"$1.said" 2>&1 || status=$?
    [ $status = 1 ] && grep -q "the header is not that of the library of another header" "$1.said"
}
for program in "$there"/other/{self_intersections.c,on_device.c,cloth.cpp,cloth_xpbd.cpp,page.c}; do
    compares "$program" || { echo "${program##*/} does not compare nearmiss_abi() first: $(cat "$program.said")"; exit 1; }
done
! compares "$there/other/planted.c" || { echo "a program that calls before it compares is not noticed"; exit 1; }

# As its users have it: installed at another place than was configured, and moved from there.
cmake --install "$target/c" --prefix "$there/first"
mv "$there/first" "$there/installed"
soname=libnearmiss_c.so.$(sed -n 's/^version = "\(0\.[0-9]*\|[1-9][0-9]*\)\..*/\1/p' Cargo.toml | head -1)
# installed FOLDER: whether its libraries are as a system has them; says what is not so.
installed() {
    local libraries file
    libraries=$(dirname "$(find "$1" -name libnearmiss_c.a)")
    readelf -d "$libraries/libnearmiss_c.so" | grep -F "Library soname: [$soname]" >/dev/null || { echo "no SONAME $soname"; return 1; }
    { [ -L "$libraries/libnearmiss_c.so" ] && [ -L "$libraries/$soname" ] && [ -f "$libraries/$soname" ]; } \
        || { echo "no links under libnearmiss_c.so and $soname"; return 1; }
    for file in "$libraries"/libnearmiss_c.*; do
        ! readelf -SW "$file" 2>/dev/null | grep '[.]debug_' >/dev/null || { echo "$file has debug information"; return 1; }
    done
}
installed "$there/installed"
# Debug information, and a library without its SONAME: each is noticed.
mkdir -p "$there/planted/lib"
cp -P "$(dirname "$(find "$there/installed" -name libnearmiss_c.a)")"/libnearmiss_c.* "$there/planted/lib/"
installed "$there/planted"
cc -g -c -Ic/include "$there/other/library.c" -o "$there/other/debug.o"
ar q "$there/planted/lib/libnearmiss_c.a" "$there/other/debug.o" 2>/dev/null
! installed "$there/planted" >/dev/null || { echo "debug information is not noticed"; exit 1; }
cc -shared "$there/other/library.o" -o "$there/planted/lib/$(readlink "$there/planted/lib/$soname")"
! installed "$there/planted" >/dev/null || { echo "a library without a SONAME is not noticed"; exit 1; }
mkdir "$there/user" "$there/without"
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
readelf -d "$there/build/by_nearmiss" | grep -F "Shared library: [$soname]"
# If threads are not found, a project that does not need nearmiss continues.
cat >"$there/without/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.16)
project(without C)
find_package(nearmiss 0.1 QUIET)
if(nearmiss_FOUND)
    message(FATAL_ERROR "found, without what it needs")
endif()
message(STATUS "goes on without")
END
cmake -S "$there/without" -B "$there/without/build" -DCMAKE_PREFIX_PATH="$there/installed" -DCMAKE_DISABLE_FIND_PACKAGE_Threads=ON \
    | grep "goes on without"
# By pkg-config: moved, in a folder of any depth, and in one that is named whole.
by_pkg_config() {
    local file
    file=$(find "$1" -name nearmiss.pc)
    export PKG_CONFIG_PATH=${file%/*}
    read -ra flags <<<"$(pkg-config --cflags --libs nearmiss)"
    cc "$there/user/self_intersections.c" "${flags[@]}" -o "$1/by_pkg_config"
    LD_LIBRARY_PATH=$(pkg-config --variable=libdir nearmiss) "$1/by_pkg_config" | grep -x "3 pairs"
}
by_pkg_config "$there/installed"
for libdir in lib/of/a-machine "$there/whole/lib"; do
    cmake -S c -B "$there/deep" -DNEARMISS_LIBRARY_DIR="$target/debug" -DCMAKE_INSTALL_PREFIX="$there/whole" -DCMAKE_INSTALL_LIBDIR="$libdir" >/dev/null
    cmake --install "$there/deep"
    by_pkg_config "$there/whole"
    rm -r "$there/whole"
done
