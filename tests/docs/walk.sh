#!/usr/bin/env bash
# walk.sh ROOT BUILD MAKE_SKY CXX: does what README.md and docs/guide.md say, command by command as they stand there, each
# page in a clean root and a clean home. What installs packages or builds all is replaced: dpkg-query finds all packages, and
# cmake checks its presets and options and then does nothing, but for --install. BUILD is what it would have built.
set -euo pipefail
root=$1 build=$2 make_sky=$3 cxx=$4
work=$build/walk
rm -rf "$work"
mkdir -p "$work/bin"
cmake=$(command -v cmake)

cat >"$work/bin/cmake" <<STUB
#!/usr/bin/env bash
set -euo pipefail
[[ \$1 == --install ]] && exec "$cmake" "\$@"
kind=configurePresets
for word in "\$@"; do
    case \$word in
    --build) kind=buildPresets ;;
    -D*) option=\${word#-D} && grep -q "^\${option%%=*}:" "$build/CMakeCache.txt" || { echo "no option \$word" >&2; exit 1; } ;;
    --preset) ;;
    *) [[ \$previous != --preset ]] || jq -e --arg name "\$word" ".\$kind[] | select(.name == \\\$name)" "$root/CMakePresets.json" >/dev/null ||
        { echo "no preset \$word" >&2; exit 1; } ;;
    esac
    previous=\$word
done
STUB
printf '#!/bin/sh\nprintf installed\n' >"$work/bin/dpkg-query"
chmod +x "$work"/bin/*

# Lines of a language in the blocks of a page.
blocks() { awk -v fence='```'"$2" '$0 == fence { on = 1; next } /^```$/ { on = 0 } on' "$1"; }

# clean_root NAME PROBE: a checkout that has been built, with a probe of the user's.
clean_root() {
    mkdir -p "$work/$1/build" "$work/$1/home"
    ln -s "$root"/{tools,docs,CMakePresets.json} "$work/$1/"
    ln -s "$build" "$work/$1/build/release"
    "$make_sky" "$work/$1/$2"
    cd "$work/$1"
}

# walk PAGE: runs its commands in this shell's folder; the last one that was begun is the last line of walk.log. MORE follows.
walk() {
    { blocks "$1" sh && printf '%s\n' "${2-}"; } >commands.sh
    grep -q . commands.sh
    if grep -q "^acdf view" commands.sh && [[ ! -e $build/share/acdf/viewer.html ]]; then
        sed -i "/^acdf view/d" commands.sh
        echo "no compiler for WebAssembly, so no page of acdf view: that command is left out"
    fi
    env -u PKG_CONFIG_PATH -u CMAKE_PREFIX_PATH -u LD_LIBRARY_PATH HOME="$PWD/home" BROWSER=true PATH="$work/bin:$PATH" \
        bash -e -x -o pipefail commands.sh >walk.out 2>walk.log || { tail -n 20 walk.log >&2; exit 1; }
}

clean_root readme my_probe.exr
walk "$root/README.md"
test -s out/demo/my_probe.acdf
test "$(stat -c %s my_probe.acdf)" -le 65536
test "$(grep -c '^[0-9]' directions.csv)" -eq 1000
grep -q 'relative variance' walk.out

# Its C++, with the two random numbers that it takes from a renderer.
{
    blocks "$root/README.md" cpp | grep '^#include'
    echo '#include <cstdio>'
    echo 'int main() { const double u0 = 0.25, u1 = 0.75;'
    blocks "$root/README.md" cpp | grep -v '^#include'
    echo 'std::printf("%d\n", s.pdf > 0 && p == s.pdf); }'
} >readme.cpp

clean_root guide probe.exr
cp ../readme/{readme.cpp,my_probe.acdf} .
blocks "$root/docs/guide.md" cpp >irradiance.cpp
# The guide's way to build by pkg-config, in the shell that its commands left.
compile=$(grep -o 'c++ -std=c++17 irradiance.cpp \$(pkg-config[^`]*' "$root/docs/guide.md")
walk "$root/docs/guide.md" "
test \"\$(command -v acdf)\" = \"\$HOME/acdf/bin/acdf\"
${compile/c++/$cxx}
./a.out probe.acdf > irradiance.txt
! ./a.out probe.exr 2> error.txt
${compile/c++ -std=c++17 irradiance.cpp/$cxx -std=c++17 -Wall -Wextra -Werror readme.cpp}
./a.out > readme.txt"
# The sky's irradiance on the ground is pi, its integral 2 pi + 0.1 * 2 pi: both estimates agree with that.
awk '{ ok = ($2 > 3.13 && $2 < 3.153 && $6 > 3.13 && $6 < 3.153 && $NF > 6.90 && $NF < 6.92) } END { exit !ok }' irradiance.txt
test -s error.txt
test "$(cat readme.txt)" = 1
