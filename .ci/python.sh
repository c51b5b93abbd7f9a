#!/usr/bin/env bash
# The Python module as a user gets it: a wheel, installed into an empty environment, which runs its README and the book.
# `.ci/python.sh [all]`: with `all` also the tests that need large libraries, with those alone.
#
# Rationale
# - Without `all` there are ipctk, trimesh, coal, FCL and libigl. Warp, JAX, torch, Blender, Dask and Ray are a gigabyte and
#   minutes: they are for the nightly part. Their tests say that they were skipped.
# - The profile is cargo's `dev`, which is optimised: what is tested is what is built anyway.
# - The environment is new each time; nothing of this machine's Python is seen.
# - Tests that need a GPU say that they were skipped. They run where there is one: see docs/internals/toolchain.md.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

python3 -m venv "$folder/builder"
"$folder/builder/bin/pip" -q install 'maturin>=1.8,<2'
"$folder/builder/bin/maturin" build --locked --profile dev --manifest-path python/Cargo.toml --out "$folder/wheels"
python3 -m venv "$folder/user"
"$folder/user/bin/pip" -q install "$folder"/wheels/nearmiss-*.whl
readelf -d "$folder"/user/lib/python3*/site-packages/nearmiss/_native*.so | grep -E 'libcuda|libpython' \
    && { echo "the module is linked against what a stranger may lack"; exit 1; }
# Pages about a library need it; the others run without.
plugs="docs/for/ipctk.md docs/for/trimesh.md"
for page in README.md python/README.md $(grep -rl --include='*.md' '^```python$' docs | sort); do
    case " $plugs " in *" $page "*) continue ;; esac
    "$folder/user/bin/python" .ci/python_blocks.py "$page"
done
"$folder/user/bin/pip" -q install 'pytest>=8' mypy ipctk coal trimesh python-fcl libigl
for page in $plugs; do
    "$folder/user/bin/python" .ci/python_blocks.py "$page"
done
for library in ipctk coal trimesh libigl; do
    "$folder/user/bin/python" "python/examples/from_$library.py"
done
"$folder/user/bin/python" python/examples/ipctk_with_nearmiss.py
# trimesh's own tests are in its source package alone.
trimesh=trimesh-$("$folder/user/bin/python" -c 'import trimesh; print(trimesh.__version__)')
"$folder/user/bin/pip" -q download --no-binary trimesh --no-deps --dest "$folder" "${trimesh/-/==}"
tar -xzf "$folder/$trimesh.tar.gz" -C "$folder"
"$folder/user/bin/python" -m mypy --no-error-summary python/tests/typed.py
# As the tests have it: -p would choose other features of what others need, which is a second build.
cargo build --locked --workspace --features cuda --bins --examples
export NEARMISS_PROGRAM=$target/debug/nearmiss
NEARMISS_TRIMESH_TESTS=$folder/$trimesh/tests/test_collision.py \
    "$folder/user/bin/python" -m pytest -q -rs --durations=10 python
[ "${1:-}" = all ] || exit 0

"$folder/user/bin/pip" -q install warp-lang jax
"$folder/user/bin/pip" -q --retries 0 install --index-url https://download.pytorch.org/whl/cpu torch 2>/dev/null \
    || "$folder/user/bin/pip" -q install torch
"$folder/user/bin/python" -m pytest -q -rs python/tests/test_{arrays,gpu,gpus,libraries,loops}.py
# Blender is large, needs an old numpy, and exists for few versions of Python.
wheel=$(echo "$folder"/wheels/nearmiss-*.whl)
python3 -m venv "$folder/blender"
if "$folder/blender/bin/pip" -q install "$wheel" 'pytest>=8' bpy; then
    NEARMISS_WHEEL=$wheel "$folder/blender/bin/python" -m pytest -q -rs python/tests/test_blender*.py
else
    echo "not run: python/tests/test_blender.py, as bpy has no wheel for this Python"
fi
python3 -m venv "$folder/clusters"
# Ray 2.60 waits 15 seconds for an agent of its own, and gives up on a busy machine.
"$folder/clusters/bin/pip" -q install "$wheel" 'pytest>=8' 'dask[distributed]' 'ray==2.44.1'
"$folder/clusters/bin/python" -m pytest -q -rs python/tests/test_clusters.py
