#!/usr/bin/env bash
# installed_program.sh BUILD MAKE_SKY: installs the program alone, moves it elsewhere, and reads an image with it. The
# program itself is not linked with OpenImageIO, OpenEXR or FreeType: its modules, which lie beside it, are.
set -euo pipefail
build=$1 make_sky=$2
work=$build/program
rm -rf "$work"
mkdir -p "$work"
cd "$work"

cmake --install "$build" --prefix "$work/installed" --component tools >install.log
mv installed prefix
module=$(find prefix -name acdf_images.so)
openexr=$(find prefix -name acdf_openexr.so)
text=$(find prefix -name acdf_text.so)
diff <(find prefix -type f | sort) <(printf '%s\n' prefix/bin/acdf "$module" "$openexr" "$text" | sort)

needed() { readelf -d "$1" | grep NEEDED; }
needed "$module" | grep -q OpenImageIO
needed "$openexr" | grep -q OpenEXR
needed "$text" | grep -q freetype
for light in "$openexr" "$text"; do
    if needed "$light" | grep OpenImageIO; then
        echo "$light is linked with OpenImageIO" >&2
        exit 1
    fi
done
needed prefix/bin/acdf | grep -q libstdc++
if needed prefix/bin/acdf | grep -E 'OpenImageIO|OpenEXR|freetype'; then
    echo "acdf is linked with a library of images" >&2
    exit 1
fi
if grep -aq "$build[[:print:]]*lib[[:print:]]*/acdf" prefix/bin/acdf; then
    echo "acdf would look for its modules in the build tree, $build" >&2
    exit 1
fi

read_without() { # MODULE IMAGE: which needs it
    "$make_sky" "$2"
    prefix/bin/acdf env "$2" -o sky.acdf --quiet --force
    prefix/bin/acdf validate sky.acdf
    rm "$1"
    prefix/bin/acdf info sky.acdf >info.txt
    if prefix/bin/acdf env "$2" -o again.acdf --quiet 2>error.txt; then
        echo "$2 was read without $1" >&2
        exit 1
    fi
    grep -q "$work/$1: " error.txt
}
read_without "$module" sky.tif
read_without "$openexr" sky.exr
