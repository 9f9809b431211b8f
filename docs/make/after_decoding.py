"""What it takes to fit pixels that a program holds: after_decoding.py PROBE WIDTH [BUDGET]

Reads a lat-long probe (Debian's python3-openimageio), enlarges it to WIDTH columns of half floats in memory, gives it to
acdf.build_environment, and prints a row of a table in docs/appendix/performance-building.md: the processor seconds of all
threads, of that call alone, and the peak memory of all, the pixels included. PYTHONPATH names the folder of the package acdf.
"""

import resource
import sys
import time
from pathlib import Path

import acdf
import numpy as np
import OpenImageIO as oiio

path, width, budget = sys.argv[1], int(sys.argv[2]), sys.argv[3] if len(sys.argv) > 3 else "64KiB"
image = oiio.ImageBuf(path)
columns, rows = image.spec().width, image.spec().height
if width != columns: # smooth, as photographs of that size are
    larger = oiio.ImageBuf(oiio.ImageSpec(width, width // 2, 3, "half"))
    assert oiio.ImageBufAlgo.resize(larger, oiio.ImageBufAlgo.channels(image, (0, 1, 2)), filtername="triangle")
    image = larger
pixels = np.maximum(image.get_pixels("half")[:, :, :3], 0.0)
del image

begin = time.process_time()
made = acdf.build_environment(pixels, budget=budget)
seconds = time.process_time() - begin
memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
print(f"| {Path(path).stem}, {width}×{width // 2}, half floats | {budget} | {seconds:.2f} | {memory} MiB |")
assert made.size > 0
