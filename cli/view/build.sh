#!/usr/bin/env bash
# Makes the page that `nearmiss view` fills with data: cli/view/page.html.gz, which is committed.
# `build.sh --check` makes it again and compares. Needs npm; package-lock.json has the versions.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

npm ci --silent --no-audit --no-fund
node build.mjs "$@" page.html.gz
