#!/usr/bin/env bash
# path_tracer.sh BUILD ACDF: docs/examples/path_tracer, built against the installed reader and Embree. All of its
# samplers give the same mean, and the more each knows the less noise.
set -euo pipefail
build=$1 acdf=$2
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
if ! ls /usr/include/embree3/rtcore.h >/dev/null 2>&1; then
    echo "skipped: no Embree 3 (tools/packages.txt names the package)"
    exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$root/docs/make/build_path_tracer.sh" "$build" "$work"
cd "$work"
python3 "$root/tests/inputs/sky_pfm.py" 256 sky.pfm
"$acdf" env sky.pfm --filter nearest --budget 8KiB -o environment.acdf --quiet
"$acdf" local sky.pfm --filter nearest --budget 64KiB -o local.acdf --quiet
cp local.acdf product.acdf
cp local.acdf cosine.acdf
for sampler in cosine environment local product; do
    build/path_tracer $sampler $sampler.acdf sky.pfm $sampler.pfm 64 80 >$sampler.txt
    echo "$sampler: $(cat $sampler.txt)"
done
# The standard error of a mean of 80 x 50 pixels of 64 samples is sqrt(variance / 256000).
awk '{ mean[NR] = $2; variance[NR] = $4 }
     END { for (i = 1; i <= 4; ++i) {
               apart = mean[i] - mean[3]; if (apart < 0) apart = -apart
               if (!(mean[i] > 0) || apart > 5 * sqrt((variance[i] + variance[3]) / 256000) + 1e-3 * mean[3]) exit 1 }
           if (!(variance[3] < variance[2] && variance[2] < variance[1] && variance[4] < 1.1 * variance[3])) exit 2 }' \
    cosine.txt environment.txt local.txt product.txt || { echo "means or variances are not what they have to be" >&2; exit 1; }
if "$work/build/path_tracer" local environment.acdf sky.pfm out.pfm 4 16 2>refused; then exit 1; fi
grep -q 'is not a file for local' refused
