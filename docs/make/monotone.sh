#!/usr/bin/env bash
# Relative variances of files of growing size: docs/make/monotone.sh DATA [ACDF] prints a table of all BRDFs and a table of
# all probes of DATA, and under each the steps at which more bytes have more variance. TABLES="brdf local" chooses;
# PROBES and BRDFS are patterns of names. Exits with 1 if there are such steps.
set -euo pipefail
data=$1
acdf=${2:-build/release/tools/acdf}
tables=${TABLES:-brdf local}
brdf_sizes=${BRDF_SIZES:-16 32 64 128 200 256 512} # KiB
local_sizes=${LOCAL_SIZES:-64 128 256 512 1024 1536 2048 4096}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
rising=0

projection_of() {
    case $1 in
        grace_probe | beach_probe) echo angular ;;
        stpeters_cross) echo cube-cross ;;
        *) echo latlong ;;
    esac
}

# variance COMMAND SOURCE KIB OPTIONS...: of the file, as stored in it
variance() {
    local command=$1 source=$2 size=$3
    shift 3
    "$acdf" "$command" "$source" -o "$work/out.acdf" --budget "${size}KiB" --force --quiet "$@" > "$work/out.txt" 2>&1 || return 1
    "$acdf" info "$work/out.acdf" --json | jq -r '.accuracy.relative_variance // .metadata["accuracy.relative_variance"]'
}

# sweep COMMAND SIZES PATTERN FILE...: a row a file
sweep() {
    local command=$1 sizes=$2 pattern=$3 found=""
    shift 3
    echo "| KiB | ${sizes// / | } |"
    echo "|---|$(for size in $sizes; do printf -- '---|'; done)"
    for file in "$@"; do
        name=$(basename "${file%.*}")
        # shellcheck disable=SC2053
        [[ $name == $pattern ]] || continue
        options=()
        [ "$command" = local ] && options=(--projection "$(projection_of "$name")")
        line="| $name |"
        last=""
        for size in $sizes; do
            if ! v=$(variance "$command" "$file" "$size" "${options[@]}"); then
                line="$line – |"
                continue
            fi
            line="$line $(awk -v v="$v" 'BEGIN { printf "%.3g", v }') |"
            if [ -n "$last" ] && awk -v a="$last" -v b="$v" 'BEGIN { exit !(b > a) }'; then
                found="$found$name: $(awk -v a="$last" -v b="$v" 'BEGIN { printf "%.1f", 100 * (b / a - 1) }') % more at $size KiB than at the size before"$'\n'
                rising=1
            fi
            last=$v
        done
        echo "$line"
    done
    echo
    echo "${found:-No file has more variance than a smaller one.}"
    echo
}

for table in $tables; do
    case $table in
        brdf) sweep brdf "$brdf_sizes" "${BRDFS:-*}" "$data"/brdfs/*.binary "$data"/brdfs/*.bsdf ;;
        local) sweep local "$local_sizes" "${PROBES:-*}" "$data"/probes/*.exr "$data"/probes/*.hdr ;;
    esac
done
exit $rising
