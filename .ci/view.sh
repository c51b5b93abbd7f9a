#!/usr/bin/env bash
# The page of `nearmiss view`: the committed page is the one that its sources make, and it works in
# headless Chromium. Needs npm and chromium; builds the program, unless NEARMISS names one.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

cli/view/build.sh --check
# The check sees a page that is not the one of its sources.
planted=$(mktemp -d)
trap 'rm -rf "$planted"' EXIT
gzip -dc cli/view/page.html.gz | sed 's/<title>/<title>x/' | gzip >"$planted/page.html.gz"
if (cd cli/view && node build.mjs --check "$planted/page.html.gz" 2>/dev/null); then
    echo "a page that differs from its sources is not noticed"
    exit 1
fi

target=$(realpath "${CARGO_TARGET_DIR:-target}")
[ -n "${NEARMISS:-}" ] || cargo build --locked --workspace --features cuda --lib --bins --examples
cd cli/view
NEARMISS=${NEARMISS:-$target/debug/nearmiss} node --test test/*.test.js
