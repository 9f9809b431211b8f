#!/usr/bin/env bash
# shader_table.sh BUILD PROBE: the table of docs/shaders.md, of a file of 64 KiB.
set -euo pipefail
build=$(cd "$1" && pwd) probe=$2
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
for device in c opencl webgl webgpu; do
    echo "$device:"
    PROBE=$probe BUDGET=64KiB "$root/tests/shaders/run.sh" "$device" "$build/tools/acdf" \
        "$build/tests/shaders/compare_shader" "" 1000000
done
