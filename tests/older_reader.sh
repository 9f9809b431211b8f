#!/usr/bin/env bash
# Whether a reader of an earlier revision reads files of this one: older_reader.sh REVISION [FILE.acdf...]
# Builds the reader of that git revision (nothing but cmake, a compiler and zlib is needed) in a temporary folder and
# opens the files, by default the golden ones of tests/. Exit code 1 where one is refused that this revision's rules
# accept; files of kinds or with critical chunks that came later are listed and do not count.
set -euo pipefail
[ $# -ge 1 ] || { echo "usage: older_reader.sh REVISION [FILE.acdf...]" >&2; exit 2; }
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
revision=$1
shift
[ $# -ge 1 ] || set -- "$root"/tests/golden/v1.0/*.acdf

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/source"
git -C "$root" archive "$revision" | tar -x -C "$work/source"
cmake -S "$work/source" -B "$work/build" -DCMAKE_BUILD_TYPE=Release -DACDF_BUILD_TOOLS=OFF -DACDF_BUILD_TESTS=OFF \
    > "$work/log" 2>&1 && cmake --build "$work/build" --parallel 2 >> "$work/log" 2>&1 ||
    { tail -20 "$work/log" >&2; exit 1; }
cat > "$work/open.c" <<'END'
#include <acdf/acdf.h>
#include <stdio.h>
int main(int argc, char** argv) {
    int i, refused = 0;
    for (i = 1; i < argc; ++i) {
        AcdfError error;
        AcdfFile* file = acdf_open(argv[i], &error);
        if (file) printf("read: %s\n", argv[i]);
        else if (error.code == ACDF_UNSUPPORTED) printf("too new: %s\n", error.message);
        else printf("REFUSED: %s\n", error.message), refused = 1;
        acdf_close(file);
    }
    return refused;
}
END
library=$(find "$work/build" -name 'libacdf*.a' | head -1)
${CC:-cc} -std=c99 -I"$work/source/lib/reader" -I"$work/source/format" "$work/open.c" "$library" -lz -lm -o "$work/open"
echo "reader of $(git -C "$root" log -1 --format='%h %s' "$revision")"
"$work/open" "$@"
