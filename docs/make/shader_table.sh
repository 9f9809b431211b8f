#!/usr/bin/env bash
# shader_table.sh BUILD PROBE BRDF...: the tables of docs/appendix/shaders.md, of files of 64 KiB.
set -euo pipefail
build=$(cd "$1" && pwd) probe=$2
shift 2
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
for form in environment environment_square local local_square "$@"; do
    for device in c opencl webgl mesa webgpu; do
        echo "$form, $device:"
        PROBE=$probe BRDF=$form FLOOR=0 BUDGET=64KiB "$root/tests/shaders/run.sh" "$device" "$build/tools/acdf" \
            "$build/tests/shaders/compare_shader" "" 1000000 "$([ -f "$form" ] && echo brdf || echo "$form")"
    done
done
