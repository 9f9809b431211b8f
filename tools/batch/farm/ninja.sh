#!/usr/bin/env bash
# Converts a library with Ninja, which makes again only what changed: a source, a manifest, an option.
#
#   tools/batch/farm/ninja.sh OUT INPUT... [OPTION...]
#
# with the inputs and options of `acdf batch`. Options of ninja go into $NINJAFLAGS.
set -euo pipefail

if (($# < 2)); then
    echo "usage: $0 OUT INPUT... [OPTION...]" >&2
    exit 2
fi
out=$1
shift

"${ACDF:-acdf}" batch "$@" -o "$out" --emit ninja --quiet
# -k 0: go on past failures.
# shellcheck disable=SC2086
exec ninja -C "$out" -k 0 ${NINJAFLAGS:-}
