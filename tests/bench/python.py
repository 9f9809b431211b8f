"""The table of docs/appendix/python.md: a million calls over arrays, in Python and in C++ on the same files. See python.sh."""

import subprocess
import sys
import time

import acdf
import numpy as np

program, *paths = sys.argv[1:]
sky, local, brdf = map(acdf.open, paths)
n = 1000000
i = np.arange(n, dtype=np.float64)
u = np.stack([np.fmod(0.7548776662466927 * i, 1), np.fmod(0.5698402909980532 * i, 1)], -1)
z, phi = 0.05 + 0.95 * u[:, 0], 2 * np.pi * u[:, 1]
normals = np.stack([np.sqrt(1 - z * z) * np.cos(phi), np.sqrt(1 - z * z) * np.sin(phi), z], -1).astype(np.float32)
out = acdf.Samples(np.zeros((n, 3), np.float32), np.zeros(n, np.float32))
calls = {
    "environment.sample": lambda out=out: sky.sample(u, out=out),
    "environment.pdf": lambda out=out, w=sky.sample(u).direction: sky.pdf(w, out=out and out.pdf),
    "local.sample": lambda out=out: local.sample(normals, u, out=out),
    "local.pdf": lambda out=out, w=local.sample(normals, u).direction: local.pdf(normals, w, out=out and out.pdf),
    "brdf.sample": lambda out=out: brdf.sample(normals, u, out=out),
    "brdf.pdf": lambda out=out, w=brdf.sample(normals, u).direction: brdf.pdf(normals, w, out=out and out.pdf),
}


def cpp():
    out = subprocess.run([program, *paths], check=True, capture_output=True, text=True).stdout
    return {name: float(ns) for name, ns in (line.split() for line in out.splitlines())}


def python(**how):
    least = {name: np.inf for name in calls}
    for _ in range(7):
        for name, call in calls.items():
            begin = time.process_time()
            call(**how)
            least[name] = min(least[name], (time.process_time() - begin) * 1e9 / n)
    return least


# In turns, the least of each, in processor time: others may use the machine.
measures = (cpp, python, lambda: python(out=None))
least = [measure() for measure in measures]
for _ in range(2):
    for have, measure in zip(least, measures):
        have.update({name: min(ns, have[name]) for name, ns in measure().items()})
for name in calls:
    theirs, ours, new = (have[name] for have in least)
    print(f"| {name} | {theirs:.1f} | {ours:.1f} | {new:.1f} | {ours / theirs:.2f} |")
slow = [name for name in calls if least[0][name] < 0.8 * least[1][name]]
if slow:
    raise SystemExit(f"{', '.join(slow)}: Python has less than 0.8 of the speed of C++")
