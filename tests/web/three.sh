#!/usr/bin/env bash
# three.sh BUILD ACDF: three-gpu-pathtracer with its own sampling of the environment and with
# docs/examples/three-gpu-pathtracer, in headless Chromium: the same mean, and the variance at equal samples, printed. Needs
# the npm registry, and a quarter of an hour: software GPUs take minutes to compile its shader.
set -euo pipefail
build=$(cd "$1" && pwd) acdf=$2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
skip() {
    echo "skipped: $1"
    exit 77
}
command -v chromium >/dev/null || skip "no chromium (tools/packages.txt names the package)"
command -v npm >/dev/null || skip "no npm"
test -e "$build/web/package/acdf.wasm" || skip "the package was not built: no C++ for WebAssembly"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export HOME=$work
cd "$work"
printf '{"private": true, "type": "module"}\n' >package.json
npm install --silent --no-audit --no-fund three@0.187.0 three-mesh-bvh@0.9.17 three-gpu-pathtracer@0.0.26 "$build/web/package" \
    >npm.log 2>&1 || skip "three-gpu-pathtracer cannot be had from the npm registry"
rm node_modules/acdf # a link, which the server would not follow out of its folder
cp -r "$build/web/package" node_modules/acdf
cp "$here"/three/* "$here"/../../docs/examples/three-gpu-pathtracer/*.mjs .
python3 "$here/../inputs/sky_pfm.py" 1024 sky.pfm
"$acdf" env sky.pfm --filter bilinear --budget 24KiB -o sky.acdf --quiet
status=0
ACDF_BROWSER_SECONDS=1700 python3 "$here/../shaders/browser.py" . index.html || status=$?
cat result.json
exit "$status"
