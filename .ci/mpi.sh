#!/usr/bin/env bash
# The package for MPI, plugs/mpi: lint, its tests on 1 to 4 ranks of this machine, and its example.
#
#   .ci/mpi.sh
#
# An MPI with mpicc and mpirun, and libclang for its bindings, must be installed: on Debian openmpi-bin, libopenmpi-dev and
# libclang-dev. The tests start themselves by mpirun. The example must find the same on any number of ranks as on one machine,
# and end with its reason if a file is missing.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../plugs/mpi"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cargo fmt --check
cargo clippy --locked --all-targets -- -D warnings
RUSTDOCFLAGS="-D warnings" cargo doc --locked --no-deps
cargo test --locked
cargo build --locked --example contacts

# A cloth of three frames above a ground, and a box that turns.
python3 - "$work" <<'EOF'
import math, sys
def grid(name, side, place):
    with open(f"{sys.argv[1]}/{name}.obj", "w") as f:
        for i in range(side * side):
            print("v", *place(i % side / (side - 1), i // side / (side - 1)), file=f)
        for v in (i + j * side + 1 for j in range(side - 1) for i in range(side - 1)):
            print("f", v, v + 1, v + side + 1, v + side, file=f)
for frame in range(3):
    grid(f"cloth_{frame}", 30, lambda x, y: (x, y, 0.2 - 0.12 * frame + 0.05 * math.sin(9 * x) * math.cos(7 * y)))
grid("ground", 8, lambda x, y: (1.2 * x - 0.1, 1.2 * y - 0.1, 0))
grid("plate", 6, lambda x, y: (x - 0.5, 0, y - 0.5))
with open(f"{sys.argv[1]}/scene.toml", "w") as f:
    f.write('''[[body]]
name = "cloth"
meshes = "cloth_*.obj"
[[body]]
mesh = "ground.obj"
kind = "fixed"
[[body]]
mesh = "plate.obj"
kind = "rigid"
poses = [{ translation = [0.5, 0.5, 0.3] }, { translation = [0.5, 0.5, 0.25], turn = [0, 0, 2] }, { translation = [0.5, 0.5, 0.2], turn = [1, 0, 1] }]
''')
EOF
contacts=$(realpath "${CARGO_TARGET_DIR:-target}")/debug/examples/contacts
over() {
    local ranks=$1
    shift
    timeout 600 mpirun --allow-run-as-root --oversubscribe --bind-to none -n "$ranks" "$contacts" "$@"
}
for options in "--continuous" "--continuous --bodies" "--earliest" "--discrete" "--near 0.01"; do
    for ranks in 1 2 3 4; do
        # shellcheck disable=SC2086 # options are words
        over "$ranks" $options --check "$work/scene.toml" >"$work/out"
        grep -q 'equal to one machine' "$work/out" || { echo "no comparison with $options"; cat "$work/out"; exit 1; }
        grep -o 'hash .*;' "$work/out" >"$work/hashes.$ranks"
        cmp "$work/hashes.1" "$work/hashes.$ranks"
    done
    echo "$options: $(tr '\n' ' ' <"$work/hashes.1")"
done

rm "$work/ground.obj"
status=0
over 3 "$work/scene.toml" >"$work/out" 2>&1 || status=$?
if [ "$status" != 3 ] || ! grep -q 'rank 0: .*ground.obj: cannot be read' "$work/out"; then
    echo "a missing file does not end all ranks with its name: status $status"
    cat "$work/out"
    exit 1
fi
