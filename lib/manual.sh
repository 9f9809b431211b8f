#!/usr/bin/env bash
# manual.sh ACDF FOLDER: pages for man of the program and of each of its commands, from their --help, and completions for
# bash and zsh, into FOLDER.
set -euo pipefail
acdf=$(realpath "$1") folder=$2
rm -rf "$folder"
mkdir -p "$folder/of"
cd "$folder"
version=$("$acdf" --version | head -1)

# help2man runs a program without arguments: one that is `acdf COMMAND`.
page() { # NAME SUMMARY [COMMAND]
    printf '#!/bin/sh\nexec "%s" %s "$@"\n' "$acdf" "${3-}" >"of/$1"
    chmod +x "of/$1"
    help2man --no-info --no-discard-stderr --section=1 --manual="acdf" --source="$version" \
        --version-string="$version" --name="$2" --output="$1.1" "of/$1"
    # It takes the first word of the usage for the name.
    sed -i -e "s/^\.TH ACDF /.TH ${1^^} /" -e "s/^acdf \\\\- /$1 \\\\- /" "$1.1"
    grep -q "^$1 \\\\- " "$1.1"
    gzip -9n "$1.1"
}
"$acdf" --help | sed -n 's/^  \([a-z]\+\) \+\([A-Z].*\)$/\1\t\2/p' >commands
test "$(wc -l <commands)" -gt 10
while IFS=$'\t' read -r command summary; do
    page "acdf-$command" "$summary" "$command"
done <commands
"$acdf" completion bash >acdf
"$acdf" completion zsh >_acdf
page acdf "compact importance sampling of measured light and reflectance"
rm -r of commands
