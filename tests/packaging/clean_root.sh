#!/usr/bin/env bash
# clean_root.sh PACKAGES SOURCE MAKE_SKY: a Debian that has never seen acdf installs the packages that debian.sh left in PACKAGES
# by apt; there `acdf env` makes a file, Python samples from it, and a program is built against the library with
# find_package(acdf). Only where it is asked for (ctest -C packages -L packages): it needs root, mmdebstrap and a mirror of
# Debian, and fetches some hundreds of packages.
set -euo pipefail
trap 'echo "clean_root.sh: line $LINENO failed" >&2' ERR
packages=$1 source=$2 make_sky=$3
skip() {
    echo "skipped: $1"
    exit 77
}
[[ $(id -u) == 0 ]] || skip "only root may change its root folder"
command -v mmdebstrap >/dev/null || skip "no mmdebstrap"
compgen -G "$packages/*.deb" >/dev/null || skip "no packages in $packages: packaging.debian makes them"

work=$(mktemp -d)
root=$work/root
clean_up() {
    if mountpoint -q "$root/proc"; then umount "$root/proc"; fi
    rm -rf "$work"
}
trap clean_up EXIT
mmdebstrap --quiet --variant=apt bookworm "$root" "${ACDF_DEBIAN_MIRROR-http://deb.debian.org/debian}" >"$work/mmdebstrap.log" 2>&1 ||
    skip "Debian cannot be had: $(tail -1 "$work/mmdebstrap.log")"
mount -t proc proc "$root/proc"
cp /etc/resolv.conf "$root/etc/"
mkdir "$root/home/acdf"
cp "$packages"/*.deb "$root/home/acdf/"
cp -r "$source/tests/packaging/consumer" "$root/home/acdf/"
"$make_sky" "$root/home/acdf/sky.exr"

inside() { chroot "$root" env -i PATH=/usr/bin:/bin:/usr/sbin:/sbin HOME=/home/acdf DEBIAN_FRONTEND=noninteractive "$@"; }
install() { inside apt-get install -q -y --no-install-recommends "$@" >"$work/apt.log" 2>&1 || { tail -20 "$work/apt.log"; exit 1; }; }
inside apt-get update -q >/dev/null

# The tools, then Python beside them, then what a renderer is built with: each brings what it needs.
cd "$root/home/acdf"
install /home/acdf/$(echo acdf-tools_*.deb)
inside acdf --version
inside acdf env /home/acdf/sky.exr -o /home/acdf/sky.acdf --quiet
inside acdf validate /home/acdf/sky.acdf

install /home/acdf/$(echo python3-acdf_*.deb)
inside python3 - <<'CHECK'
import acdf
import numpy as np

sky = acdf.open("/home/acdf/sky.acdf")
direction, pdf = sky.sample(np.random.default_rng(1).random((1000, 2)))
assert np.array_equal(sky.pdf(direction), pdf)
assert acdf.build_environment(np.ones((8, 16)), cells=64).kind == "environment"
CHECK

install cmake g++ make /home/acdf/$(echo libacdf0_*.deb) /home/acdf/$(echo libacdf-dev_*.deb)
for library in acdf::reader acdf::acdf-shared; do
    inside cmake -S /home/acdf/consumer -B /home/acdf/build -DACDF_LIBRARY=$library >"$work/build.log"
    inside cmake --build /home/acdf/build >>"$work/build.log" || { cat "$work/build.log"; exit 1; }
    inside /home/acdf/build/consumer_c /home/acdf/sky.acdf >"$work/c.txt"
    inside /home/acdf/build/consumer_cpp /home/acdf/sky.acdf | diff - "$work/c.txt"
done

# They go as they came.
inside apt-get purge -q -y acdf-tools python3-acdf libacdf0 libacdf-dev >"$work/apt.log" 2>&1 || { tail -20 "$work/apt.log"; exit 1; }
if find "$root/usr" -path "$root/usr/share/doc" -prune -o -iname '*acdf*' -print | grep .; then
    echo "left behind" >&2
    exit 1
fi
