"""Environments of several maps: those of the program, what `at` takes and returns, and what is refused."""

import os
import subprocess
import tempfile
import unittest

import acdf
import numpy as np

AXES = {"time": [6, 18], "haze": [1, 2]}


def sky(brightness):
    rows = np.linspace(1, brightness, 32, dtype=np.float32)[:, None, None] * np.ones((32, 64, 3), np.float32)
    rows[:, :20] *= 3
    return rows


def lit(column):
    image = np.ones((32, 64), np.float32)
    image[8, column] = 5000
    return image


class Indexed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.maps = [sky(2 + 5 * i) for i in range(4)]
        cls.day = acdf.build_indexed(cls.maps, AXES, budget="8KiB")

    def test_is_that_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            paths = [os.path.join(folder, f"{i}.pfm") for i in range(4)]
            for path, image in zip(paths, self.maps):
                with open(path, "wb") as out:  # rows from the bottom
                    out.write(b"PF\n64 32\n-1.0\n" + image[::-1].tobytes())
            file = os.path.join(folder, "day.acdf")
            subprocess.run([os.environ["ACDF_PROGRAM"], "env", *paths, "-o", file, "--axis", "time=6,18", "--axis", "haze=1,2",
                            "--budget", "8KiB", "--quiet"], check=True)
            theirs = acdf.open(file)
        u = np.random.default_rng(3).random((2000, 2))
        self.assertEqual(theirs.info()["options"], self.day.info()["options"])
        for ours, other in zip(self.day.at(9, 1.5).sample(u), theirs.at(9, 1.5).sample(u)):
            np.testing.assert_allclose(ours, other, atol=1e-2)  # the name of the source takes bytes of theirs

    def test_maps_are_arrays_or_one(self):
        stacked = np.stack(self.maps).astype(np.float64).reshape(2, 2, 32, 64, 3)
        for same in (np.stack(self.maps), stacked, tuple(self.maps)):
            self.assertEqual(acdf.build_indexed(same, AXES, budget="8KiB", threads=1).to_bytes(), self.day.to_bytes())

    def test_sun_is_found_or_given_or_stored_as_other_light(self):
        maps, axes = [lit(20), lit(24), lit(28)], {"time": [0, 1, 2]}
        towards = [[np.sin(np.pi * 8.5 / 32) * f(np.pi - 2 * np.pi * (x + 0.5) / 64) for f in (np.cos, np.sin)] + [
            np.cos(np.pi * 8.5 / 32)] for x in (20, 24, 28)]
        for sun, in_cone in ((True, True), (3 * np.array(towards), True), (False, False), (np.zeros((3, 3)), False)):
            file = acdf.build_indexed(maps, axes, budget="8KiB", sun=sun)
            self.assertEqual(file.at(0.5).sun_share > 0.5, in_cone)

    def test_what_does_not_fit_is_refused(self):
        for axes in ({}, {"time": [1, 2, 3]}, {"time": [1, 2, 2, 3]}, {"phi": [1, 2, 3, 4]}):
            with self.assertRaises(ValueError):
                acdf.build_indexed(self.maps, axes)
        with self.assertRaisesRegex(ValueError, "suns"):
            acdf.build_indexed(self.maps, AXES, sun=[[0, 0, 1]])
        with self.assertRaisesRegex(acdf.BuildError, "size"):
            acdf.build_indexed([*self.maps[:3], np.ones((16, 32))], AXES)

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
