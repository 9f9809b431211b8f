#!/usr/bin/env bash
# memory.sh ACDF PROBE...: peak memory of `acdf env` against what `acdf batch` estimates, for each probe with each set of
# options below, as Markdown on stdout. Exit code 1 where a peak, less that of `acdf info`, is above its estimate.
# Needs /usr/bin/time.
set -euo pipefail
acdf=${1:?usage: memory.sh ACDF PROBE...}
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

peak() { /usr/bin/time -o "$work/time" -f %M "$@" >/dev/null && awk '{ print int($1 / 1024) }' "$work/time"; } # MiB

"$acdf" env "$1" --cells 10 -o "$work/small.acdf" --quiet
program=$(peak "$acdf" info "$work/small.acdf")
status=0
echo "| probe | options | peak, MiB | estimate, MiB |"
echo "|---|---|---|---|"
for probe in "$@"; do
    while read -r words; do
        json=$(printf '"%s",' $words)
        printf '{"source": "%s", "options": [%s], "output": "x.acdf"}\n' "$(realpath "$probe")" "${json%,}" >"$work/m.jsonl"
        estimate=$("$acdf" batch "$work/m.jsonl" -o "$work/out" --dry-run --json |
            sed -n 's/^ *"memory": \([0-9]*\),*$/\1/p' | head -1)
        # shellcheck disable=SC2086 # options are several words
        used=$(($(peak "$acdf" env "$probe" $words -o "$work/x.acdf" --force --quiet) - program))
        echo "| $(basename "$probe") | \`$words\` | $used | $((estimate >> 20)) |"
        [ "$used" -le $((estimate >> 20)) ] || status=1
    done <<'LIST'
--cells 1000
--cells 100000
--budget 4KiB
--budget 64KiB
--budget 128KiB
--budget 256KiB
--budget 1MiB
--target-variance 0.05
--target-variance 0.001
--budget 64KiB --channel rgb
--budget 64KiB --filter bilinear
--budget 64KiB --max-weight 3
--budget 64KiB --compress zlib
--fit cdf
LIST
done
exit $status
