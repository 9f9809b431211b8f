"""Samples and pdfs of arrays: shapes, types, memory, threads."""

import concurrent.futures
import glob
import os
import pickle
import stat
import subprocess
import sys
import tempfile
import threading
import time
import tracemalloc
import unittest
import unittest.mock

import acdf
import numpy as np

TESTS = os.environ["ACDF_TEST_DIR"]


def golden(name):
    return os.path.join(TESTS, "golden", "v1.0", name + ".acdf")


def numbers(*shape):
    return np.random.default_rng(7).random(shape)


def directions(n, least=-1.0):
    z = least + (1 - least) * (np.arange(n) + 0.5) / n
    phi, r = 2.399963 * np.arange(n), np.sqrt(1 - z * z)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1).astype(np.float32)


class Environments(unittest.TestCase):
    def setUp(self):
        self.sky = acdf.open(golden("zlib"))

    def test_draws_have_the_density_that_they_tell(self):
        w, p = self.sky.sample(numbers(1000, 2))
        self.assertEqual((w.shape, w.dtype, p.shape, p.dtype), ((1000, 3), np.float32, (1000,), np.float32))
        self.assertTrue((p > 0).all())
        np.testing.assert_allclose(np.linalg.norm(w, axis=1), 1, atol=1e-6)
        np.testing.assert_array_equal(self.sky.pdf(w), p)
        np.testing.assert_allclose(self.sky.invert(w), numbers(1000, 2), atol=1e-5)

    def test_the_density_integrates_to_one(self):
        self.assertAlmostEqual(float(self.sky.pdf(directions(200000)).mean()) * 4 * np.pi, 1, delta=0.02)

    def test_any_leading_shape(self):
        u = numbers(4, 5, 2)
        w, p = self.sky.sample(u)
        self.assertEqual((w.shape, p.shape), ((4, 5, 3), (4, 5)))
        self.assertEqual(self.sky.pdf(w).shape, (4, 5))
        one = self.sky.sample(u[2, 3])
        np.testing.assert_array_equal(one.direction, w[2, 3])
        self.assertEqual(one.pdf.shape, ())
        self.assertEqual(self.sky.sample(np.empty((0, 2))).direction.shape, (0, 3))

    def test_any_layout_and_real_type(self):
        u = np.asfortranarray(numbers(50, 2))
        expected = self.sky.sample(np.ascontiguousarray(u))
        for other in (u, u[::-1][::-1], u.astype(">f8"), u.tolist()):
            np.testing.assert_array_equal(self.sky.sample(other).direction, expected.direction)
        odd = np.frombuffer(b"x" + u.tobytes("C"), np.uint8)[1:].view(np.float64).reshape(50, 2)
        self.assertFalse(odd.flags.aligned)
        np.testing.assert_array_equal(self.sky.sample(odd).pdf, expected.pdf)
        self.assertEqual(self.sky.pdf([0, 0, 1]), self.sky.pdf(np.array([0.0, 0.0, 1.0], np.float16)))

    def test_arrays_of_the_right_type_are_not_copied(self):
        n = 200000
        w = directions(n)
        tracemalloc.start()
        self.sky.pdf(w)
        peak = tracemalloc.get_traced_memory()[1]
        self.sky.pdf(w.astype(np.float64))
        converted = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        self.assertLess(peak, 4 * n + 100000)  # the result alone
        self.assertGreater(converted, 12 * n)  # so that the count is known to count

    def test_results_are_written_where_they_are_wanted(self):
        u = numbers(100, 2)
        expected = self.sky.sample(u)
        room = acdf.Samples(np.empty((100, 3), np.float32), np.empty(100, np.float32))
        made = self.sky.sample(u, out=room)
        self.assertTrue(made.direction is room.direction and made.pdf is room.pdf)
        np.testing.assert_array_equal(room.direction, expected.direction)
        self.assertTrue(self.sky.pdf(room.direction, out=room.pdf) is room.pdf)
        np.testing.assert_array_equal(room.pdf, expected.pdf)
        frozen = np.empty(100, np.float32)
        frozen.flags.writeable = False
        for bad in (np.empty(99, np.float32), np.empty(100), np.empty(200, np.float32)[::2], frozen):
            with self.assertRaisesRegex(ValueError, r"out: expected .* float32 and shape \(100,\)"):
                self.sky.pdf(room.direction, out=bad)
        with self.assertRaisesRegex(TypeError, "out: not an array"):
            self.sky.pdf(room.direction, out=[0.0] * 100)

    def test_wrong_arguments_are_told(self):
        for bad, message in (
            (numbers(5, 3), r"u: expected shape \(\.\.\., 2\), got \(5, 3\)"),
            (0.5, r"u: expected shape \(\.\.\., 2\), got \(\)"),
        ):
            with self.assertRaisesRegex(ValueError, message):
                self.sky.sample(bad)
        for bad in (numbers(5, 2) * 1j, np.array([["a", "b"]]), [[None, None]], [[True, False]], [[1, 2], [3]]):
            with self.assertRaisesRegex(TypeError, "u: "):
                self.sky.sample(bad)
        self.assertEqual(self.sky.pdf([np.nan, 0, 1]), 0)
        w, p = self.sky.sample([[np.nan, np.inf], [-1, 2]])  # clamped
        self.assertTrue((p > 0).all())

    def test_copies_beyond_all_memory_are_told(self):
        vast = 1 << 58  # of a single number, but a copy takes an exbibyte or more
        with self.assertRaisesRegex(MemoryError, "u: "):
            self.sky.sample(np.broadcast_to(0.5, (vast, 2)))
        with self.assertRaisesRegex(MemoryError, "array: "):
            acdf.build_table(np.broadcast_to(np.int8(1), (vast,)))
        with self.assertRaisesRegex(MemoryError, "normal_weights: "):
            acdf.build_local(np.ones((4, 8)), normals=[[0, 0, 1]], normal_weights=np.broadcast_to(1, (vast,)))

    def test_threads_sample_at_once(self):
        u = numbers(2000000, 2)
        spans, ticks, done = [], [], threading.Event()

        def draw():
            try:
                for _ in range(3):
                    begin = time.perf_counter()
                    self.sky.sample(u)
                    spans.append((begin, time.perf_counter()))
            finally:
                done.set()

        thread = threading.Thread(target=draw)
        thread.start()
        while not done.is_set():  # stands still while another thread keeps the interpreter's lock
            ticks.append(time.perf_counter())
            time.sleep(0.0005)
        thread.join()
        within = sum(begin < tick < end for begin, end in spans for tick in ticks)
        self.assertGreater(within, 3)


class LocalEnvironments(unittest.TestCase):
    def setUp(self):
        self.light = acdf.open(golden("local"))

    def test_normals_serve_groups_of_samples(self):
        normals, u = directions(6), numbers(6, 4, 2)
        w, p = self.light.sample(normals, u)
        self.assertEqual((w.shape, p.shape), ((6, 4, 3), (6, 4)))
        again = self.light.sample(np.repeat(normals, 4, axis=0), u.reshape(-1, 2))
        np.testing.assert_array_equal(again.direction, w.reshape(-1, 3))
        alone = self.light.sample(normals[3], u[3])
        np.testing.assert_array_equal(alone.pdf, p[3])
        np.testing.assert_array_equal(self.light.pdf(normals, w), p)
        self.assertEqual(self.light.irradiance(normals).shape, (6,))
        self.assertEqual(float(self.light.sample([0, 0, 0], [0.5, 0.5]).pdf), 0)

    def test_shapes_that_do_not_fit_are_told(self):
        message = r"normals: its leading shape \(5,\) does not begin that of u, \(6, 4\)"
        with self.assertRaisesRegex(ValueError, message):
            self.light.sample(directions(5), numbers(6, 4, 2))


class Brdfs(unittest.TestCase):
    def test_large_arrays_are_their_pieces(self):
        for name in ("brdf", "brdf_anisotropic", "brdf_floor"):
            brdf = acdf.open(golden(name))
            wo, u = directions(10000, 0.05), numbers(10000, 2)
            w, p = brdf.sample(wo, u)
            pieces = [brdf.sample(wo[i : i + 1000], u[i : i + 1000]) for i in range(0, 10000, 1000)]
            np.testing.assert_array_equal(np.concatenate([piece.direction for piece in pieces]), w)
            np.testing.assert_array_equal(np.concatenate([piece.pdf for piece in pieces]), p)
            loop = [brdf.pdf(wo[i : i + 1000], w[i : i + 1000]) for i in range(0, 10000, 1000)]
            np.testing.assert_array_equal(brdf.pdf(wo, w), np.concatenate(loop))
            self.assertTrue(((brdf.albedo(wo) >= 0) & (brdf.albedo(wo) < 1.5)).all())
            self.assertEqual(brdf.invert(wo, w).shape, (10000, 2))
            np.testing.assert_array_equal(brdf.sample(wo[7], u).direction[:99], brdf.sample(wo[7], u[:99]).direction)


class Tables(unittest.TestCase):
    def test_samples_and_their_indices(self):
        table = acdf.open(os.path.join(TESTS, "..", "format", "vectors", "table.acdf"))
        axes = table.info()["axes"]
        sampled = sum(axis["role"] == "sampled" for axis in axes)
        index = [0] * (len(axes) - sampled)
        x, p = table.sample(numbers(100, sampled), index)
        self.assertEqual((x.shape, x.dtype), ((100, sampled), np.float64))
        np.testing.assert_array_equal(table.pdf(x, index), p)
        np.testing.assert_allclose(table.invert(x, index)[p > 0], numbers(100, sampled)[p > 0], atol=1e-6)
        with self.assertRaisesRegex(IndexError, "out of range"):
            table.sample(numbers(100, sampled), [99] * len(index))
        with self.assertRaisesRegex(IndexError, "out of range"):
            table.sample(numbers(100, sampled), [-1] * len(index))
        with self.assertRaisesRegex(TypeError, "integers"):
            table.sample(numbers(100, sampled), [0.5] * len(index))
        with self.assertRaisesRegex(ValueError, "indexed axes"):
            table.sample(numbers(100, sampled))

    def test_an_index_of_another_shape_is_refused_without_harm(self):
        # In a program of its own: what is freed twice breaks the allocator some calls later.
        program = """if True:
            import numpy as np, acdf
            table = acdf.build_table(np.ones((3, 4)), indexed=1)
            x, refused = np.full((5, 1), 0.5), 0
            for i in range(3000):
                index = np.zeros(((0, 1, 4, 6)[i % 4], 1), int)
                for call in (table.sample, table.pdf, table.invert):
                    try:
                        call(x, index)
                    except ValueError as error:
                        refused += "index: its leading shape" in str(error)
                kept = [np.empty(i % 7) for i in range(20)]
            print(refused)
        """
        for allocator in ("malloc", "pymalloc"):
            done = subprocess.run(
                [sys.executable, "-B", "-c", program],
                env=dict(os.environ, PYTHONMALLOC=allocator),
                capture_output=True,
                text=True,
            )
            self.assertEqual((done.returncode, done.stdout), (0, "9000\n"), done.stderr)


class Files(unittest.TestCase):
    def test_every_golden_file_opens_both_ways(self):
        paths = glob.glob(golden("*"))
        self.assertGreater(len(paths), 10)
        for path in paths:
            file = acdf.open(path)
            with open(path, "rb") as raw:
                data = raw.read()
            again = acdf.open(data, tables=False)
            self.assertEqual((file.kind, file.size, file.to_bytes()), (again.kind, len(data), data))
            self.assertEqual(acdf.open(bytearray(data)).info(), file.info())
            self.assertLessEqual(again.info()["table_bytes"], file.info()["table_bytes"])
            self.assertEqual(pickle.loads(pickle.dumps(file)).to_bytes(), data)

    def test_bytes_are_kept_while_they_are_read(self):
        with open(golden("smallest"), "rb") as raw:
            sky = acdf.open(raw.read())
        junk = [bytes(range(256)) * 40 for _ in range(1000)]
        self.assertGreater(float(sky.sample([0.5, 0.5]).pdf) + len(junk), 0)
        self.assertEqual(sky.to_bytes()[1:5], b"ACDF")

    def test_what_is_no_file(self):
        with open(golden("zlib"), "rb") as raw:
            data = bytearray(raw.read())
        data[-1] ^= 1
        with self.assertRaises(acdf.FileError) as caught:
            acdf.open(data)
        self.assertEqual((caught.exception.code, caught.exception.rule), (5, 4002))
        with self.assertRaises(FileNotFoundError):
            acdf.open("/no/such/file.acdf")
        with self.assertRaises(OSError):
            acdf.open("/")
        with self.assertRaises(TypeError):
            acdf.open(7.5)

    def test_saved_files_are_the_same(self):
        sky = acdf.open(golden("zlib"))
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "sky.acdf")
            sky.save(path)
            self.assertEqual(acdf.open(path).to_bytes(), sky.to_bytes())
            self.assertEqual(os.listdir(folder), ["sky.acdf"])
            with self.assertRaises(OSError):
                sky.save(os.path.join(folder, "none", "sky.acdf"))

    def test_saving_follows_links(self):
        sky = acdf.open(golden("zlib"))
        with tempfile.TemporaryDirectory() as folder:
            at = lambda *names: os.path.join(folder, *names)
            os.mkdir(at("far"))
            os.symlink(os.path.join("far", "new.acdf"), at("link.acdf"))  # leads to no file yet
            os.symlink("link.acdf", at("twice.acdf"))
            for name in ("link.acdf", "twice.acdf"):
                sky.save(at(name))
                self.assertTrue(os.path.islink(at(name)))
                self.assertEqual(acdf.open(at("far", "new.acdf")).to_bytes(), sky.to_bytes())
            self.assertEqual(os.listdir(at("far")), ["new.acdf"])
            os.symlink("circle", at("circle"))
            for nowhere in ("circle", "far", "far/", "none/"):
                with self.assertRaises(OSError):
                    sky.save(at(nowhere))
            self.assertTrue(os.path.islink(at("circle")))
            self.assertEqual(sorted(os.listdir(folder)), ["circle", "far", "link.acdf", "twice.acdf"])

    def test_saving_keeps_the_mode(self):
        sky = acdf.open(golden("zlib"))
        with tempfile.TemporaryDirectory() as folder:
            new, path = os.path.join(folder, "new.acdf"), os.path.join(folder, "sky.acdf")
            sky.save(new)
            with open(path, "wb"):
                pass
            self.assertEqual(os.stat(new).st_mode, os.stat(path).st_mode)
            for mode in (0o600, 0o640, 0o666, 0o444):
                os.chmod(path, mode)
                sky.save(path)
                self.assertEqual(os.stat(path).st_mode & 0o7777, mode)
                self.assertEqual(os.stat(path).st_size, sky.size)
            if os.geteuid() == 0:
                os.chown(path, 12345, 12346)
                sky.save(path)
                self.assertEqual((os.stat(path).st_uid, os.stat(path).st_gid), (12345, 12346))

    def test_saving_syncs_before_the_file_has_its_name(self):
        calls = []
        fsync, replace = os.fsync, os.replace
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.multiple(
            os,
            fsync=lambda fd: (calls.append(("fsync", os.fstat(fd).st_size)), fsync(fd)),
            replace=lambda *names: (calls.append(("replace",)), replace(*names)),
        ):
            sky = acdf.open(golden("zlib"))
            sky.save(os.path.join(folder, "sky.acdf"))
        self.assertEqual(calls[:2], [("fsync", sky.size), ("replace",)])
        self.assertEqual([call[0] for call in calls], ["fsync", "replace", "fsync"])  # the folder, too

    def test_devices_and_pipes_are_written_to(self):
        sky = acdf.open(golden("zlib"))
        with self.assertRaises(OSError):
            sky.save("/dev/full")
        self.assertTrue(stat.S_ISCHR(os.stat("/dev/full").st_mode))
        sky.save("/dev/null")
        self.assertTrue(stat.S_ISCHR(os.stat("/dev/null").st_mode))
        with tempfile.TemporaryDirectory() as folder:
            pipe = os.path.join(folder, "pipe")
            os.mkfifo(pipe)
            with concurrent.futures.ThreadPoolExecutor(1) as pool:
                saved = pool.submit(sky.save, pipe)
                with open(pipe, "rb") as end:
                    self.assertEqual(end.read(), sky.to_bytes())
                saved.result()
            self.assertTrue(stat.S_ISFIFO(os.stat(pipe).st_mode))

    def test_a_save_that_fails_leaves_the_file_as_it_was(self):
        sky = acdf.open(golden("zlib"))
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "sky.acdf")
            with open(path, "wb") as old:
                old.write(b"old")
            for call in ("fsync", "replace", "chmod"):
                with unittest.mock.patch.object(os, call, side_effect=OSError("no")), self.assertRaises(OSError):
                    sky.save(path)
                self.assertEqual(os.path.getsize(path), 3)
                self.assertEqual(os.listdir(folder), ["sky.acdf"])

    def test_several_threads_save_to_one_path(self):
        files = [acdf.open(golden(name)) for name in ("zlib", "local")]
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "any.acdf")
            with concurrent.futures.ThreadPoolExecutor(8) as pool:
                for done in [pool.submit(files[i % 2].save, path) for i in range(200)]:
                    done.result()
            self.assertIn(acdf.open(path).to_bytes(), [file.to_bytes() for file in files])
            self.assertEqual(os.listdir(folder), ["any.acdf"])

    def test_names_may_be_any_bytes(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, os.fsdecode(b"sky\xff.acdf"))
            acdf.open(golden("zlib")).save(path)
            self.assertEqual(acdf.open(path).kind, "environment")


if __name__ == "__main__":
    unittest.main()
