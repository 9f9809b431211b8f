#!/usr/bin/env bash
# ship.sh BUILD VERSION PAGE: makes the viewer's page of the reader's sources, for `acdf view`. Where libraries for
# WebAssembly are missing there is none, which is no error.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
build=$1 version=$2 page=$3
status=0
CLANG=${CLANG:-clang++} bash "$here/../../lib/web/build.sh" "$build" "$version" || status=$?
if ((status == 77)); then exit 0; fi
if ((status != 0)); then exit "$status"; fi
bash "$here/build.sh" "$build"
mkdir -p "$(dirname "$page")"
cp "$build/web/viewer.html" "$page"
