#!/usr/bin/env bash
# Makes all that a release is, and uploads nothing: `.ci/release.sh OUT`. It ends with the commands that would.
#
#   OUT/crates      the four packages of the library, as crates.io takes them
#   OUT/wheels      Python's, for Linux on x86-64 and aarch64, glibc 2.17 and later, and for Windows on x86-64, each with its
#                   bill of materials inside
#   OUT/archives    the program with its manual pages and completions, and the C interface, for the same three
#   OUT/wasm        the program in WebAssembly, and the page that runs it in a browser
#   OUT/*.json      the bill of materials of each package (CycloneDX), OUT/SHA256SUMS of everything
#
# Rationale
# - A release is of a clean tree whose changelog has a heading with the version, and of packages without advisories. `--rehearse` needs none of
#   these.
# - Zig's linker stands for old glibcs and for the other machine; it and maturin come from PyPI by name. The GPU's kernels are committed.
# - Wheels and archives hold the kernels' machine code beside the PTX (.ci/cubins.sh). Crates do not: crates.io takes 10 MB.
#   Each kernel's code is judged before it is packed (.ci/lanes.py).
# - Packed files have run: the wheels in empty environments with the READMEs' lines, the C examples, the program, whose answers are the same
#   bytes for both machines. aarch64 runs under QEMU (.ci/aarch64.sh), Windows under Wine (.ci/windows.sh).
# - What is linked for macOS has never run, so it is no part of a release.
# - The public interface is compared with that of the newest tag `v*` by cargo-semver-checks; where there is no tag there is nothing to compare.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

rehearse=false
[ "${1:-}" != --rehearse ] || { rehearse=true; shift; }
[ $# = 1 ] || { echo "usage: .ci/release.sh [--rehearse] OUT" >&2; exit 2; }
mkdir -p "$1"
out=$(realpath "$1")
[ -z "$(ls -A "$out")" ] || { echo "release: $out is not empty" >&2; exit 2; }
version=$(sed -n 's/^version = "\(.*\)"$/\1/p' Cargo.toml | head -1)
echo "release: nearmiss $version"
if ! $rehearse; then
    [ -z "$(git status --porcelain)" ] || { echo "release: the tree has changes: commit them, or --rehearse" >&2; exit 1; }
    grep -q "^## $version\b" CHANGELOG.md || { echo "release: CHANGELOG.md has no heading ## $version" >&2; exit 1; }
fi
tools=$out/.tools
work=$out/.work
trap 'rm -rf "$tools" "$work"' EXIT
mkdir -p "$out/crates" "$out/wheels" "$out/archives" "$work"
python3 -m venv "$tools"
"$tools/bin/pip" -q install 'maturin>=1.16,<2' ziglang cargo-zigbuild twine
export PATH=$tools/bin:$PATH

# tool NAME: a tool of cargo's, built where this machine has none.
tool() { command -v "$1" >/dev/null || cargo install -q --locked --root "$tools" "$1"; }

arm=aarch64-unknown-linux-gnu
intel=x86_64-unknown-linux-gnu
[ "$(uname -m)" = x86_64 ] || { echo "release: made on x86-64, where the other half can be run" >&2; exit 1; }
rustup target add $arm 2>/dev/null || [ -d "$(rustc --print sysroot)/lib/rustlib/$arm" ] || {
    echo "release: Rust's library for $arm is not here: rustup target add $arm" >&2
    exit 1
}
.ci/aarch64.sh "$work/aarch64"

echo "=== licences, and the public interface"
tool cargo-deny
cargo deny check licenses bans sources
# The list of advisories comes from the network.
$rehearse || cargo deny check advisories
last=$(git tag --list 'v*' --sort=-version:refname | head -1)
if [ -n "$last" ]; then
    tool cargo-semver-checks
    cargo semver-checks --baseline-rev "$last" -p nearmiss -p nearmiss-kernels -p nearmiss-emulator -p nearmiss-io
else
    echo "no tag v*: nothing to compare with"
fi

echo "=== crates"
packages=(-p nearmiss-kernels -p nearmiss-emulator -p nearmiss -p nearmiss-io)
dirty=()
! $rehearse || dirty=(--allow-dirty)
cargo package --locked --no-verify "${dirty[@]}" "${packages[@]}" --target-dir "$work/package"
cp "$work"/package/package/*.crate "$out/crates/"
cargo test --locked -q --test architecture package -- --include-ignored

echo "=== machine code of the kernels"
.ci/cubins.sh "$work/nearmiss.cubins"
export NEARMISS_CUBINS=$work/nearmiss.cubins

echo "=== wheels"
for target in $intel $arm; do
    maturin build --locked --release --zig --target "$target" --compatibility manylinux2014 --manifest-path python/Cargo.toml --out "$out/wheels"
done
python3 -m venv "$work/user"
"$work/user/bin/pip" -q install "$out"/wheels/nearmiss-*x86_64.whl
# There pip is none: a wheel is an archive of what it installs.
python3 -m zipfile -e "$out"/wheels/nearmiss-*aarch64.whl "$work/site"
for page in "$PWD/README.md" "$PWD/python/README.md"; do
    "$work/user/bin/python" .ci/python_blocks.py "$page"
    PYTHONPATH=$work/site "$work/aarch64/run" python3 "$PWD/.ci/python_blocks.py" "$page"
done

echo "=== program and C interface"
for target in $intel $arm; do
    machine=${target%%-*}
    cargo zigbuild --locked --release --features cuda -p nearmiss-cli -p nearmiss-c --target "$target.2.17"
    built=$(realpath "${CARGO_TARGET_DIR:-target}")/$target/release
    program=$work/nearmiss-$version-$machine-linux
    mkdir -p "$program/man" "$program/completions"
    cp "$built/nearmiss" README.md LICENSE* CHANGELOG.md "$program/"
    through=() cross=()
    if [ $target = $arm ]; then
        through=("$work/aarch64/run")
        cross=(-DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 -DCMAKE_CROSSCOMPILING_EMULATOR="$work/aarch64/run"
            -DCMAKE_C_COMPILER="$tools/bin/python-zig;cc;-target;aarch64-linux-gnu.2.17"
            -DCMAKE_CXX_COMPILER="$tools/bin/python-zig;c++;-target;aarch64-linux-gnu.2.17"
            # Which a linker of GCC's brings by itself.
            -DCMAKE_C_STANDARD_LIBRARIES=-lunwind)
    fi
    for query in "" --discrete "--near 0.01" --distance --earliest; do
        # shellcheck disable=SC2086
        "${through[@]}" "$built/nearmiss" detect --scene cloth-ball --triangles 1000 --backend cpu $query --out "$work/answer${query%% *}-$machine.csv" >/dev/null
        cmp "$work/answer${query%% *}-$machine.csv" "$work/answer${query%% *}-x86_64.csv"
    done
    nearmiss=${nearmiss:-$built/nearmiss}
    "$nearmiss" man >"$program/man/nearmiss.1"
    # pages NAME...: a page for each command below these names.
    pages() {
        local command
        for command in $("$nearmiss" "$@" --help | awk '/^Commands:/ { inside = 1; next } inside && /^$/ { exit } inside && /^  [a-z]/ && $1 != "help" { print $1 }'); do
            "$nearmiss" man "$@" "$command" >"$program/man/$(printf '%s-' nearmiss "$@")$command.1"
        done
    }
    pages
    pages lab
    for shell in bash zsh fish; do "$nearmiss" completions $shell >"$program/completions/nearmiss.$shell"; done
    cmake -S c -B "$work/c-$machine" -DNEARMISS_LIBRARY_DIR="$built" -DCMAKE_INSTALL_LIBDIR=lib "${cross[@]}" >/dev/null
    cmake --build "$work/c-$machine" >/dev/null
    ctest --test-dir "$work/c-$machine" --output-on-failure
    cmake --install "$work/c-$machine" --prefix "$work/nearmiss-c-$version-$machine-linux" >/dev/null
    cp LICENSE* "$work/nearmiss-c-$version-$machine-linux/"
    for name in nearmiss nearmiss-c; do
        tar -C "$work" --owner=0 --group=0 --sort=name -czf "$out/archives/$name-$version-$machine-linux.tar.gz" "$name-$version-$machine-linux"
    done
done

echo "=== WebAssembly"
NEARMISS=$nearmiss .ci/wasm.sh "$out/wasm"

echo "=== Windows"
NEARMISS=$nearmiss .ci/windows.sh "$work/windows" release
mv "$work"/windows/*.whl "$out/wheels/"
mv "$work"/windows/*.zip "$out/archives/"
twine check --strict "$out"/wheels/*.whl
for wheel in "$out"/wheels/*.whl; do
    # The whole list is read: a pipe that closes early is an error too.
    python3 -m zipfile -l "$wheel" | grep 'sboms/.*cyclonedx.json' >/dev/null || { echo "release: $wheel has no bill of materials" >&2; exit 1; }
done

echo "=== bills of materials"
tool cargo-cyclonedx
cargo cyclonedx --format json --all-features --override-filename sbom
for folder in "" kernels emulator io lab cli c python; do
    bill=${folder:+$folder/}sbom.json
    [ ! -f "$bill" ] || mv "$bill" "$out/nearmiss${folder:+-$folder}.cyclonedx.json"
done

(cd "$out" && find crates wheels archives wasm ./*.json -type f | sort | xargs sha256sum >SHA256SUMS)
cat "$out/SHA256SUMS"
cat <<END

Nothing was uploaded. To do so, in this order:
  git tag -s v$version && git push origin v$version
  cargo publish -p nearmiss-kernels && cargo publish -p nearmiss-emulator && cargo publish -p nearmiss && cargo publish -p nearmiss-io
  twine upload $out/wheels/*.whl
  and attach $out/archives, $out/*.json and $out/SHA256SUMS to the release of v$version.
END
