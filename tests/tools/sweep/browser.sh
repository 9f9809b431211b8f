#!/usr/bin/env bash
# report_browser.sh ACDF MAKE_SKY: opens the page of `acdf sweep` in headless Chromium at desktop and phone width. Fails
# where the console says anything, the page is wider than the window, or a plot does not show the points of the CSV.
set -euo pipefail
acdf=$1 make_sky=$2
# shellcheck source=../headless.sh disable=SC1091
. "$(dirname "${BASH_SOURCE[0]}")/../headless.sh"

# What the page shows, asked in the page itself; names hold what HTML and CSV have to escape.
cat >"$work/ask.js" <<'JS'
addEventListener("load", () => {
    const wrong = [];
    const lines = CSV.trim().split("\n").map(line => {
        const fields = [""];
        let quoted = false;
        for (let i = 0; i < line.length; ++i) {
            if (quoted && line[i] === '"' && line[i + 1] === '"') fields[fields.length - 1] += line[++i];
            else if (line[i] === '"') quoted = !quoted;
            else if (line[i] === "," && !quoted) fields.push("");
            else fields[fields.length - 1] += line[i];
        }
        return fields;
    });
    const head = lines.shift(), rows = lines.map(l => Object.fromEntries(head.map((name, i) => [name, l[i]])));
    const charts = {alone: "equal_time_alone", mis: "equal_time_mis", weight: "max_weight", sample: "ns_per_sample", pdf: "ns_per_pdf",
                    build: "build_seconds"};
    let count = 0;
    for (const [chart, column] of Object.entries(charts)) {
        const svg = document.getElementById("chart-" + chart);
        if (!svg) { wrong.push("no plot " + chart); continue; }
        const box = svg.getBoundingClientRect(), points = [...svg.querySelectorAll("g.point")];
        if (box.width < 250 || box.height < 150) wrong.push("plot " + chart + " is " + box.width + " wide");
        rows.forEach((row, i) => {
            const found = points.filter(p => p.dataset.row === String(i));
            if (found.length !== (row[column] === "" ? 0 : 1)) wrong.push(chart + " has " + found.length + " of row " + i);
            for (const p of found) {
                const at = p.querySelector("circle, polygon").getBoundingClientRect();
                const middle = [(at.left + at.right) / 2, (at.top + at.bottom) / 2];
                if (middle[0] < box.left || middle[0] > box.right || middle[1] < box.top || middle[1] > box.bottom)
                    wrong.push(chart + ": row " + i + " is outside of its plot");
                if (p.dataset.system !== row.system || p.dataset.bytes !== row.bytes ||
                    p.dataset.variance !== row.relative_variance || p.dataset.value !== row[column])
                    wrong.push(chart + ": row " + i + " differs from the CSV");
                ++count;
            }
        });
        // Higher values lie higher, and larger files further right: marks are where the numbers say.
        const place = p => p.querySelector("circle:not(.chosen), polygon").getBoundingClientRect();
        const file = points.filter(p => p.dataset.file === "env");
        for (const a of file) for (const b of file) {
            const middle = p => { const r = place(p); return [(r.left + r.right) / 2, (r.top + r.bottom) / 2]; };
            if (+a.dataset.bytes > 1.2 * b.dataset.bytes && middle(a)[0] <= middle(b)[0]) wrong.push(chart + ": x order");
            if (+a.dataset.value > 1.2 * b.dataset.value && middle(a)[1] >= middle(b)[1]) wrong.push(chart + ": y order");
        }
    }
    const page = document.documentElement;
    if (page.scrollWidth > WIDTH) wrong.push("the page is " + page.scrollWidth + " wide in a window of " + WIDTH);
    if (innerWidth !== WIDTH) wrong.push("the window is " + innerWidth + " wide");
    if (![...document.images].length || [...document.images].some(i => !i.naturalWidth || !i.alt)) wrong.push("pictures");
    if (document.querySelector("h1").textContent !== NAME) wrong.push("name: " + document.querySelector("h1").textContent);
    if (document.scripts.length !== 1) wrong.push("scripts"); // this one
    parent.postMessage("RESULT " + count + " points; " + (wrong.length ? "WRONG: " + wrong.join("; ") : "all well"), "*");
});
JS

name="sky <b>&\"'.pfm"
"$make_sky" "$work/sky.pfm"
mv "$work/sky.pfm" "$work/$name"
(cd "$work" && "$acdf" sweep "$name" -o out --files env,env-mis,local --budgets 8KiB,32KiB --quiet)

for width in 1280 390; do
    # The page as it is: the console must stay silent.
    run --window-size=$width,900 --enable-logging=stderr --screenshot="$work/$width.png" "file://$work/out/report.html" \
        >/dev/null 2>"$work/log" || { cat "$work/log"; exit 1; }
    if grep CONSOLE "$work/log"; then
        echo "the console is not silent at width $width" >&2
        exit 1
    fi
    test -s "$work/$width.png"
    # A copy that may run a script, in a frame of the width asked for: windows have a least one.
    {
        echo '<script>'
        printf 'const WIDTH = %s, NAME = %s, CSV = %s;\n' "$width" "$(jq -n --arg t "$name" '$t' | sed 's/</\\u003c/g')" \
            "$(jq -Rs . "$work/out/sweep.csv" | sed 's/</\\u003c/g')"
        cat "$work/ask.js"
        echo '</script>'
    } >"$work/script.html"
    sed -e '/Content-Security-Policy/d' "$work/out/report.html" >"$work/asked.html"
    sed -i -e "/<\/head>/{
        r $work/script.html
    }" "$work/asked.html"
    cat >"$work/frame.html" <<HTML
<body><iframe src="asked.html" style="width:${width}px;height:900px;border:0"></iframe><pre>no answer</pre>
<script>onmessage = e => { document.querySelector("pre").textContent = e.data; };</script></body>
HTML
    run --window-size=1400,1000 --virtual-time-budget=5000 --dump-dom "file://$work/frame.html" 2>/dev/null \
        >"$work/dom" || true
    result=$(grep -o '<pre>[^<]*' "$work/dom" | sed 's/<pre>//' || true)
    echo "width $width: $result"
    case $result in
    "RESULT "[1-9]*"all well") ;;
    *) exit 1 ;;
    esac
done
