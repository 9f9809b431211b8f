# shellcheck shell=bash
# For scripts of pages: `run OPTION...` is headless Chromium with a profile of its own, and $work a folder that goes with it.
# Without a browser the test is skipped.
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
if [ -z "$browser" ]; then
    echo "skipped: no chromium (tools/packages.txt names the package)"
    exit 77
fi
work=$(mktemp -d)
# Helpers of the browser may outlive it for a moment, and write to the profile while it is removed.
trap 'rm -rf "$work" || { sleep 2 && rm -rf "$work"; }' EXIT
export HOME=$work TMPDIR=$work # its profile, caches and sockets
run() {
    timeout 120 "$browser" --headless=new --no-sandbox --disable-gpu --disable-dev-shm-usage --no-first-run --hide-scrollbars \
        --user-data-dir="$work/profile" "$@"
}
