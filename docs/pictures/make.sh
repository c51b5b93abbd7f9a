#!/bin/sh
# Makes the pictures of this folder again with the program: the same bytes on every machine.
# Takes the program, by default the one that `cargo build --release -p nearmiss-cli` makes.
set -eu
here=$(CDPATH= cd -- "$(dirname -- "$0")" && pwd)
nearmiss=${1:-$here/../../target/release/nearmiss}
made=$(mktemp -d)
trap 'rm -r "$made"' EXIT
size=720x540

"$nearmiss" picture --scene cloth-ball --triangles 20000 --discrete --size $size --out "$here/cloth-ball.png"
"$nearmiss" picture --scene draped --triangles 12000 --view 3,-7,-1 --discrete --around contacts --size 640x480 --out "$here/draped.png"

"$nearmiss" lab scene draped --triangles 6000 --out "$made"
cat > "$made/scene.toml" <<'TOML'
[[body]]
name = "cloth on a ball"
mesh = "draped_t0.ply"

[[body]]
name = "the same, turned"
kind = "rigid"
mesh = "draped_t0.ply"
poses = [{ translation = [2.9, -0.8, 0.3], rotation = [0, 0.6, 0, 0.8] }]
TOML
"$nearmiss" picture "$made/scene.toml" --distance --view=-1,-4,1.2 --size $size --out "$here/distance.png"
