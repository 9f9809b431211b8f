#!/usr/bin/env bash
# hardened.sh FILE...: whether programs and libraries are hardened as ACDF_HARDEN promises.
# hardened.sh --build WORK SOURCE CC CXX: whether the preset `package` compiles and links all that it builds so, by its commands; and
# whether these flags do what they are for, by a library and a program of a few lines that the project compiles as its own.
set -euo pipefail

wrong() { echo "$1: $2" >&2; exit 1; }

check() { # FILE
    local headers dynamic symbols
    headers=$(readelf -hlW "$1") dynamic=$(readelf -dW "$1") symbols=$(readelf --dyn-syms -W "$1")
    grep -q 'Type: *DYN' <<<"$headers" || wrong "$1" "lies at a fixed address"
    grep -q 'GNU_RELRO' <<<"$headers" || wrong "$1" "no section becomes read-only"
    grep -qE 'BIND_NOW|FLAGS.*\bNOW\b' <<<"$dynamic" || wrong "$1" "addresses of functions are found late, in memory that stays writable"
    grep 'GNU_STACK' <<<"$headers" | grep -q ' RW ' || wrong "$1" "the stack is executable"
    if grep -q 'TEXTREL' <<<"$dynamic"; then wrong "$1" "code is written to while it is loaded"; fi
    grep -q '__stack_chk_fail' <<<"$symbols" || wrong "$1" "no return is guarded"
    echo "$1: hardened"
}
# Of all together: small ones may copy nothing whose size the compiler does not prove.
check_fortified() { # FILE...
    for file in "$@"; do
        if readelf --dyn-syms -W "$file" | grep -qE 'UND +__[a-z]+_chk(@|$)' &&
            readelf --dyn-syms -W "$file" | grep -E 'UND +__[a-z]+_chk(@|$)' | grep -qv stack_chk; then return; fi
    done
    wrong "$*" "no call of the C library checks sizes (_FORTIFY_SOURCE)"
}
# Every command that compiles: the last of several flags counts.
check_compilations() { # COMPILE_COMMANDS
    awk '
        /^ *"command":/ {
            ++count; level = fortified = guarded = ""
            for (i = 2; i <= NF; ++i) {
                if ($i ~ /^-O/) level = $i
                if ($i ~ /^-[DU]_FORTIFY_SOURCE/) fortified = $i
                if ($i ~ /^-f(no-)?stack-protector/) guarded = $i
            }
            if (level !~ /^-O[123s]$/ || fortified != "-D_FORTIFY_SOURCE=2" || guarded != "-fstack-protector-strong") { print; bad = 1 }
        }
        END { exit bad || count < 100 }' "$1" >&2 || wrong "$1" "these are compiled otherwise, or nearly nothing is compiled"
}
check_links() { # BUILD_NINJA
    awk '
        /^build .*: C(XX)?_(EXECUTABLE|SHARED_LIBRARY|MODULE_LIBRARY)_LINKER/ { built = $2; program = /_EXECUTABLE_/; ++count; flags = "" }
        built && /^  LINK_FLAGS =/ { flags = $0 " " }
        built && /^$/ {
            if (flags !~ / -Wl,-z,relro / || flags !~ / -Wl,-z,now / || flags !~ / -Wl,-z,noexecstack / || program && flags !~ / -pie /) {
                print built flags; bad = 1
            }
            built = ""
        }
        END { exit bad || count < 5 }' "$1" >&2 || wrong "$1" "these are linked otherwise, or nearly nothing is linked"
}

if [[ $1 == --build ]]; then
    work=$2 source=$3
    rm -rf "$work"
    # Added last to the project, whose options they get.
    mkdir -p "$work"
    cat >"$work/copies.c" <<'COPIES'
#include <string.h>
void put(char* text, const char* from, size_t size);
void put(char* text, const char* from, size_t size) { memcpy(text, from, size); }
int copies(const char* from, size_t size);
int copies(const char* from, size_t size) {
    char text[64];
    memcpy(text, from, size);
    put(text + 1, from, 1);
    return text[size / 2];
}
COPIES
    { echo 'extern "C" {' && cat "$work/copies.c" && echo '}'; } >"$work/copies.cpp"
    echo 'int copies(const char*, unsigned long); int main(int count, char** words) { return copies(words[0], count); }' >"$work/main.c"
    sed 's/^/extern "C" /' "$work/main.c" >"$work/main.cpp"
    cat >"$work/copies.cmake" <<'PROJECT'
function(add_copies)
    foreach(language c cpp)
        add_library(copies_${language} SHARED EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/copies.${language})
        add_executable(copy_${language} EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/copies.${language} ${CMAKE_BINARY_DIR}/main.${language})
    endforeach()
endfunction()
cmake_language(DEFER CALL add_copies)
PROJECT
    { cmake -S "$source" -B "$work" --preset package -DACDF_BUILD_VIEWER=OFF -DCMAKE_PROJECT_acdf_INCLUDE="$work/copies.cmake" \
        -DCMAKE_C_COMPILER="$4" -DCMAKE_CXX_COMPILER="$5" &&
        cmake --build "$work" --target copies_c copies_cpp copy_c copy_cpp; } >"$work.log" 2>&1 || { cat "$work.log"; exit 1; }
    check_compilations "$work/compile_commands.json"
    check_links "$work/build.ninja"
    set -- "$work"/libcopies_{c,cpp}.so "$work"/copy_{c,cpp}
    for file in "$@"; do check_fortified "$file"; done
fi
for file in "$@"; do check "$file"; done
check_fortified "$@"
