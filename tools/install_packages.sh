#!/usr/bin/env bash
# Installs the packages of tools/packages.txt, or of the list given, that are missing (Debian 12 and its kin). Asks for
# nothing, changes nothing where all are there. Used by tools/demo.sh, tests/run.sh and tests/tools/batch/farm.sh.
set -euo pipefail

list=${1:-"$(dirname "${BASH_SOURCE[0]}")/packages.txt"}

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "This script installs packages with apt-get, which this system does not have." >&2
    echo "Install what corresponds to these Debian packages, then build with CMake:" >&2
    grep -v '^#' "$list" >&2
    exit 1
fi

missing=()
while read -r package; do
    [[ -z $package || $package == \#* ]] && continue
    status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [[ $status == installed ]] || missing+=("$package")
done <"$list"

if ((${#missing[@]} == 0)); then
    echo "All needed packages are installed."
    exit 0
fi

as_root=()
if ((EUID != 0)); then
    if ! command -v sudo >/dev/null; then
        echo "These packages are missing, and installing them needs root or sudo: ${missing[*]}" >&2
        echo "As root: apt-get install ${missing[*]}" >&2
        exit 1
    fi
    as_root=(sudo)
fi

echo "Installing ${#missing[@]} missing packages: ${missing[*]}"
"${as_root[@]}" apt-get update
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends "${missing[@]}"
