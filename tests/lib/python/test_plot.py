"""Pictures, where matplotlib is."""

import os
import tempfile
import unittest

import acdf
import numpy as np

try:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot
except ImportError:
    matplotlib = None


@unittest.skipIf(matplotlib is None, "matplotlib is not installed")
class Pictures(unittest.TestCase):
    def test_pdfs_and_samples(self):
        image = np.ones((16, 32))
        image[4, 8] = 100
        for file in (acdf.build_environment(image, cells=100), acdf.build_local(image, budget="64KiB")):
            axes = acdf.plot.pdf(file, height=32)
            acdf.plot.samples([[0, 0, 1], [1, 0, 0]], ax=axes)
            with tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, "pdf.png")
                axes.figure.savefig(path, dpi=40)
                self.assertGreater(os.path.getsize(path), 1000)
            matplotlib.pyplot.close(axes.figure)
        with self.assertRaises(TypeError):
            acdf.plot.pdf(acdf.build_table([1.0, 2.0]))


@unittest.skipIf(matplotlib is not None, "matplotlib is installed")
class Without(unittest.TestCase):
    def test_it_is_asked_for(self):
        with self.assertRaisesRegex(ImportError, "matplotlib"):
            acdf.plot


if __name__ == "__main__":
    unittest.main()
