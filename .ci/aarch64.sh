#!/usr/bin/env bash
# Makes the folder FOLDER, with which programs for aarch64 run on this machine: `.ci/aarch64.sh FOLDER`, then `FOLDER/run PROGRAM ARGUMENT...`;
# `FOLDER/run python3` is a Python for aarch64 with numpy. Exit status 77 says that this machine has no Debian packages.
#
# Rationale
# - QEMU and all that it runs come from the distribution's packages by name, unpacked and not installed: no rights are needed, and this
#   machine stays as it was.
# - Such a run is some twenty times slower. It shows that a build works and gives the same bits, not how fast.
set -euo pipefail

[ $# = 1 ] || { echo "usage: .ci/aarch64.sh FOLDER" >&2; exit 2; }
command -v apt-get >/dev/null || { echo "aarch64: QEMU comes from Debian's packages, and there is no apt-get" >&2; exit 77; }
mkdir -p "$1"
folder=$(realpath "$1")
[ -z "$(ls -A "$folder")" ] || { echo "aarch64: $folder is not empty" >&2; exit 2; }

# fetch MACHINE PACKAGE...: packages and all that they need, unpacked under FOLDER/MACHINE.
fetch() {
    local machine=$1 state=$folder/.apt/$1 package
    shift
    mkdir -p "$state/lists/partial" "$state/cache/archives/partial" "$folder/$machine"
    : >"$state/status"
    local apt=(apt-get -qq -o "APT::Architecture=$machine" -o "APT::Architectures=$machine" -o "Dir::State::status=$state/status"
        -o "Dir::State::Lists=$state/lists" -o "Dir::Cache=$state/cache" -o Debug::NoLocking=1 -o APT::Sandbox::User="$(id -un)")
    "${apt[@]}" update
    "${apt[@]}" install -y --no-install-recommends --download-only "$@"
    for package in "$state"/cache/archives/*.deb; do dpkg -x "$package" "$folder/$machine"; done
    rm -rf "$state"
}
fetch amd64 qemu-user-static
mv "$folder/amd64/usr/bin/qemu-aarch64-static" "$folder/qemu"
rm -rf "$folder/amd64"
fetch arm64 python3 python3-numpy

cat >"$folder/run" <<END
#!/bin/sh
# Made by .ci/aarch64.sh.
program=\$1
shift
[ -e "\$program" ] || program=$folder/arm64/usr/bin/\$program
libraries=/usr/lib/aarch64-linux-gnu
exec $folder/qemu -L $folder/arm64 -E LD_LIBRARY_PATH=\$libraries/blas:\$libraries/lapack "\$program" "\$@"
END
chmod +x "$folder/run"
