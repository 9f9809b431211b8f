#!/usr/bin/env bash
# build.sh BUILD: the viewer as one file that needs nothing else, BUILD/web/viewer.html. BUILD/web/package is made by
# lib/web/build.sh.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
web=$1/web
test -e "$web/package/acdf.wasm" || { echo "skipped: the npm package was not built" >&2; exit 77; }
{
    sed 's/^export //; /import.meta.url/s/new URL("acdf.wasm", import.meta.url)/null/' "$web/package/acdf.mjs"
    printf 'const WASM = "'
    base64 -w 0 "$web/package/acdf.wasm"
    printf '";\n'
    cat "$here/viewer.mjs"
} >"$web/viewer.script"
sed -e "/STYLE/{
    r $here/style.css
    d
}" -e "/SCRIPT/{
    r $web/viewer.script
    d
}" "$here/page.html" >"$web/viewer.html"
rm "$web/viewer.script"
