#!/usr/bin/env bash
# run.sh PYTHON PYTHON_PACKAGES: docs/examples/blender in headless Blender, whose Cycles renders a scene before and after. Ends
# with 77 where there is no Blender (Debian's package `blender`), or its Python is not the one that acdf was built for.
set -euo pipefail
python=$1 packages=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
command -v blender >/dev/null || { echo "skipped: no blender"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export PYTHONPATH=$packages HOME=$work
b() { blender -b --factory-startup --python-use-system-env --python-exit-code 3 "$@" >"$work/log" 2>&1 || { cat "$work/log"; return 1; }; }
b --python-expr 'import acdf, numpy' || { echo "skipped: Blender's Python does not find acdf and numpy"; exit 77; }
"$python" "$here/../inputs/sky_pfm.py" 512 "$work/sky.pfm"
b -P "$here/scene.py" -- make "$work/sky.pfm" "$work/a.blend"
b "$work/a.blend" -P "$here/../../docs/examples/blender/sun_and_sky.py" -- -o "$work/b.blend"
grep '^sun:' "$work/log" || { cat "$work/log"; exit 1; }
test -s "$work/b.acdf" && test -s "$work/b_sky.exr"
for scene in a b; do
    b "$work/$scene.blend" -P "$here/scene.py" -- draw 512 1 "$work/${scene}_many.npy"
    b "$work/$scene.blend" -P "$here/scene.py" -- draw 16 2 "$work/${scene}_few.npy"
done
"$python" "$here/compare.py" "$work"
