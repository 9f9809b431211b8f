# %% [markdown]
# An environment map of a few numbers, its pdf, and samples of it. Run all of it: `python3 notebook.py [PICTURE.png]`.
# %%
import sys

import numpy as np

import acdf

# %% The map: a sky that is brighter towards the horizon, a sun, dark ground.
height = 256
row, column = np.mgrid[0:height, 0 : 2 * height]
theta, phi = (row + 0.5) / height * np.pi, np.pi - (column + 0.5) / height * np.pi
w = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], -1)
image = np.where(w[..., 2:] > 0, [0.3, 0.5, 1.0] * (1.5 - w[..., 2:]), 0.05)
sun = w @ np.array([0.6, 0.3, 0.742]) > 0.9995
image[sun] = [5e4, 4.5e4, 4e4]

# %% A file of at most 16 KiB. What it costs is known exactly, and stored in it.
sky = acdf.build_environment(image, budget="16KiB")
accuracy = sky.info()["accuracy"]
print(f"{sky.size} bytes; relative variance of a sample {accuracy['relative_variance']:.2g}")

# %% Samples, and the irradiance on the ground from them.
directions, pdf = sky.sample(np.random.default_rng(1).random((20000, 2)))
texel = (np.arccos(directions[:, 2]) / np.pi * height).astype(int).clip(0, height - 1)
across = ((0.5 - np.arctan2(directions[:, 1], directions[:, 0]) / (2 * np.pi)) * 2 * height).astype(int) % (2 * height)
weight = image[texel, across] * np.maximum(directions[:, 2:], 0) / pdf[:, None]
print("irradiance on the ground, r g b:", np.round(weight.mean(0), 2))

# %% Pictures.
axes = acdf.plot.pdf(sky)
acdf.plot.samples(directions[:2000], ax=axes)
axes.figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "pdf.png", dpi=100)
