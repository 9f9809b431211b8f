#!/usr/bin/env bash
# Fetches the probes and BRDFs that the figures in docs/ were made from, as far as your connection reaches them, and
# checks each: tools/fetch_data.sh FOLDER. Lists what has to be fetched by hand. docs/data.md describes them.
set -euo pipefail

folder=${1:?usage: tools/fetch_data.sh FOLDER}
list="$(dirname "${BASH_SOURCE[0]}")/../docs/data.tsv"
mkdir -p "$folder/probes" "$folder/brdfs"

is_right() { [[ -f $1 ]] && [[ $(sha256sum "$1" | cut -d' ' -f1) == "$2" ]]; }

# debian:PACKAGE:NAME, the one file of that name in a package.
from_package() {
    local work
    work=$(mktemp -d)
    (cd "$work" && apt-get download -qq "$1" && dpkg-deb -x ./*.deb .) || { rm -rf "$work"; return 1; }
    find "$work" -name "$2" -exec cp {} "$3" \;
    rm -rf "$work"
}

missing=0
while IFS=$'\t' read -r file sum source licence; do
    [[ $file == \#* ]] && continue
    target=$folder/$file
    is_right "$target" "$sum" && continue
    case $source in
        page:*) ;;
        debian:*) IFS=: read -r _ package name <<<"$source"; from_package "$package" "$name" "$target.part" || true ;;
        *) curl --fail --silent --show-error --location --max-time 600 -o "$target.part" "$source" || true ;;
    esac
    if is_right "$target.part" "$sum"; then
        mv "$target.part" "$target"
        echo "$file: fetched ($licence)"
    else
        rm -f "$target.part"
        echo "$file: not had from ${source#page:}; SHA-256 $sum" >&2
        missing=$((missing + 1))
    fi
done <"$list"
((missing == 0)) || { echo "$missing files are missing; tests and scripts that need them skip or say so" >&2; exit 1; }
