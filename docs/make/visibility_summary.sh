#!/usr/bin/env bash
# visibility_summary.sh SUMS PICTURES: the summary in docs/visibility.md, of the tables that visibility.sh makes.
set -euo pipefail
awk -F' *[|] *' '
    BEGIN {
        name["`visibility:4MB`"] = "visibility cells, 4 MB"
        name["`visibility-portals:4MB`"] = "cells and portals, 4 MB"
        print "| scene | file | gain at equal samples | gain at equal time |"
        print "|---|---|---|---|"
    }
    !($3 in name) { next }
    FNR == NR { samples[$2, $3] = $6; next }
    { printf "| %s | %s | %.3g | %.3g |\n", $2, name[$3], samples[$2, $3], $5 }
' "${1:?usage: visibility_summary.sh SUMS PICTURES}" "${2:?usage: visibility_summary.sh SUMS PICTURES}"
