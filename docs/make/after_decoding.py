"""What it takes to fit pixels that a program holds: after_decoding.py WIDTH [BUDGET]

Makes a noisy sky with three suns, WIDTH columns of half floats in memory, gives it to acdf.build_environment, and prints a
row of the table in docs/performance.md: the processor seconds of all threads, of that call alone, and the peak memory of
all, the pixels included. PYTHONPATH names the folder of the package.
"""

import resource
import sys
import time

import acdf
import numpy as np

width, budget = int(sys.argv[1]), sys.argv[2] if len(sys.argv) > 2 else "64KiB"
height = width // 2
random = np.random.default_rng(1)
pixels = np.empty((height, width, 3), np.float16)
for row in range(height):
    z = np.cos(np.pi * (row + 0.5) / height)
    pixels[row] = ((0.6 + 0.4 * z) * (0.8 + 0.4 * random.random(width, np.float32)))[:, None] * (0.7, 0.9, 1.0)
for u, v, radius in ((0.3, 0.2, 0.002), (0.55, 0.45, 0.004), (0.8, 0.3, 0.001)):
    x, y, r = int(u * width), int(v * height), max(1, int(radius * width))
    pixels[y - r : y + r, x - r : x + r] = 3e4

begin = time.process_time()
made = acdf.build_environment(pixels, budget=budget)
seconds = time.process_time() - begin
memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
print(f"| {width}×{height} half floats in memory | `{budget}` | {seconds:.2f} | {memory} MiB |")
assert made.size > 0
