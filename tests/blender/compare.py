"""compare.py FOLDER: what was drawn of a scene before (a) and after (b) its sun became a lamp. The means must agree."""
import sys

import numpy as np


def main(folder):
    pictures = {name: np.load(f"{folder}/{name}.npy").astype(np.float64) for name in ("a_many", "b_many", "a_few", "b_few")}
    mean = {name: picture.mean((0, 1)) for name, picture in pictures.items()}
    apart = np.abs(mean["a_many"] - mean["b_many"]) / mean["a_many"]
    noise = {name: ((pictures[name + "_few"] - pictures[name + "_many"]) ** 2).mean() / mean["a_many"].mean() ** 2
             for name in "ab"}
    where = np.abs(pictures["a_many"] - pictures["b_many"]).mean() / mean["a_many"].mean()
    print(f"mean before {np.round(mean['a_many'], 4)}, after {np.round(mean['b_many'], 4)}: {apart.max():.2%} apart; "
          f"pixels {where:.2%} apart; variance of 16 samples {noise['a']:.3g} before, {noise['b']:.3g} after")
    return 0 if apart.max() < 0.01 and where < 0.04 else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
