#!/usr/bin/env bash
# The blocks of shell commands and of C of the book's pages, each page in a new empty folder, by the program and the C library
# that the tests have built. Blocks of Python are run by .ci/python.sh, those of Rust by `cargo test --doc`.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

root=$PWD
target=$(mkdir -p "${CARGO_TARGET_DIR:-target}" && cd "${CARGO_TARGET_DIR:-target}" && pwd)
# As .ci/c.sh.
cargo build --locked --workspace --features cuda --lib --bins --examples
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

export PATH="$target/debug:$PATH"
pages=$(grep -rlE --include='*.md' '^```(sh|c)$' docs | xargs grep -l '^<!-- run by CI -->$' | sort)
[ -n "$pages" ] || { echo "no page of docs marks a block with <!-- run by CI -->"; exit 1; }
for page in $pages; do
    mkdir -p "$folder/$page"
    (cd "$folder/$page" && python3 "$root/.ci/book_blocks.py" "$root/$page" \
        "-I$root/c/include" "$target/debug/libnearmiss_c.a" -lpthread -ldl -lm)
done
