#!/usr/bin/env bash
# browser.sh ACDF MAKE_SKY: opens the gallery of `acdf batch` in headless Chromium. Fails where the console says anything, a
# picture or the style is missing, or markup that is put into the page runs or loads something.
set -euo pipefail
acdf=$1 make_sky=$2
# shellcheck source=../headless.sh disable=SC1091
. "$(dirname "${BASH_SOURCE[0]}")/../headless.sh"

mkdir "$work/in"
"$make_sky" "$work/in/<b>&\"'.pfm"
(cd "$work" && "$acdf" batch in -o out --gallery --quiet)
page=$work/out/gallery.html

# The page as it is: the console stays silent.
run --enable-logging=stderr --screenshot="$work/page.png" "file://$page" >/dev/null 2>"$work/log" ||
    { cat "$work/log"; exit 1; }
test -s "$work/page.png"
if grep CONSOLE "$work/log"; then
    echo "the console is not silent" >&2
    exit 1
fi

# As if a name had not been escaped: the policy stops what it would do. CONSOLE lines say so.
sed "s|</main>|<script>document.title = 'ran'</script><img src='nowhere.png' onerror=\"document.title = 'ran'\"></main>|" \
    "$page" >"$work/out/attacked.html"
run --enable-logging=stderr --dump-dom "file://$work/out/attacked.html" >"$work/dom" 2>"$work/log"
if grep -q '<title>ran' "$work/dom" || ! grep -q 'CONSOLE.*script' "$work/log" || ! grep -q 'CONSOLE.*nowhere.png' "$work/log"; then
    cat "$work/log" >&2
    echo "the policy of the page stops no scripts and pictures" >&2
    exit 1
fi

# A copy that may run a script, which asks what the page shows.
cat >"$work/script.html" <<'HTML'
<script>addEventListener("load", () => {
    const wrong = [];
    if (document.images.length !== 2 || ![...document.images].every(i => i.naturalWidth)) wrong.push("pictures");
    if (getComputedStyle(document.querySelector("main")).display !== "grid") wrong.push("style");
    if (document.querySelector("h2").textContent !== "<b>&\"'.acdf") wrong.push("name");
    document.title = wrong.length ? "WRONG: " + wrong.join("; ") : "all well";
});</script>
HTML
sed -e '/Content-Security-Policy/d' -e "/<\/head>/{
    r $work/script.html
}" "$page" >"$work/asked.html"
run --virtual-time-budget=5000 --dump-dom "file://$work/asked.html" 2>/dev/null >"$work/dom"
result=$(grep -o '<title>[^<]*' "$work/dom" | sed 's/<title>//')
echo "$result"
[ "$result" = "all well" ]
