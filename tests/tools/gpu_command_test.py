#!/usr/bin/env python3
"""plumb_gpu as a user meets it: bits compared by the same kernels on the host, exit codes, JSON; and
that its own CMakeLists.txt needs nothing but a compiler.

    gpu_command_test.py PLUMB_GPU PLUMB_FLATTEN PROJECT_FOLDER
"""
import json
import os
import subprocess
import sys
import tempfile
import unittest

GPU = FLATTEN = PROJECT = ""


def run(*arguments):
    return subprocess.run(arguments, capture_output=True, text=True, timeout=300)


class GpuCommand(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.flat = os.path.join(cls.folder.name, "flat")
        scenes = [os.path.join(PROJECT, "scenes", name) for name in ("cornell-box.xml", "sphere-light.xml")]
        done = run(FLATTEN, "--res", "24", "--spp", "2", cls.flat, *scenes)
        assert done.returncode == 0, done.stderr
        assert done.stdout.count("image ") == 8, done.stdout  # four variants each

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_every_tree_and_schedule_has_the_bits_of_the_file(self):
        path = os.path.join(self.folder.name, "images.json")
        done = run(GPU, "--host", "--images", "--flat", self.flat, "--json", path)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(done.stdout.count("same bits"), 40)
        with open(path, encoding="utf-8") as file:
            images = json.load(file)["images"]
        self.assertEqual(len(images), 40)
        self.assertEqual({image["tree"] for image in images}, {"binary", "wide"})
        self.assertEqual({image["schedule"] for image in images}, {"megakernel", "wavefront", "persistent"})
        self.assertEqual({image["profile"] for image in images}, {"box", "full"})
        self.assertEqual({image["profile"] for image in images if image["scene"] == "cornell-box-full"}, {"full"})
        for image in images:
            self.assertTrue(image["same_image"] and image["same_rays"], image)
            self.assertGreater(image["mpaths_per_s"], 0)

    def test_another_image_is_found(self):
        other = os.path.join(self.folder.name, "other")
        os.makedirs(other, exist_ok=True)
        with open(os.path.join(self.flat, "cornell-box.flat"), "rb") as file:
            content = bytearray(file.read())
        content[-25] ^= 1  # of the hash, which stands before three counts of rays
        with open(os.path.join(other, "cornell-box.flat"), "wb") as file:
            file.write(content)
        done = run(GPU, "--host", "--images", "--flat", other)
        self.assertEqual(done.returncode, 1, done.stdout)
        self.assertEqual(done.stdout.count("BITS"), 5)
        self.assertIn("5 images and hits are not those of the CPU", done.stderr)
        content[-25] ^= 1
        content[-1] ^= 1
        with open(os.path.join(other, "cornell-box.flat"), "wb") as file:
            file.write(content)
        done = run(GPU, "--host", "--images", "--flat", other)
        self.assertEqual(done.stdout.count("RAYS"), 5)
        self.assertEqual(done.returncode, 1)

    def test_what_was_done_before_a_failure_is_kept_and_is_no_skip(self):
        other = os.path.join(self.folder.name, "broken")
        os.makedirs(other, exist_ok=True)
        with open(os.path.join(self.flat, "cornell-box.flat"), "rb") as file:
            content = file.read()
        for name, data in (("a.flat", content), ("b.flat", content[:-1])):
            with open(os.path.join(other, name), "wb") as file:
                file.write(data)
        path = os.path.join(self.folder.name, "broken.json")
        done = run(GPU, "--host", "--images", "--flat", other, "--json", path)
        self.assertEqual(done.returncode, 70, done.stderr)
        self.assertIn("b.flat", done.stderr)
        self.assertNotIn("all bits", done.stdout)
        with open(path, encoding="utf-8") as file:
            found = json.load(file)
        self.assertEqual(len(found["images"]), 5)
        self.assertIn("b.flat", found["failure"])

    def test_without_nvcc_the_build_says_so(self):
        with tempfile.TemporaryDirectory() as folder:  # a PATH with the shell's own tools alone
            for tool in ("bash", "dirname", "readlink", "sed", "mkdir"):
                os.symlink("/usr/bin/" + tool, os.path.join(folder, tool))
            done = subprocess.run([os.path.join(PROJECT, "tools", "gpu")], capture_output=True, text=True,
                                  timeout=60, env={"PATH": folder, "CUDA_HOME": folder})
        self.assertEqual(done.returncode, 70, done.stdout + done.stderr)
        self.assertIn("no nvcc", done.stderr)

    def test_rays_have_the_hits_of_the_cpu(self):
        path = os.path.join(self.folder.name, "rays.json")
        done = run(GPU, "--host", "--rays", "--quick", "--only", "hall", "--json", path)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        with open(path, encoding="utf-8") as file:
            rays = json.load(file)["rays"]
        self.assertEqual([(r["tree"], r["threads"]) for r in rays],
                         [("binary", "one a ray"), ("wide", "one a ray"), ("wide", "persistent")])
        for result in rays:
            kinds = ["primary", "shadow", "diffuse", "later", "random"]
            if result["threads"] == "persistent":
                kinds.remove("shadow")  # closest hits only
            self.assertEqual([c["rays"] for c in result["cells"]], kinds)
            for cell in result["cells"]:
                self.assertEqual(cell["wrong"], 0)
                self.assertGreater(cell["median_mrays_per_s"], 0)
        # Eight children a node in place of two.
        self.assertLess(rays[1]["cells"][0]["nodes_per_ray"], 0.6 * rays[0]["cells"][0]["nodes_per_ray"])
        self.assertLess(rays[1]["bytes_per_triangle"], 1.2 * rays[0]["bytes_per_triangle"])

    def test_without_a_device_it_says_why_in_one_line(self):
        done = run(GPU, "--flat", self.flat, "--images", "--quick", "--repetitions", "1")
        if done.returncode == 0:
            self.skipTest("there is a device")
        self.assertEqual(done.returncode, 6)
        self.assertTrue(done.stderr.startswith("error: cuda: "), done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1)

    def test_mistakes_are_2_and_bad_files_are_named(self):
        for arguments, message in [
            ([], "--flat is missing"),
            (["--flat"], "needs a value"),
            (["--qick"], "'--qick'"),
            (["--images", "--rays"], "contradicts"),
            (["--repetitions", "0", "--rays"], "expected 1 or more"),
        ]:
            done = run(GPU, *arguments)
            self.assertEqual(done.returncode, 2, arguments)
            self.assertIn(message, done.stderr)
        empty = os.path.join(self.folder.name, "empty")
        os.makedirs(empty)
        self.assertIn("no flat scenes", run(GPU, "--host", "--images", "--flat", empty).stderr)
        with open(os.path.join(empty, "x.flat"), "wb") as file:
            file.write(b"nothing")
        self.assertIn("x.flat: not a flat scene", run(GPU, "--host", "--images", "--flat", empty).stderr)

    def test_its_own_build_looks_for_no_package(self):
        with tempfile.TemporaryDirectory() as build:
            done = subprocess.run(["cmake", "-S", os.path.join(PROJECT, "tools", "gpu_src"), "-B", build,
                                   "-DPLUMB_CUDA=OFF"],
                                  capture_output=True, text=True, timeout=300,
                                  env={"PATH": "/usr/local/bin:/usr/bin:/bin"})
            self.assertEqual(done.returncode, 0, done.stderr)
            with open(os.path.join(build, "CMakeCache.txt"), encoding="utf-8") as file:
                cache = file.read()
            for package in ("embree", "TBB", "fmt", "pugixml", "OpenEXR", "CLI11", "GTest"):
                self.assertNotIn(package + "_DIR", cache)


if __name__ == "__main__":
    GPU, FLATTEN, PROJECT = sys.argv[1:4]
    unittest.main(argv=sys.argv[:1])
