#!/usr/bin/env bash
# put_table.sh NAME < TABLE: replaces what stands between <!-- NAME --> and <!-- /NAME --> in the page of docs/
# or docs/appendix/ that has them.
set -euo pipefail
docs=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
page=$(grep -lFx "<!-- $1 -->" "$docs"/*.md "$docs"/appendix/*.md) || { echo "no page of docs/ has the marks of $1" >&2; exit 1; }
work=$(mktemp -d "${TMPDIR:-/tmp}/acdf-table-XXXXXX")
trap 'rm -rf "$work"' EXIT
sed -e :a -e '/^\n*$/{$d;N;ba' -e '}' > "$work/table" # without empty lines at its end
awk -v name="$1" -v table="$work/table" '
    $0 == "<!-- " name " -->" { print; while ((getline line < table) > 0) print line; inside = 1; next }
    $0 == "<!-- /" name " -->" { inside = 0 }
    !inside { print }' "$page" > "$work/page"
cat "$work/page" > "$page"
