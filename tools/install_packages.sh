#!/usr/bin/env bash
# Installs packages that are missing (Debian 12 and its kin). Asks for nothing, changes nothing where all are there.
# Used by tools/first_build.sh, tests/run.sh and tests/tools/batch/farm.sh.
#
#   tools/install_packages.sh SET...     those of tools/packages.txt with such a second or third word
set -euo pipefail

usage() { echo "usage: tools/install_packages.sh first|build|images|quick|test|farm|documents..." >&2; exit 2; }

(($# > 0)) || usage
list="$(dirname "${BASH_SOURCE[0]}")/packages.txt"
wanted=
for set in "$@"; do
    of_set=$(awk -v set="$set" '!/^#/ && ($2 == set || $3 == set) { print $1 }' "$list")
    [[ -n $of_set ]] || usage
    wanted+=" $of_set"
done

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "This script installs packages with apt-get, which this system does not have." >&2
    echo "Install what corresponds to these Debian packages, then build with CMake:" >&2
    echo $wanted >&2
    exit 1
fi

missing=()
for package in $wanted; do
    status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [[ $status == installed ]] || missing+=("$package")
done

if ((${#missing[@]} == 0)); then
    echo "All needed packages are installed."
    exit 0
fi

as_root=()
options=()
if ((EUID == 0)); then
    # As root only, as on machines that are thrown away: what is unpacked is not waited for until it is on the disk.
    options=(-o Dpkg::Options::=--force-unsafe-io)
else
    if ! command -v sudo >/dev/null; then
        echo "These packages are missing, and installing them needs root or sudo: ${missing[*]}" >&2
        echo "As root: apt-get install ${missing[*]}" >&2
        exit 1
    fi
    as_root=(sudo)
fi

echo "Installing ${#missing[@]} missing packages: ${missing[*]}"
# What was read minutes ago is not read again: sets are installed one after the other.
if [[ -z $(find /var/lib/apt/lists/partial -maxdepth 0 -mmin -10 2>/dev/null) ]]; then
    "${as_root[@]}" apt-get update
fi
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get "${options[@]}" install --yes --no-install-recommends "${missing[@]}"
