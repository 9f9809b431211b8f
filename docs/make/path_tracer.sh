#!/usr/bin/env bash
# path_tracer.sh BUILD: docs/figures/path_tracer.png, by docs/examples/path_tracer: 16 samples a pixel, light drawn from the
# cosine, from `acdf env` and from `acdf local` times the surface's lobe.
set -euo pipefail
build=$(cd "$1" && pwd)
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$root/docs/make/build_path_tracer.sh" "$build" "$work"
cd "$work"
python3 "$root/tests/inputs/sky_pfm.py" 1024 sky.pfm
"$build/tools/acdf" env sky.pfm --budget 16KiB -o environment.acdf --quiet
"$build/tools/acdf" local sky.pfm --budget 64KiB --shape small -o product.acdf --quiet
cp product.acdf cosine.acdf
for sampler in cosine environment product; do
    echo "$sampler: $(build/path_tracer $sampler $sampler.acdf sky.pfm $sampler.pfm 16 320)"
done
oiiotool --nosoftwareattrib cosine.pfm environment.pfm product.pfm --mosaic 3x1 --mulc 0.1 --clamp:min=0:max=1 --powc 0.4545 -d uint8 \
    --attrib:type=string Software "" -o "$root/docs/figures/path_tracer.png"
