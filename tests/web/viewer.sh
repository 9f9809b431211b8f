#!/usr/bin/env bash
# viewer.sh BUILD ACDF MAKE_SKY: builds the viewer and drops files on it in headless Chromium, at desktop and phone
# width.
set -euo pipefail
build=$(cd "$1" && pwd) acdf=$2 make_sky=$3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
skip() {
    echo "skipped: $1 (tools/packages.txt names the package)"
    exit 77
}
command -v chromium >/dev/null || skip "no chromium"
command -v python3 >/dev/null || skip "no python3"
test -e "$build/web/package/acdf.wasm" || skip "the package was not built: no C++ for WebAssembly"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$here/../../docs/viewer/build.sh" "$build"
cp "$build/web/viewer.html" "$here/viewer_test.html" "$here"/../golden/v1.0/{brdf,visibility}.acdf "$work"
cd "$work"
"$make_sky" sky.pfm
"$acdf" env sky.pfm --budget 8KiB --compress zlib -o sky.acdf --quiet
"$acdf" env sky.pfm --budget 8KiB --domain octahedral -o square.acdf --quiet
"$acdf" local sky.pfm --budget 64KiB -o local.acdf --quiet
printf 'not a file of ours, but long enough to be one if bytes were all that it takes' >broken.acdf
echo '0.6 0 0.8' | "$acdf" pdf sky.acdf >pdf
"$acdf" info sky.acdf --json >info.json
# The page that `acdf view` makes, of the build's own page where there is one.
if ! "$acdf" view sky.acdf -o opened.html --quiet; then
    sed "s|<!-- OPENED -->|<script type=\"text/plain\" id=\"opened\" data-name=\"sky.acdf\">$(base64 -w 0 sky.acdf)</script>|" \
        viewer.html >opened.html
fi
python3 "$here/../shaders/browser.py" . "viewer_test.html?width=1280" "viewer_test.html?width=390" --window-size=1400,1300
