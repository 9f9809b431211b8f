#!/usr/bin/env bash
# build_path_tracer.sh BUILD WORK: docs/examples/path_tracer against the reader that BUILD installs; WORK/build/path_tracer.
set -euo pipefail
build=$1 work=$2
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
for component in reader visibility product; do
    cmake --install "$build" --prefix "$work/prefix" --component $component >/dev/null
done
cmake -S "$root/docs/examples/path_tracer" -B "$work/build" -DCMAKE_PREFIX_PATH="$work/prefix" >/dev/null
cmake --build "$work/build" >/dev/null
