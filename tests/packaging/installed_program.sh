#!/usr/bin/env bash
# installed_program.sh BUILD MAKE_SKY: installs the program alone, moves it elsewhere, and reads an image with it. The
# program itself is not linked with OpenImageIO: its module, which lies beside it, is.
set -euo pipefail
build=$1 make_sky=$2
work=$build/program
rm -rf "$work"
mkdir -p "$work"
cd "$work"

cmake --install "$build" --prefix "$work/installed" --component tools >install.log
mv installed prefix
module=$(find prefix -name acdf_images.so)
diff <(find prefix -type f | sort) <(printf '%s\n' prefix/bin/acdf "$module" | sort)

needed() { readelf -d "$1" | grep NEEDED; }
needed "$module" | grep -q OpenImageIO
needed prefix/bin/acdf | grep -q libstdc++
if needed prefix/bin/acdf | grep OpenImageIO; then
    echo "acdf is linked with OpenImageIO" >&2
    exit 1
fi
if grep -aq "$build[[:print:]]*acdf_images[.]so" prefix/bin/acdf; then
    echo "acdf would look for its module in the build tree, $build" >&2
    exit 1
fi

"$make_sky" sky.exr
prefix/bin/acdf env sky.exr -o sky.acdf --quiet
prefix/bin/acdf validate sky.acdf
rm "$module"
prefix/bin/acdf info sky.acdf >info.txt
if prefix/bin/acdf env sky.exr -o again.acdf --quiet 2>error.txt; then
    echo "an image was read without the module" >&2
    exit 1
fi
grep -q "$work/$module: " error.txt
