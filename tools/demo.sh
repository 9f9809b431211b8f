#!/usr/bin/env bash
# From a bare Debian 12 to results: installs what is missing, builds the acdf program and runs `acdf demo` on the
# probes given, or on built-in ones. May be run again at any time; results are in out/demo.
#
#   tools/demo.sh [PROBE...]
set -euo pipefail

step() { printf '\n== %s\n' "$*"; }

probes=()
for probe in "$@"; do
    if [[ ! -r $probe ]]; then
        echo "demo.sh: $probe: cannot be read; give environment maps (.exr, .hdr, ...) or nothing" >&2
        exit 1
    fi
    probes+=("$(realpath -- "$probe")")
done
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Probes that are given may be of any format; the built-in ones are OpenEXR.
packages=(build)
all_formats=OFF
if ((${#probes[@]} > 0)); then packages+=(images) && all_formats=ON; fi

step "Packages, and libraries that need few of them"
tools/first_build.sh "${packages[@]}"

step "Building the acdf program in build/release"
cmake --preset release -DACDF_OPENIMAGEIO=$all_formats -DACDF_BUILD_TESTS=OFF -DACDF_BUILD_ONCE=ON
cmake --build --preset release --target acdf --parallel "$(nproc)"

step "Running the demo on ${#probes[@]} probes given (none: the built-in ones)"
mkdir -p out
build/release/tools/acdf demo --force -o out/demo "${probes[@]}"

step "Done: the results are in $PWD/out/demo"
