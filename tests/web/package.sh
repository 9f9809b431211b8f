#!/usr/bin/env bash
# package.sh BUILD ACDF MAKE_SKY GOLDEN: packs the npm package, installs the packed file into an empty project, and compares its results there with the program.
set -euo pipefail
build=$(cd "$1" && pwd) acdf=$2 make_sky=$3 golden=$4
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
skip() {
    echo "skipped: $1 (tools/packages.txt names the package)"
    exit 77
}
command -v node >/dev/null || skip "no node"
test -e "$build/web/package/acdf.wasm" || skip "the package was not built: no C++ for WebAssembly"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export HOME=$work npm_config_update_notifier=false npm_config_audit=false npm_config_fund=false
cd "$work"
mkdir project
if command -v npm >/dev/null; then
    npm pack --silent "$build/web/package" >packed
    cd project
    printf '{"private": true, "type": "module"}\n' >package.json
    npm install --silent --offline "../$(cat ../packed)"
else # what it does: the files that package.json names, in a folder `package` of an archive
    names=$(node -p 'require(process.argv[1]).files.join(" ")' "$build/web/package/package.json")
    # shellcheck disable=SC2086
    tar -C "$build/web" -czf packed.tgz --transform 's,^,package/,' -C package package.json $names
    mkdir -p project/node_modules/acdf
    tar -C project/node_modules/acdf -xzf packed.tgz --strip-components 1
    cd project
    printf '{"private": true, "type": "module"}\n' >package.json
fi
for file in acdf.mjs acdf.d.ts acdf.wasm shaders.mjs shaders.d.ts README.md LICENSE; do
    test -s "node_modules/acdf/$file" || { echo "$file is not in the packed file" >&2; exit 1; }
done
size=$(stat -c %s node_modules/acdf/acdf.wasm)
test "$size" -le 121000 || { echo "acdf.wasm has $size bytes, more than was reached before" >&2; exit 1; }

"$make_sky" sky.pfm
"$acdf" env sky.pfm --budget 16KiB --compress zlib -o sky.acdf --quiet
"$acdf" local sky.pfm --budget 64KiB -o local.acdf --quiet
"$acdf" sample sky.acdf -n 20000 >sky.csv
"$acdf" sample local.acdf -n 20000 --normal 0,0.6,0.8 >local.csv
"$acdf" export sky.acdf --target glsl --tables sky.bin >sky.glsl
"$acdf" export local.acdf --target wgsl --tables local.bin >local.wgsl
cp "$here/package_test.mjs" .
GOLDEN=$golden node --test package_test.mjs
# The types are those that the calls are meant for, and are checked at all.
if command -v tsc >/dev/null; then
    cp "$here/types.mts" .
    tsc --noEmit --strict --module nodenext --target es2022 --lib es2022,dom types.mts
fi
