#!/usr/bin/env bash
# guide.sh GUIDE BUILD ACDF CXX MAKE_SKY: runs the commands of docs/guide.md, with its own words as source.
set -euo pipefail
guide=$1 build=$2 acdf=$3 cxx=$4 make_sky=$5
work=$build/guide
rm -rf "$work"
mkdir -p "$work"
cd "$work"

awk '/^```cpp$/ { on = 1; next } /^```$/ { on = 0 } on' "$guide" >irradiance.cpp
grep -q 'int main' irradiance.cpp

cmake --install "$build" --prefix "$work/acdf" --component reader >install.log
lib=$(dirname "$(find "$work/acdf" -name acdf.pc)")
read -ra flags <<<"$(PKG_CONFIG_PATH=$lib pkg-config --cflags --libs acdf)"
"$cxx" -std=c++17 -Wall -Wextra -Werror irradiance.cpp "${flags[@]}" -o irradiance

"$make_sky" probe.exr
"$acdf" env probe.exr -o probe.acdf --quiet
./irradiance probe.acdf | tee out.txt
# The sky's irradiance on the ground is pi, its integral 2 pi + 0.1 * 2 pi: both estimates agree with that.
awk '{ ok = ($2 > 3.13 && $2 < 3.153 && $6 > 3.13 && $6 < 3.153 && $NF > 6.90 && $NF < 6.92) } END { exit !ok }' out.txt
if ./irradiance probe.exr 2>error.txt; then
    echo "an EXR file was accepted" >&2
    exit 1
fi
grep -q . error.txt
