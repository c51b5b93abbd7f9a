# Sourced by .ci/ptxas.sh and .ci/cubins.sh: programs of NVIDIA's Python packages, unpacked into the cache. Nothing is installed.
# `work` is a folder of the caller.

# The last of CUDA 12 and the newest: `python3 -m pip index versions nvidia-cuda-nvcc` tells of newer ones.
nvcc_12=nvidia-cuda-nvcc-cu12==12.9.86
nvcc_newest=nvidia-cuda-nvcc==13.5.37
nvdisasm_newest=nvidia-cuda-nvdisasm==13.5.37
cache=${XDG_CACHE_HOME:-$HOME/.cache}/nearmiss/ptxas

# fetch PACKAGE PROGRAM: its path in the cache, or nothing.
fetch() {
    local program=$cache/$1/$2
    if [ ! -x "$program" ]; then
        rm -rf "$work/wheel"
        python3 -m pip download --quiet --no-deps --only-binary=:all: --dest "$work/wheel" "$1" >&2 || return 1
        python3 -m zipfile -e "$work"/wheel/*.whl "$work/wheel/all" || return 1
        mkdir -p "$cache/$1" && cp "$work"/wheel/all/nvidia/*/bin/"$2" "$program.part" && chmod +x "$program.part" &&
            mv "$program.part" "$program" || return 1
    fi
    echo "$program"
}

# installed PROGRAM: a toolkit's.
installed() {
    local candidate
    for candidate in "$(command -v "$1" || true)" "/usr/local/cuda/bin/$1"; do
        [ -x "$candidate" ] && echo "$candidate" && return
    done
    return 1
}
