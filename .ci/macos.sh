#!/usr/bin/env bash
# nearmiss for macOS on arm64 and x86-64, linked on Linux by Zig: the program, the C interface and Python's wheel.
#
#   .ci/macos.sh
#
# Rationale
# - Nothing is run: there is no macOS here. Each file must be of its machine, and load libraries of /usr/lib alone.
# - Zig brings the names of macOS's C library, and no frameworks. Code that needs one does not link.
# - Nothing is run, so nothing is optimised.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
python3 -m venv "$work/tools"
"$work/tools/bin/pip" -q install ziglang cargo-zigbuild 'maturin>=1.8,<2' macholib
export PATH=$work/tools/bin:$PATH CARGO_PROFILE_DEV_OPT_LEVEL=0

# loads FILE MACHINE: whether a file is of a machine and loads libraries of the system alone; prints what is wrong.
loads() {
    local found
    found=$(python3 -m macholib dump "$1")
    grep "arch='$2'" <<<"$found" >/dev/null || { echo "$1 is not of $2: $found"; return 1; }
    found=$(grep -P '^\t' <<<"$found" | grep -v '^\s*/usr/lib/' || true)
    [ -z "$found" ] || { echo "$1 loads $found, which macOS does not bring"; return 1; }
}

# A library that macOS does not bring is noticed, and so is another machine.
echo 'int planted(void) { return 0; }' >"$work/planted.c"
echo 'int planted(void); int main(void) { return planted(); }' >"$work/main.c"
zig=(python3 -m ziglang cc -target aarch64-macos)
"${zig[@]}" -shared "$work/planted.c" -o "$work/libplanted.dylib"
"${zig[@]}" "$work/main.c" "$work/libplanted.dylib" -o "$work/main"
! loads "$work/main" ARM64 >/dev/null || { echo "a library that macOS does not bring is not noticed"; exit 1; }
loads "$work/libplanted.dylib" ARM64
! loads "$work/libplanted.dylib" x86_64 >/dev/null || { echo "a file of another machine is not noticed"; exit 1; }

for triple in aarch64-apple-darwin x86_64-apple-darwin; do
    rustup target add $triple 2>/dev/null || [ -d "$(rustc --print sysroot)/lib/rustlib/$triple" ] || {
        echo "macos: Rust's library for $triple is not here: rustup target add $triple" >&2
        exit 77
    }
    machine=x86_64
    [ $triple = x86_64-apple-darwin ] || machine=ARM64
    # Feature `cuda` has no driver to find there.
    cargo zigbuild --locked -p nearmiss-cli -p nearmiss-c --target $triple
    built=$target/$triple/debug
    loads "$built/nearmiss" $machine
    loads "$built/libnearmiss_c.dylib" $machine
    grep -aF "@rpath/libnearmiss_c.dylib" "$built/libnearmiss_c.dylib" >/dev/null || { echo "libnearmiss_c.dylib has no name for programs"; exit 1; }
    for kind in dylib a; do
        python3 -m ziglang cc -target "${triple%%-*}-macos" -Ic/include c/examples/self_intersections.c "$built/libnearmiss_c.$kind" -o "$work/example"
    done
    maturin build --locked --profile dev --zig --target $triple --no-default-features --manifest-path python/Cargo.toml --out "$work/wheels"
done
for wheel in "$work"/wheels/*.whl; do
    python3 -m zipfile -e "$wheel" "$work/site"
    [[ $wheel == *arm64* ]] && machine=ARM64 || machine=x86_64
    loads "$work/site/nearmiss/_native.abi3.so" $machine
done
