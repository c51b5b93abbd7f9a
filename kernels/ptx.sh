#!/usr/bin/env bash
# Compiles the kernels to PTX. This is the one home of that command: build.rs, CI and people call it.
#
#   ptx.sh fetch        gets a device compiler, if this machine has none; installs nothing, needs no root
#   ptx.sh compiler     prints the device compiler's path and version, or says how to get one
#   ptx.sh build OUT    compiles the kernels to OUT, compressed by zstd
#   ptx.sh stamp        prints the stamp of the sources: what the committed PTX must carry
#   ptx.sh registers    prints the kernels whose registers are limited, and the limits
#   ptx.sh large        prints the beginnings of the names of kernels with blocks of 512 lanes
#   ptx.sh check        is kernels/nearmiss.ptx.zst made from these sources?
#
# A device compiler is an rustc that has the core library of nvptx64-nvidia-cuda, or the sources to build it
# from. Looked for in this order: $NEARMISS_DEVICE_RUSTC (a path), rustup's nightly and default toolchains, the
# folder that `fetch` fills. docs/internals/toolchain.md has the details.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
target=nvptx64-nvidia-cuda
cache=${XDG_CACHE_HOME:-${HOME:-$root/target}/.cache}/nearmiss/device-compiler
committed=$root/kernels/nearmiss.ptx.zst

say() { echo "ptx.sh: $*" >&2; }
die() { say "$*"; exit 1; }

# Whatever a surrounding cargo, rustup or shell has set must not reach the compile; where cargo keeps its
# registry and how it gets to the network may stay.
scrub() {
    local name
    for name in $(compgen -e); do
        case $name in
            CARGO_HOME | CARGO_HTTP_* | CARGO_NET_* | CARGO_REGISTR*) ;;
            CARGO | CARGO_* | RUSTC | RUSTC_* | RUSTFLAGS | RUSTDOCFLAGS | RUSTUP_TOOLCHAIN | MAKEFLAGS) unset "$name" ;;
            DEBUG | HOST | NUM_JOBS | OPT_LEVEL | OUT_DIR | PROFILE | TARGET | LD_LIBRARY_PATH) unset "$name" ;;
        esac
    done
}

# The lines of a file that are compiled: none that is blank or only a comment.
compiled() { LC_ALL=C sed '/^[[:space:]]*\(\/\/.*\)\{0,1\}$/d' "$1"; }

# One line a file, "digest  name", in the order of the names' bytes; the stamp digests those lines. A digest is that of the
# file's compiled lines. build.rs computes the same; tests/gpu/ptx.rs compares.
stamp() {
    (
        cd "$root"
        { echo kernels/Cargo.toml && find kernels/src -name '*.rs' -type f; } | LC_ALL=C sort |
            while read -r name; do
                printf '%s  %s\n' "$(compiled "$name" | sha256sum | cut -c1-64)" "$name"
            done | sha256sum | cut -c1-16
    )
}

sysroot() { (cd / && "$1" --print sysroot 2>/dev/null); }
has_core() { compgen -G "$1/lib/rustlib/$target/lib/libcore-*.rlib" >/dev/null; }
has_source() { [ -f "$1/lib/rustlib/src/rust/library/core/src/lib.rs" ]; }
can_compile() { local home && home=$(sysroot "$1") && { has_core "$home" || has_source "$home"; }; }

candidates() {
    if [ -n "${NEARMISS_DEVICE_RUSTC:-}" ]; then
        echo "$NEARMISS_DEVICE_RUSTC"
        return
    fi
    if command -v rustup >/dev/null; then
        rustup which --toolchain nightly rustc 2>/dev/null || true
        (cd / && rustup which rustc 2>/dev/null) || true
    else
        command -v rustc || true
    fi
    echo "$cache/rustc"
}

compiler() {
    local rustc
    while read -r rustc; do
        if [ -x "$rustc" ] && can_compile "$rustc"; then
            echo "$rustc"
            return
        fi
    done < <(candidates)
    return 1
}

need_compiler() {
    compiler || die "no device compiler here. Either of these gets one:
    rustup toolchain install nightly -c rust-src
    kernels/ptx.sh fetch        (Debian: unpacks the distribution's packages into $cache)"
}

# apt without root: its lists and its cache live in our folder.
apt_here() {
    local tool=$1
    shift
    "$tool" -o Dir::State="$cache/apt" -o Dir::State::status=/var/lib/dpkg/status -o Dir::Cache="$cache/apt/cache" \
        -o Debug::NoLocking=1 -o APT::Sandbox::User="$(id -un)" "$@"
}

installed() { dpkg-query -W -f '${Status}' "$1" 2>/dev/null | grep -q '^install ok installed'; }
depends() { apt_here apt-cache depends --no-recommends --no-suggests "$1" | sed -n 's/^ *|\?Depends: \([^<]*\)$/\1/p'; }

# The package and all it needs that is not installed, each once.
closure() {
    local seen=" " queue=("$@") package
    while [ ${#queue[@]} -gt 0 ]; do
        package=${queue[0]}
        queue=("${queue[@]:1}")
        case $seen in *" $package "*) continue ;; esac
        seen+="$package "
        installed "$package" && continue
        echo "$package"
        mapfile -t -O ${#queue[@]} queue < <(depends "$package")
    done
}

fetch() {
    local found
    if found=$(compiler); then
        say "found $found"
        return
    fi
    command -v apt-get >/dev/null && command -v dpkg >/dev/null ||
        die "this is not a Debian system; try: rustup toolchain install nightly -c rust-src"
    say "unpacking Debian's rustc-web into $cache"
    rm -rf "$cache"
    mkdir -p "$cache"/apt/lists/partial "$cache"/apt/cache/archives/partial "$cache"/packages
    apt_here apt-get -qq update
    local std packages
    std=$(depends libstd-rust-web-dev | grep '^libstd-rust-web-[0-9]' | head -n 1)
    # rustc-web itself also depends on gcc and the like, which cargo needs in any case: not fetched here.
    mapfile -t packages < <(closure "$std")
    (cd "$cache/packages" && apt_here apt-get -qq download rustc-web libstd-rust-web-dev rust-web-src "${packages[@]}")
    local package
    for package in "$cache"/packages/*.deb; do
        dpkg -x "$package" "$cache"
    done
    rm -rf "$cache/packages" "$cache/apt"
    cat >"$cache/rustc" <<'WRAPPER'
#!/bin/sh
# Runs the unpacked compiler on its own libraries.
here=$(dirname "$(readlink -f "$0")")
libraries=$(echo "$here"/usr/lib/*-linux-gnu)
LD_LIBRARY_PATH=$libraries${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH} exec "$here/usr/bin/rustc" "$@"
WRAPPER
    chmod +x "$cache/rustc"
    can_compile "$cache/rustc" || die "the unpacked compiler does not run: $("$cache/rustc" --version 2>&1)"
    say "got $("$cache/rustc" --version)"
}

build() {
    local out=$1 rustc cargo home version sources targets
    command -v zstd >/dev/null || die "zstd is missing: it compresses the PTX. Install the package zstd"
    targets=${NEARMISS_PTX_TARGET_DIR:-${CARGO_TARGET_DIR:-$root/target}/ptx}
    rustc=$(need_compiler)
    cargo=$(dirname "$rustc")/cargo # the toolchain's own, where it has one: it knows how to build its core
    [ -x "$cargo" ] || cargo=cargo
    scrub
    home=$(sysroot "$rustc")
    version=$(cd / && "$rustc" --version)
    sources=$(stamp)

    # A toolchain that has core for the GPU uses it; otherwise core is built from source (half a minute, once).
    local std=()
    has_core "$home" || std=(-Zbuild-std=core)

    # No path of this machine may land in the PTX. The linker is skipped: with fat LTO rustc's own output is whole.
    local flags=(
        -Ctarget-cpu=sm_80 -Ctarget-feature=+ptx75 -Clinker=true
        "--remap-path-prefix=${CARGO_HOME:-$HOME/.cargo}/registry/src=registry"
        "--remap-path-prefix=$home/lib/rustlib/src/rust=rust"
        "--remap-path-prefix=$(readlink -f "$home/lib/rustlib/src/rust" || true)=rust"
        "--remap-path-prefix=$root=nearmiss"
    )
    # Unstable features of the kernels crate alone, given here so that its sources do not name the target.
    local crate=(
        '-Zcrate-attr=feature(abi_ptx,asm_experimental_arch,link_llvm_intrinsics,stdarch_nvptx)' -Ainternal_features
    )
    (
        cd "$root"
        export NEARMISS_STAMP=$sources RUSTC=$rustc RUSTC_BOOTSTRAP=1
        CARGO_ENCODED_RUSTFLAGS=$(printf '%s\x1f' "${flags[@]}")
        export CARGO_ENCODED_RUSTFLAGS=${CARGO_ENCODED_RUSTFLAGS%$'\x1f'}
        "$cargo" rustc -p nearmiss-kernels --lib --crate-type cdylib --profile ptx --target "$target" \
            --target-dir "$targets" "${std[@]}" -- --emit=asm "${crate[@]}"
    ) >&2

    local text=$targets/$target/ptx/deps/nearmiss_kernels.s
    [ -s "$text" ] || die "the compiler left no PTX at $text"
    { echo "// nearmiss kernels, sources $sources, $version" && cat "$text"; } | zstd -q -19 >"$out.part"
    mv "$out.part" "$out"
}

# The lines of the kernel table with a limit; the host gives it to the driver (`Entry::REGISTERS`).
registers() { sed -n 's/^ *\([a-z0-9_]*\): .*, registers = \([0-9]*\);$/\1 \2/p' "$root/kernels/src/entry.rs"; }

# Kernels with blocks of 512 lanes, by the beginnings of their names: a GPU has 128 registers for each of these.
large() { echo "fit_tiles fit_bodies fit_moving_bodies refit_tiles balance_copy"; }

first_line() { zstd -dcq "$1" | sed -n 1p; }
stamp_of() { first_line "$1" | sed -n 's/^.*, sources \([0-9a-f]*\),.*$/\1/p'; }
compiler_of() { first_line "$1" | sed -n 's/^.*, sources [0-9a-f]*, //p'; }
# The text without lines of the sources: a comment moves those, and changes nothing else.
code_of() { zstd -dcq "$1" | sed '/^[[:space:]]*\.\(loc\|file\)[[:space:]]/d'; }

check() {
    local now then rustc fresh
    now=$(stamp)
    then=$(stamp_of "$committed")
    [ "$now" = "$then" ] ||
        die "$committed was made from sources $then; they are now $now. Run: kernels/ptx.sh build kernels/nearmiss.ptx.zst"
    say "kernels/nearmiss.ptx.zst carries the stamp of its sources, $now"
    rustc=$(compiler) || { say "not recompiled: no device compiler here"; return; }
    fresh=$(mktemp)
    build "$fresh"
    if [ "$(compiler_of "$fresh")" != "$(compiler_of "$committed")" ]; then
        say "recompiled, not compared: this is $(compiler_of "$fresh"), that was $(compiler_of "$committed")"
    elif cmp -s <(code_of "$fresh") <(code_of "$committed"); then
        say "recompiled by the same compiler: the same code"
    else
        diff <(code_of "$committed") <(code_of "$fresh") | head -n 20 >&2 || true
        rm -f "$fresh"
        die "recompiled by the same compiler: other code. Run: kernels/ptx.sh build kernels/nearmiss.ptx.zst"
    fi
    rm -f "$fresh"
}

case "${1:-} $#" in
    "fetch 1") fetch ;;
    "compiler 1") rustc=$(need_compiler) && echo "$rustc" && (cd / && "$rustc" --version) ;;
    "build 2") build "$2" ;;
    "stamp 1") stamp ;;
    "registers 1") registers ;;
    "large 1") large ;;
    "check 1") check ;;
    *) sed -n '2,10s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2 ;;
esac
