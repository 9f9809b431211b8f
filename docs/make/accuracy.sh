#!/usr/bin/env bash
# accuracy.sh DATA [SECTION...]: writes the tables of docs/appendix/accuracy-*.md, the summary in docs/accuracy.md, and the table
# in docs/appendix/performance-building.md, from the programs' output.
# DATA holds probes/ and brdfs/. ACDF names the program (default: build/release/tools/acdf). Without sections all are
# made, which takes an hour on two cores. Each table stands between <!-- NAME --> and <!-- /NAME --> in a page; what
# the summary needs of the others is kept in RESULTS (default: build/accuracy).
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
data=$(cd "${1:?usage: docs/make/accuracy.sh DATA [SECTION...]}" && pwd)
shift
acdf=${ACDF:-$root/build/release/tools/acdf}
results=${RESULTS:-$root/build/accuracy}
sections=(e1 e1_fits e1_sizes e1_options e1_ratio octahedral e2 e3 e3_render e4_sizes e4_baselines e4_paper e4_bins e4_tiles e4_grace e4_stpeters e4_beach e5 e6_cook e6_nickel e6_plastic e7_100 e7_16 e7_4 e7_hidden hidden partner partner_exact partner_draws baselines building summary)
mkdir -p "$results"

# Definitions for jq: rounding to three digits, and a value with its interval.
jq_lib='def sig: if . == null then "–" elif . == 0 then "0" else . as $x | ((fabs|log10|floor) - 2) as $e | (if $e < 0 then (($x * pow(10; -$e) | round) / pow(10; -$e)) else (($x / pow(10; $e) | round) * pow(10; $e)) end) | tostring end;
def interval: "\(.value|sig) (\(.low|sig)–\(.high|sig))";
def shown($figure): if .resolved then $figure | interval else "unsure" end;
def percent: "\(. * 1000 | round / 10) %";
def size: if . == 0 then "–" elif . >= 1048576 then "\(. / 104857.6 | round / 10) MiB" else "\(. / 102.4 | round / 10) KiB" end;'

# ---- E1: one environment map ----------------------------------------------------------------------------

e1() {
    local probe=$data/probes/grace_probe.hdr line
    echo "| Grace Cathedral, 1024×512 | bytes | cells | relative variance | KL divergence, nats | largest weight |"
    echo "|---|---|---|---|---|---|"
    while IFS='|' read -r text options; do
        # shellcheck disable=SC2086
        line=$("$acdf" env "$probe" --projection angular --domain latlong --filter nearest -o "$results/e1.acdf" --force --quiet --json $options |
            jq -r "$jq_lib"' " \(.bytes) | \(.cells) | \(.relative_variance|sig) | \(.kl_divergence|sig) | \(.max_weight|sig) |"')
        echo "| $text |$line"
    done <<'ROWS'
uniform, 16×16 (as published)|--fit uniform --knots 16x16
cdf, 16×16 (as published)|--fit cdf --knots 16x16
uniform, 64×64 (as published)|--fit uniform --knots 64x64
cdf, 64×64 (as published)|--fit cdf --knots 64x64
variance, 256 cells|--cells 256
variance, 4096 cells|--cells 4096
variance, 64 KiB|--budget 64KiB
variance, 256 KiB|--budget 256KiB
ROWS
}

e1_tables() { ACDF=$acdf TABLES=$1 "$root/docs/make/method_tables.sh" "$data/probes"; }
e1_fits() { e1_tables fits; }
e1_sizes() { e1_tables sizes; }
e1_options() { e1_tables options; }
e1_ratio() { e1_tables ratio; }
building() { e1_tables building; }
octahedral() {
    ACDF=$acdf PYTHONPATH="$root/build/release/lib/python" "${PYTHON:-/usr/bin/python3}" "$root/docs/make/octahedral_exact.py" "$data"
}

# ---- E2: rows of it ---------------------------------------------------------------------------------------

e2() {
    local row
    echo "| row | knots | uniform: RMS error of the PDF | cdf | factor | pdf, factor |"
    echo "|---|---|---|---|---|---|"
    for row in auto-peaky auto-smooth; do
        "$acdf" scanline "$data/probes/grace_probe.hdr" --projection angular --row $row --json 2> /dev/null > "$results/e2-$row.json"
        jq -r --arg row "${row#auto-}" "$jq_lib"' .row as $r | .points[] | "| \($row) (\($r)) | \(.segments) | \(.uniform.rms_error|sig) | \(.cdf.rms_error|sig) | \(.cdf.factor|sig)× | \(.pdf.factor|sig)× |"' \
            "$results/e2-$row.json"
    done
}

# ---- E3 to E6: files, from scripts of their own ---------------------------------------------------------------

e3() { "$root/docs/make/brdf_tables.sh" "$data/brdfs" "$acdf"; }
e4_sizes() { TABLES=sizes "$root/docs/make/local_tables.sh" "$data/probes" "$acdf"; }
e4_baselines() { TABLES=baselines "$root/docs/make/local_tables.sh" "$data/probes" "$acdf"; }
e4_paper() { TABLES=paper "$root/docs/make/local_tables.sh" "$data/probes" "$acdf"; }
e4_bins() { TABLES=bins "$root/docs/make/local_tables.sh" "$data/probes" "$acdf"; }
e4_tiles() { TABLES=tiles "$root/docs/make/local_tables.sh" "$data/probes" "$acdf"; }

# ---- E3 to E6: pictures -----------------------------------------------------------------------------------------

# render NAME SCENE WIDTHxHEIGHT: a table of all samplers
render() {
    "$acdf" render --scene "$root/tools/render/scenes/$2.json" --data "$data" --size "$3" -o "$results/$1" --force --quiet --json \
        > "$results/$1.json"
    echo "\`acdf render --scene tools/render/scenes/$2.json --data DATA --size $3 -o out\`, $(jq -r '"\(.samples) samples a pixel, \(.seeds) seeds, \(.sky_hidden * 100 | round) % of the sky hidden"' "$results/$1.json"):"
    echo
    echo "| sampler | memory | above the horizon: mean, worst pixel | relative variance | median | gain, equal samples | gain, equal time | Sobol: relative variance | gain, equal samples |"
    echo "|---|---|---|---|---|---|---|---|---|"
    jq -r "$jq_lib"' (.sobol.samplers | map({(.sampler): .}) | add) as $sobol | .samplers[] | "| `\(.sampler)` | \(.bytes|size) | \(.share_above_horizon|percent), \(.least_share_above_horizon|percent) | \(shown(.relative_variance)) | \(.relative_variance_median|sig) | \(shown(.equal_samples_gain)) | \(shown(.equal_time_gain)) | \($sobol[.sampler] | shown(.relative_variance)) | \($sobol[.sampler] | shown(.equal_samples_gain)) |"' \
        "$results/$1.json"
}
e3_render() {
    render e3-nickel e3-nickel 20x20
    echo
    render e3-metallic-blue e3-metallic-blue 20x20
}
e4_grace() { render e4-grace e4-grace 32x24; }
e4_stpeters() { render e4-stpeters e4-stpeters 32x24; }
e4_beach() { render e4-beach e4-beach 32x24; }
e5() { render e5-grace e5-grace 32x32; }
e6_cook() { render e6-cook-torrance e6-cook-torrance 24x24; }
e6_nickel() { render e6-nickel e6-nickel 24x24; }
e6_plastic() { render e6-plastic e6-plastic 24x24; }

# E7: the scenes of E6, and one of them behind a wall, with samplers of the product and their baselines.
e7_samplers=('mis(local:1MB,brdf:64KiB)' 'product(local:1MB,brdf:64KiB)'
    'mis(compensated,brdf:64KiB)'
    'mis(warp(local:1MB,brdf:64KiB),brdf:64KiB)' 'mis(tiles:12x12(brdf:64KiB),brdf:64KiB)' 'ris:8(local:1MB,brdf:64KiB)' 'ris:32(local:1MB,brdf:64KiB)')

# scenes NAME SIZE SAMPLES SCENE...: one table of the samplers NAME_samplers, a column a scene
scenes() {
    local -n samplers=$1_samplers
    local name=$1 size=$2 samples=$3 scene options=() reports=() sampler
    shift 3
    for sampler in "${samplers[@]}"; do options+=(--sampler "$sampler"); done
    for scene in "$@"; do
        "$acdf" render --scene "$root/tools/render/scenes/$scene.json" --data "$data" --size "$size" --samples "$samples" \
            "${options[@]}" -o "$results/$name-$scene-$samples" --force --quiet --json > "$results/$name-$scene-$samples.json"
        reports+=("$results/$name-$scene-$samples.json")
    done
    echo "| $samples samples a pixel | $(printf '%s | ' "$@")geometric mean | bias, standard errors |"
    echo "|---|$(printf -- '---|%.0s' "$@")---|---|"
    jq -rs "$jq_lib"' . as $runs | def mean: (map(log) | add / length | exp);
        range($runs[0].samplers | length) as $i | [$runs[].samplers[$i]] as $s |
        "| `\($s[0].sampler)` | \($s | map("\(.equal_samples_gain.value | sig) / \(.equal_time_gain.value | sig)") | join(" | ")) | \([$s[].equal_samples_gain.value] | mean | sig) / \([$s[].equal_time_gain.value] | mean | sig) | \([$s[].bias_standard_errors | fabs] | max | sig) |"' \
        "${reports[@]}"
}
e7_100() { scenes e7 16x16 100 e6-cook-torrance e6-nickel e6-plastic; }
e7_16() { scenes e7 16x16 16 e6-cook-torrance e6-nickel e6-plastic; }
e7_4() { scenes e7 16x16 4 e6-cook-torrance e6-nickel e6-plastic; }
e7_hidden() { scenes e7 16x16 16 e7-hidden; }

hidden() {
    render hidden-grace hidden-grace 32x24
    echo
    echo "The same pixels without occluders:"
    echo
    echo "| sampler | relative variance | gain, equal samples | gain, equal time |"
    echo "|---|---|---|---|"
    jq -r "$jq_lib"' .nothing_hidden.samplers[] | "| `\(.sampler)` | \(shown(.relative_variance)) | \(shown(.equal_samples_gain)) | \(shown(.equal_time_gain)) |"' \
        "$results/hidden-grace.json"
}

# ---- files for an MIS partner ----------------------------------------------------------------------------------------

# Everything that `acdf render` has for diffuse surfaces, beside files for an MIS partner of the cosine.
partner_samplers=('full-cdf' 'mis(full-cdf,cosine)' 'mis-compensated' 'tiles:32x16' 'ris:32' 'env:64KiB' 'local:1MB'
    'mis(local:1MB,cosine)' 'mis(4*local:1MB,cosine)' 'mis(env:64KiB --mis cosine --scene,cosine)'
    'mis(local:1MB --mis cosine,cosine)' 'mis(auto:local:1MB --mis cosine,cosine)')
partner() { scenes partner 24x18 20 e4-grace e4-stpeters e4-beach hidden-grace; }

partner_exact() { ACDF=$acdf "${PYTHON:-/usr/bin/python3}" "$root/docs/make/partner_exact.py" "$data"; }
partner_draws() { ACDF=$acdf "$root/docs/make/partner_tables.sh" "$data" 12x9 24; }

# ---- baselines on the light itself -----------------------------------------------------------------------------------

baselines() {
    "$acdf" sweep "$data/probes/noon_grass_1k.hdr" -o "$results/sweep" --filter nearest --files env,env-cdf,env-pdf,env-uniform \
        --budgets 4KiB,16KiB,64KiB,256KiB,1MB --force --quiet --json > "$results/sweep.json"
    echo "\`acdf sweep DATA/probes/noon_grass_1k.hdr -o out --filter nearest --files env,env-cdf,env-pdf,env-uniform --budgets 4KiB,16KiB,64KiB,256KiB,1MB\`:"
    echo
    echo "| system | memory | relative variance | time of a sample, of the full CDF's | ns a pdf |"
    echo "|---|---|---|---|---|"
    jq -r "$jq_lib"' .rows[] | select(.relative_variance != null) | "| \(.label) | \(.bytes|size) | \(.relative_variance|sig) | \({value: .time_ratio, low: .time_ratio_low, high: .time_ratio_high}|interval) | \(.ns_per_pdf|sig) |"' \
        "$results/sweep.json"
}

# ---- the paper's numbers beside ours --------------------------------------------------------------------------------

# gain RESULT SAMPLER BASELINE: how many times less relative variance, of pictures; not of what is not resolved
gain() {
    jq -r --arg a "$2" --arg b "$3" "$jq_lib"' def v($s): .samplers[] | select(.sampler == $s) | if .resolved then .relative_variance.value else null end; if v($a) and v($b) then "\(v($b) / v($a) | sig) times" else "not resolved" end' "$results/$1.json"
}
summary() {
    local smooth peaky least
    median() { jq -r "$jq_lib"' [.points[].cdf.factor | select(. != null)] | sort | .[length / 2 | floor] | sig' "$results/e2-$1.json"; }
    peaky=$(median auto-peaky)
    smooth=$(median auto-smooth)
    least=$(jq -r "$jq_lib"' .samplers[] | select(.sampler == "full-cdf") | .least_share_above_horizon | percent' "$results/e5-grace.json")
    local ours
    ours=$(jq -r "$jq_lib"' .samplers[] | select(.sampler == "local:1MB") | .least_share_above_horizon | percent' "$results/e5-grace.json")
    cat <<ROWS
| # | the paper | ours | made by |
|---|---|---|---|
| E2, Fig. 6 | 16 times fewer knots on a peaky row, a modest gain on a smooth one | $peaky times and $smooth times (median over 4 to 256 knots, \`cdf\`) | \`acdf scanline\` |
| E3, Fig. 7 | nickel in 3.9 MB with the variance of 65 MB | 64 KiB do as well: the repaired table has $(gain e3-nickel brdf:64KiB brdf-table) its variance | \`acdf render\`, e3-nickel |
| E3, Fig. 7 | metallic blue in 2.3 MB | the same of 64 KiB: $(gain e3-metallic-blue brdf:64KiB brdf-table) | \`acdf render\`, e3-metallic-blue |
| E4, Fig. 10 | 5 times less than the full CDF with rejection | Grace $(gain e4-grace local:1MB full-cdf), St Peter's $(gain e4-stpeters local:1MB full-cdf), Beach $(gain e4-beach local:1MB full-cdf) | \`acdf render\`, e4 |
| E4, Fig. 10 | 20 times less than jittered sampling of a stratified map | Grace $(gain e4-grace local:1MB strata) (by radiance within strata: $(gain e4-grace local:1MB strata:radiance)) | \`acdf render\`, e4-grace |
| E5, Fig. 8 | as few as 3.3 to 5 % of the full CDF's samples above the horizon | full CDF $least, ours $ours in the worst pixel | \`acdf render\`, e5-grace |
| E6, Fig. 11 | combining pays: gains from 1/8 to 8 in one picture | 50 + 50 against 100 of the light: $(gain e6-cook-torrance 'mis(local:1MB,brdf:64KiB)' local:1MB), of the BRDF: $(gain e6-cook-torrance 'mis(local:1MB,brdf:64KiB)' brdf:64KiB) | \`acdf render\`, e6 |
ROWS
}

# ---- into the page ------------------------------------------------------------------------------------------------------

for section in "${@:-${sections[@]}}"; do
    echo "$section" >&2
    "$section" > "$results/$section.md"
    "$root/docs/make/put_table.sh" "$section" < "$results/$section.md"
done
