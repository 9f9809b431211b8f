"""Environments of several maps: what `at` takes and returns."""

import os
import subprocess
import tempfile
import unittest

import acdf
import numpy as np


def write_map(path, brightness):
    rows = np.linspace(1, brightness, 32)[:, None, None] * np.ones((32, 64, 3))
    rows[:, :20] *= 3
    with open(path, "wb") as file:
        file.write(b"PF\n64 32\n-1.0\n" + rows[::-1].astype("<f4").tobytes())


class Indexed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            maps = [os.path.join(folder, f"{i}.pfm") for i in range(4)]
            for i, path in enumerate(maps):
                write_map(path, 2 + 5 * i)
            file = os.path.join(folder, "day.acdf")
            subprocess.run([os.environ["ACDF_PROGRAM"], "env", *maps, "-o", file, "--axis", "time=6,18", "--axis", "haze=1,2",
                            "--budget", "8KiB", "--quiet"], check=True)
            cls.day = acdf.open(file)

    def test_names_its_axes(self):
        self.assertEqual(self.day.kind, "indexed")
        self.assertEqual(self.day.axes, ("time", "haze"))
        self.assertEqual(self.day.info()["bins"], 4)

    def test_samples_and_pdfs_agree_at_maps_and_between(self):
        u = np.random.default_rng(3).random((1000, 2))
        for time in (6, 10.5, 18):
            sky = self.day.at(time, haze=1.25)
            w, p = sky.sample(u)
            self.assertEqual((w.dtype, w.shape, p.dtype, p.shape), (np.float32, (1000, 3), np.float32, (1000,)))
            np.testing.assert_array_equal(sky.pdf(w), p)
            np.testing.assert_allclose(sky.invert(w), u, atol=1e-5)
        self.assertTrue(np.isnan(sky.invert([0, 0, 2])).all())
        self.assertEqual(sky.sun_share, 0)

    def test_takes_coordinates_in_order_or_by_name(self):
        up = [[0, 0, 1], [1, 0, 0]]
        same = [self.day.at(9, 2), self.day.at(haze=2, time=9), self.day.at(9, haze=2)]
        for sky in same:
            np.testing.assert_array_equal(sky.pdf(up), same[0].pdf(up))
        self.assertLess(self.day.at(6, 1).total, same[0].total)
        for wrong in (lambda: self.day.at(9), lambda: self.day.at(9, 1, 2), lambda: self.day.at(9, time=9),
                      lambda: self.day.at(9, hour=2)):
            self.assertRaises(TypeError, wrong)

    def test_outlives_its_file(self):
        sky = acdf.open(self.day.to_bytes()).at(9, 2)
        np.testing.assert_array_equal(sky.sample([[0.5, 0.5]]).pdf, self.day.at(9, 2).sample([[0.5, 0.5]]).pdf)


if __name__ == "__main__":
    unittest.main()
