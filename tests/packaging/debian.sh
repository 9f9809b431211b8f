#!/usr/bin/env bash
# debian.sh BUILD SOURCE CC CXX PYTHON MAKE_SKY: makes the packages for Debian, checks them with lintian, unpacks them into an
# empty root, and uses what is there, and nothing of the build tree: `acdf env`, `import acdf`, find_package(acdf) with
# static and shared libraries, pages for man, completions.
set -euo pipefail
trap 'echo "debian.sh: line $LINENO failed" >&2' ERR
build=$1 source=$2 cc=$3 cxx=$4 python=$5 make_sky=$6
work=$build/debian_packages
rm -rf "$work"
mkdir -p "$work/root"
cd "$build"

# Weakly compressed, which Debian's tools read as well.
cpack -G DEB -B "$work" -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip >"$work/cpack.log" 2>&1 || { cat "$work/cpack.log"; exit 1; }
cd "$work"
for package in acdf-tools libacdf0 libacdf-dev python3-acdf; do
    deb=$(echo "$package"_*.deb)
    dpkg-deb --info "$deb" >"$package.info"
    dpkg -x "$deb" root
done

# What they ask for exists under these names, and nothing asks for a library without a package.
grep -q 'Depends:.*libopenimageio' acdf-tools.info
grep -q 'Depends:.*libtbb12' python3-acdf.info
grep -q 'Depends:.*libacdf0 (= ' libacdf-dev.info
grep -q 'Depends:.*zlib1g' libacdf0.info

# apt would install them: all that they depend on is there.
apt-get install --simulate --no-install-recommends ./*.deb >apt.log 2>&1 || { cat apt.log; exit 1; }
grep -q '^Inst python3-acdf' apt.log

if command -v lintian >/dev/null; then
    # Left out: no bug of Debian's is closed by a first version; libraries lie in /usr/lib, which one architecture can have;
    # CPack calls ldconfig itself, beside the trigger.
    lintian --fail-on error,warning --allow-root \
        --suppress-tags initial-upload-closes-no-bugs,maintscript-calls-ldconfig,pkg-config-unavailable-for-cross-compilation ./*.deb
else
    echo "lintian is not installed: packages are not checked by it"
fi

if grep -qx 'ACDF_HARDEN:BOOL=ON' "$build/CMakeCache.txt"; then
    mapfile -t compiled < <(find root/usr -type f \( -name '*.so' -o -name '*.so.*' -o -path '*/bin/*' \))
    bash "$source/tests/packaging/hardened.sh" "${compiled[@]}"
else
    echo "this build is not hardened, and so are these packages"
fi

# The program.
unset ACDF_TEST_DATA PYTHONPATH LD_LIBRARY_PATH
"$make_sky" sky.exr
root/usr/bin/acdf env sky.exr -o sky.acdf --quiet
root/usr/bin/acdf validate sky.acdf
root/usr/bin/acdf --version | grep -q '^OpenImageIO [0-9]'

# Python.
PYTHONPATH=$work/root/usr/lib/python3/dist-packages "$python" -B - <<'CHECK'
import acdf
import numpy as np

assert acdf.__file__.startswith(__import__("os").getcwd() + "/root/usr/lib/"), acdf.__file__
sky = acdf.open("sky.acdf")
direction, pdf = sky.sample(np.random.default_rng(1).random((1000, 2)))
assert np.array_equal(sky.pdf(direction), pdf)
assert acdf.build_environment(np.ones((8, 16)), cells=64).kind == "environment"
CHECK

# CMake and pkg-config, static and shared: configured once, and compiled once where both ask for the same options.
consume() { # FOLDER LIBRARY
    cmake -S "$source/tests/packaging/consumer" -B consumer -G Ninja -DCMAKE_PREFIX_PATH="$work/root/usr" -DACDF_LIBRARY="$2" \
        -DCMAKE_BUILD_TYPE=None -DCMAKE_C_COMPILER="$cc" -DCMAKE_CXX_COMPILER="$cxx" >"$1.log"
    cmake --build consumer >>"$1.log" || { cat "$1.log"; exit 1; }
    mkdir "$1"
    cp consumer/consumer_c consumer/consumer_cpp "$1"
    "$1/consumer_c" sky.acdf >"$1.c.txt"
    "$1/consumer_cpp" sky.acdf | diff - "$1.c.txt"
}
consume static acdf::reader
consume shared acdf::acdf-shared
diff static.c.txt shared.c.txt
readelf -d shared/consumer_cpp | grep -q 'NEEDED.*libacdf\.so\.0'
if readelf -d static/consumer_cpp | grep -q libacdf; then echo "the static library is not used" >&2; exit 1; fi

# Symbols: what the headers declare, and no more.
readelf -d root/usr/lib/libacdf.so.0 | grep -q 'SONAME.*libacdf\.so\.0\]'
readelf -d root/usr/lib/libacdf-builder.so.0 | grep -q 'SONAME.*libacdf-builder\.so\.0\]'
nm -DC --defined-only root/usr/lib/libacdf.so.0 | awk '{ $1 = $2 = ""; print }' >symbols
if grep -vE '^ +(acdf_[a-z_]+@|acdf::(File|ShaderTables|pdf_batch|sample_batch)\b|ACDF_0)' symbols; then echo "symbols that are not public" >&2; exit 1; fi
for symbol in $(sed -n 's/.*\b\(acdf_[a-z_]*\)(.*/\1/p' root/usr/include/acdf/arrays/arrays.h | sort -u); do
    grep -q " $symbol@@ACDF_0" symbols || { echo "$symbol is no symbol" >&2; exit 1; }
done
# ... which any language can call.
"$python" - root/usr/lib/libacdf.so.0 <<'CHECK'
import ctypes, sys

library = ctypes.CDLL(sys.argv[1])
library.acdf_open.restype = ctypes.c_void_p
library.acdf_sample_environment.restype = library.acdf_pdf_environment.restype = ctypes.c_float
file = ctypes.c_void_p(library.acdf_open(b"sky.acdf", None))
direction = (ctypes.c_float * 3)()
pdf = library.acdf_sample_environment(file, ctypes.c_double(0.3), ctypes.c_double(0.4), direction)
assert pdf > 0 and library.acdf_pdf_environment(file, direction) == pdf
CHECK

# Pages and completions.
for page in acdf acdf-env acdf-completion; do
    zgrep -q '^.SH DESCRIPTION' "root/usr/share/man/man1/$page.1.gz"
done
completions=root/usr/share/bash-completion/completions/acdf
bash -c 'source "$0"; COMP_WORDS=(acdf env --bud); COMP_CWORD=2; _acdf; [[ ${COMPREPLY[*]} == --budget ]]' "$completions"
bash -c 'source "$0"; COMP_WORDS=(acdf va); COMP_CWORD=1; _acdf; [[ ${COMPREPLY[*]} == validate ]]' "$completions"
if command -v zsh >/dev/null; then zsh -n root/usr/share/zsh/vendor-completions/_acdf; fi
