"""Files from arrays: the same as the program makes, and errors that say what is wrong."""

import doctest
import json
import os
import subprocess
import tempfile
import unittest

import acdf
import acdf.build
import acdf.files
import numpy as np

PROGRAM = os.environ["ACDF_PROGRAM"]
TESTS = os.environ["ACDF_TEST_DIR"]


def sky_image(height=32):
    y, x = np.mgrid[0:height, 0 : 2 * height]
    image = np.stack([0.1 + y / height, 0.2 + x / (2 * height), np.ones_like(x) * 0.3], -1)
    image[height // 4, height // 3] = 900
    return image.astype(np.float32)


def acdf_program(*arguments):
    return subprocess.run([PROGRAM, *arguments], check=True, capture_output=True, text=True).stdout


class Built(unittest.TestCase):
    def test_rebuilt_environments(self):
        image, other = sky_image(), sky_image()
        other[3:7, 10:20] = 7
        u = np.random.default_rng(5).random((2000, 2))

        def same(a, b):
            return all(np.array_equal(x, y) for x, y in zip(a.sample(u), b.sample(u)))

        built = acdf.build_environment(other, budget="2KiB", filter="bilinear")
        variance = built.info()["accuracy"]["relative_variance"]
        for quality in ("fast", "best"):
            sky = acdf.EnvironmentRebuilder(64, 32, budget="2KiB", quality=quality, filter="bilinear")
            first = sky.rebuild(image, threads=1)
            changed = sky.update(other, (10, 3, 10, 4))
            self.assertTrue(same(changed, sky.rebuild(other)))
            self.assertFalse(same(changed, first))
            self.assertLessEqual(changed.size, 2048)
            self.assertAlmostEqual(sky.relative_variance / variance, 1, delta=0.05)
        self.assertTrue(same(changed, built))
        with self.assertRaises(ValueError):
            sky.rebuild(image[:16])
        with self.assertRaises(ValueError):
            acdf.EnvironmentRebuilder(0, 32, budget="2KiB")

    def test_environments_are_those_of_the_program(self):
        image = sky_image()
        sky = acdf.build_environment(image, cells=300, channel="rgb")
        with tempfile.TemporaryDirectory() as folder:
            probe, made = os.path.join(folder, "sky.pfm"), os.path.join(folder, "sky.acdf")
            with open(probe, "wb") as out:  # rows from the bottom
                out.write(b"PF\n64 32\n-1.0\n" + image[::-1].tobytes())
            acdf_program("env", probe, "-o", made, "--cells", "300", "--channel", "rgb", "--projection", "latlong", "-q")
            theirs = acdf.open(made)
        u = np.random.default_rng(3).random((2000, 2))
        np.testing.assert_array_equal(sky.sample(u).direction, theirs.sample(u).direction)
        np.testing.assert_array_equal(sky.sample(u).pdf, theirs.sample(u).pdf)
        self.assertEqual(sky.info()["accuracy"], theirs.info()["accuracy"])

    def test_pixels_are_read_where_they_lie(self):
        image = sky_image()
        expected = acdf.build_environment(image, cells=200).to_bytes()
        wide = np.zeros((64, 128, 8), np.float64)
        wide[::2, ::-2, 1:7:2] = image
        for same in (image, image.astype(np.float64), np.asfortranarray(image), wide[::2, ::-2, 1:7:2], image.astype(">f4")):
            self.assertEqual(acdf.build_environment(same, cells=200).to_bytes(), expected)
        half = image.astype(np.float16)
        self.assertEqual(
            acdf.build_environment(half, cells=200).to_bytes(),
            acdf.build_environment(half.astype(np.float32), cells=200).to_bytes(),
        )
        grey = image[..., 0]
        self.assertEqual(
            acdf.build_environment(grey, cells=200).total, acdf.build_environment(grey[..., None], cells=200).total
        )

    def test_local_environments(self):
        light = acdf.build_local(sky_image(16), budget="64KiB", threads=1)
        self.assertLessEqual(light.size, 65536)
        w, p = light.sample([0, 0, 1], np.random.default_rng(3).random((1000, 2)))
        self.assertGreater((w[:, 2] > 0).mean(), 0.9)
        self.assertEqual(light.info()["options"], "--budget 65536")
        named = acdf.build_local(sky_image(16), budget="64KiB", normals=[[0, 0, 1], [0, 1, 0]], normal_weights=[3, 1])
        self.assertNotEqual(named.to_bytes(), light.to_bytes())
        with self.assertRaisesRegex(ValueError, "normal_weights: 3 of them for 1 normals"):
            acdf.build_local(sky_image(16), normals=[[0, 0, 1]], normal_weights=[1, 2, 3])

    def test_renderers_are_those_of_the_program(self):
        image = sky_image()
        with tempfile.TemporaryDirectory() as folder:
            probe, made = os.path.join(folder, "sky.pfm"), os.path.join(folder, "sky.acdf")
            with open(probe, "wb") as out:  # rows from the bottom
                out.write(b"PF\n64 32\n-1.0\n" + image[::-1].tobytes())
            for name, renderer in acdf.renderers.items():
                acdf_program("env", probe, "-o", made, "--for", name, "--projection", "latlong", "--force", "-q")
                theirs, ours = acdf.open(made), acdf.build_environment(image, for_renderer=name)
                u = np.random.default_rng(3).random((200, 2))
                np.testing.assert_array_equal(ours.sample(u).direction, theirs.sample(u).direction)
                np.testing.assert_array_equal(ours.sample(u).pdf, theirs.sample(u).pdf)
                w = ours.sample(u).direction
                np.testing.assert_array_equal(renderer.from_light(renderer.to_light(w)), w)
        self.assertEqual(acdf.renderers["cycles"].mirrorball_axes, (2, -1, 3))
        self.assertEqual(acdf.build_environment(image, for_renderer="cycles").info()["partner"]["heuristic"], "power")
        self.assertFalse(acdf.build_environment(image, for_renderer="cycles", mis="none").requires_mis)
        self.assertFalse(acdf.build_environment(image, for_renderer="cycles", max_weight=9).requires_mis)
        nearest = acdf.build_environment(image, for_renderer="cycles", filter="nearest")
        self.assertEqual(nearest.info()["filter"], "nearest")
        with self.assertRaisesRegex(ValueError, "for_renderer: 'v-ray' is none of pbrt-v4"):
            acdf.build_environment(image, for_renderer="v-ray")

    def test_companions(self):
        sky = acdf.build_environment(sky_image(), budget="4KiB", mis="cosine", shares=(2, 1))
        self.assertTrue(sky.requires_mis)
        self.assertEqual(sky.info()["partner"]["kind"], "cosine")

    def test_brdfs_of_tables_and_of_functions(self):
        theta_h = (np.arange(30) + 0.5) / 30 * np.pi / 2
        lobe = 0.1 + 5 * np.exp(-((theta_h / 0.2) ** 2))
        table = np.broadcast_to(lobe[None, None, :, None], (8, 1, 30, 8))
        made = acdf.build_brdf(table, budget="8KiB")
        called = acdf.build_brdf(lambda wo, wi: 1 / np.pi, budget="4KiB", theta_views=2, threads=1)
        for brdf in (made, called):
            self.assertEqual(brdf.kind, "brdf")
            wo = np.array([0.6, 0, 0.8], np.float32)
            w, p = brdf.sample(wo, np.random.default_rng(3).random((500, 2)))
            np.testing.assert_allclose(brdf.pdf(wo, w), p, rtol=1e-3)
        self.assertAlmostEqual(float(called.albedo([0, 0, 1])), 1, delta=0.05)

    def test_tables_are_those_of_the_program(self):
        array = np.random.default_rng(5).random((4, 16, 16))
        table = acdf.build_table(array, indexed=1, cells=50)
        with tempfile.TemporaryDirectory() as folder:
            source, made = os.path.join(folder, "a.npy"), os.path.join(folder, "a.acdf")
            np.save(source, array)
            acdf_program("table", source, "-o", made, "--indexed", "1", "--cells", "50", "-q")
            theirs = acdf.open(made)
        u, index = np.random.default_rng(3).random((4, 100, 2)), [[0], [1], [2], [3]]
        np.testing.assert_array_equal(table.sample(u, index).direction, theirs.sample(u, index).direction)
        self.assertEqual(table.total, theirs.total)


class Errors(unittest.TestCase):
    def test_options_out_of_range(self):
        image = sky_image()
        for options, message in (
            ({"budget": 4096, "cells": 7}, "three goals"),
            ({"budget": "many"}, "no size"),
            ({"filter": "cubic"}, "filter: 'cubic' is none of nearest, bilinear"),
            ({"channel": "alpha"}, "channel: 'alpha' is none of luminance"),
            ({"max_weight": 0.5}, "weight"),
            ({"projection": "angular"}, "square"),
        ):
            with self.assertRaisesRegex(ValueError, message):
                acdf.build_environment(image, **options)
        for build in (acdf.build_local, lambda image, **o: acdf.build_brdf(np.ones((4, 1, 4, 4)), **o)):
            with self.assertRaisesRegex(ValueError, "max_weight"):
                build(image, max_weight=0.5)
        with self.assertRaisesRegex(TypeError, "cells: -4 is of the wrong type or out of range"):
            acdf.build_environment(image, cells=-4)
        with self.assertRaises(TypeError):
            acdf.build_environment(image, sells=4)
        with self.assertRaisesRegex(ValueError, r"image: expected shape .* got \(7,\)"):
            acdf.build_environment(np.zeros(7))
        with self.assertRaisesRegex(TypeError, "image: expected real numbers, got an array of complex128"):
            acdf.build_environment(image.astype(complex))
        with self.assertRaises(ValueError):
            acdf.build_environment(np.zeros((4, 8, 7)))
        with self.assertRaises(ValueError):
            acdf.build_environment(np.zeros((0, 8, 3)))

    def test_sources_that_hold_nothing(self):
        with self.assertRaises(acdf.BuildError) as caught:
            acdf.build_environment(np.zeros((4, 8, 3)))
        self.assertEqual(caught.exception.code, 3)
        bad = sky_image()
        bad[3, 3] = np.nan
        self.assertEqual(acdf.build_environment(bad, cells=50).kind, "environment")
        with self.assertRaises(acdf.BuildError) as caught:
            acdf.build_environment(bad, bad_texels="error")
        self.assertEqual(caught.exception.code, 2)
        with self.assertRaises(acdf.BuildError):
            acdf.build_table([1.0, np.inf])

    def test_progress_is_told_and_cancels(self):
        told = []
        acdf.build_environment(sky_image(), cells=500, progress=lambda share, what: told.append((share, what)))
        self.assertEqual(told, sorted(told, key=lambda one: one[0]))
        self.assertTrue(all(0 <= share <= 1 and isinstance(what, str) for share, what in told) and told)
        with self.assertRaises(acdf.BuildError) as caught:
            acdf.build_environment(sky_image(), progress=lambda share, what: False)
        self.assertEqual(caught.exception.code, 5)

    def test_what_callbacks_raise_is_raised(self):
        def fail(*arguments):
            raise ZeroDivisionError("mine")

        with self.assertRaisesRegex(ZeroDivisionError, "mine"):
            acdf.build_environment(sky_image(), progress=fail)
        with self.assertRaisesRegex(ZeroDivisionError, "mine"):
            acdf.build_brdf(fail, budget="2KiB")
        with self.assertRaisesRegex(ValueError, "returned 2 numbers"):
            acdf.build_brdf(lambda wo, wi: [1, 2], budget="2KiB")
        for wrong, name in ((None, "NoneType"), ("bright", "str"), ({}, "dict")):
            with self.assertRaisesRegex(TypeError, f"returned a {name}, not one number or three"):
                acdf.build_brdf(lambda wo, wi: wrong, budget="2KiB")


class Documentation(unittest.TestCase):
    def test_examples(self):
        for module in (acdf, acdf.files, acdf.build, acdf._renderers):
            with self.subTest(module.__name__):
                found = doctest.testmod(module, optionflags=doctest.ELLIPSIS | doctest.IGNORE_EXCEPTION_DETAIL)
                self.assertEqual(found.failed, 0)
                self.assertGreater(found.attempted, 1)

    def test_examples_of_the_page(self):
        page = os.path.join(TESTS, "..", "docs", "python.md")
        found = doctest.testfile(page, module_relative=False, optionflags=doctest.ELLIPSIS)
        self.assertEqual(found.failed, 0)
        self.assertGreater(found.attempted, 10)

    def test_everything_public_is_documented(self):
        for name in acdf.__all__:
            if name not in ("__version__", "format_version", "plot"):
                self.assertTrue(getattr(acdf, name).__doc__, name)
        for kind in (acdf.File, acdf.Environment, acdf.LocalEnvironment, acdf.Brdf, acdf.Table):
            for name, member in vars(kind).items():
                if not name.startswith("_"):
                    self.assertTrue(member.__doc__, f"{kind.__name__}.{name}")

    def test_info_is_that_of_the_program(self):
        for name in ("zlib", "local", "brdf", "partner"):
            path = os.path.join(TESTS, "golden", "v1.0", name + ".acdf")
            theirs = json.loads(acdf_program("info", "--json", path))
            ours = acdf.open(path).info()
            keys = ("kind", "version", "bytes", "table_bytes", "memory_bytes", "bins", "axes", "fit", "filter", "parameterization")
            for key in (*keys, "total", "chunks"):
                self.assertEqual(ours[key], theirs[key], (name, key))
            self.assertEqual("partner" in ours, "partner" in theirs)
            self.assertEqual(ours.get("accuracy", {}), theirs["accuracy"])

    def test_stubs_name_what_there_is(self):
        import acdf._acdf as module

        with open(os.path.join(os.path.dirname(acdf.__file__), "_acdf.pyi")) as text:
            stub = text.read()
        for name in dir(module):
            if not name.startswith("_"):
                self.assertIn(name, stub)
        for name in dir(module.OpenFile):
            if not name.startswith("_"):
                self.assertIn(f"def {name}(", stub)


if __name__ == "__main__":
    unittest.main()
