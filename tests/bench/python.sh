#!/usr/bin/env bash
# python.sh [BUILD]: prints the table of docs/appendix/python.md, from files of 64 KiB to 1 MiB of the built-in probe.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
build=$(realpath "${1:-build/release}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

c++ -std=c++17 -O3 -DNDEBUG -ffp-contract=off -Iformat -Ilib/reader tests/bench/python_arrays.cpp "$build/lib/reader/libacdf.a" -lz \
    -o "$work/loops"
export PYTHONPATH=$build/lib/python
/usr/bin/python3 - "$work" <<'MAKE'
import sys

import acdf
import numpy as np

image = np.random.default_rng(1).lognormal(0, 2, (256, 512))
acdf.build_environment(image, budget="64KiB").save(sys.argv[1] + "/sky.acdf")
acdf.build_local(image, budget="1MiB").save(sys.argv[1] + "/local.acdf")
theta = (np.arange(90) + 0.5) / 180 * np.pi
lobe = 0.05 + 20 * np.exp(-((theta / 0.15) ** 2))
table = np.broadcast_to(lobe[None, None, :, None], (30, 1, 90, 16))
acdf.build_brdf(table, budget="128KiB").save(sys.argv[1] + "/brdf.acdf")
MAKE
/usr/bin/python3 tests/bench/python.py "$work/loops" "$work/sky.acdf" "$work/local.acdf" "$work/brdf.acdf"
