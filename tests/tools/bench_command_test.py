#!/usr/bin/env python3
"""plumb_bench as a user meets it: exit codes, messages, and the JSON of a --quick run.

    bench_command_test.py PROGRAM
"""
import json
import os
import subprocess
import sys
import tempfile
import unittest

PROGRAM = ""


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=300)


class BenchCommand(unittest.TestCase):
    def test_quick_run_measures_every_cell_and_own_trees_are_never_wrong(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "bench.json")
            done = run("--quick", "--json", path)
            self.assertEqual(done.returncode, 0, done.stderr)
            with open(path, encoding="utf-8") as file:
                result = json.load(file)
        self.assertEqual(len(result["meshes"]), 8)
        self.assertIn("terrain", done.stdout)
        self.assertLessEqual(max(map(len, done.stdout.splitlines()[1:])), 110)
        self.assertIn("terrain", done.stderr)  # progress
        for mesh in result["meshes"]:
            self.assertEqual([c["rays"] for c in mesh["cells"]],
                             ["primary", "shadow", "diffuse", "later", "random"], mesh["name"])
            for build in mesh["builds"]:
                self.assertEqual(len(build["build_ms"]), 1)
                self.assertGreater(build["bytes_per_triangle"], 0)
            for cell in mesh["cells"]:
                self.check_cell(mesh["name"], cell)
        own = {row["config"] for row in result["summary"]}
        self.assertTrue(any(name.endswith("/stream") for name in own), own)
        for row in result["summary"]:
            self.assertGreater(row["to_robust"]["geometric_mean"], 0)

    def check_cell(self, mesh, cell):
        for entry in cell["entries"]:
            where = (mesh, cell["rays"], entry["config"])
            self.assertEqual(len(entry["mrays_per_s"]), 3, where)
            self.assertGreater(min(entry["mrays_per_s"]), 0, where)
            self.assertGreater(entry["to_default"], 0, where)
            if entry["config"].startswith("embree"):
                # Another arithmetic: a few rays at edges.
                self.assertLessEqual(entry["wrong"], 0.01 * cell["count"] + 1, where)
            else:
                self.assertEqual(entry["wrong"], 0, where)

    def test_every_variant_of_the_own_trees_gives_the_bits_of_naive(self):
        done = run("--quick", "--meshes", "hall,needles", "--configs", "sah/*,naive*",
                   "--repetitions", "1", "--json", "/dev/stdout", "-q")
        self.assertEqual(done.returncode, 0, done.stderr)
        result = json.loads(done.stdout[done.stdout.index("{\n"):])
        for mesh in result["meshes"]:
            for cell in mesh["cells"]:
                for entry in cell["entries"]:
                    self.assertEqual(entry["wrong"], 0, (mesh["name"], cell["rays"], entry["config"]))
                    self.assertIsNone(entry["to_default"])

    def test_the_kernels_of_the_gpu_stand_in_the_same_table(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "bench.json")
            done = run("--quick", "--meshes", "hall", "--configs", "cuda-host/*,naive", "--device", "cuda-host",
                       "--repetitions", "1", "--json", path, "-q")
            self.assertEqual(done.returncode, 0, done.stderr)
            with open(path, encoding="utf-8") as file:
                result = json.load(file)
        for cell in result["meshes"][0]["cells"]:
            entries = {entry["config"]: entry for entry in cell["entries"]}
            for name in ("cuda-host/binary", "cuda-host/wide"):
                self.assertEqual(entries[name]["wrong"], 0, (cell["rays"], name))
                self.assertGreater(entries[name]["nodes_per_ray"], 0)

    def test_without_a_device_it_says_why_in_one_line(self):
        done = run("--quick", "--meshes", "cornell", "--device", "cuda", "--rays", "primary", "-q")
        if done.returncode == 0:
            self.skipTest("there is a device")
        self.assertEqual(done.returncode, 6)
        self.assertTrue(done.stderr.startswith("error: cuda: "), done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1)
        self.assertEqual(done.stdout, "")

    def test_a_mesh_file_is_traced(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "two.obj")
            with open(path, "w", encoding="utf-8") as file:
                file.write("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 .5\nf 1 2 3 4\n")
            done = run("--mesh", path, "--configs", "naive", "--rays", "primary", "--seconds", "0",
                       "--repetitions", "1")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("two: 2 triangles", done.stdout)
            self.assertNotIn("terrain", done.stdout)

    def test_usage_errors_are_2_and_name_the_nearest(self):
        for arguments, message in [
            (["--quikc"], "did you mean '--quick'?"),
            (["--meshes", "terain"], "did you mean 'terrain'?"),
            (["--rays", "primry"], "did you mean 'primary'?"),
            (["--configs", "naiv"], "did you mean 'naive'?"),
            (["--configs", "bvh*"], "--list"),
            (["--repetitions", "0"], "--repetitions"),
            (["--seconds", "x"], "--seconds"),
            (["stray"], "stray"),
            (["--validate", "sah"], "--validate"),
            (["--validate-rays", "5"], "needs --validate"),
            (["--validate", "naive", "--json", "x"], "excludes"),
        ]:
            done = run(*arguments)
            self.assertEqual(done.returncode, 2, arguments)
            self.assertIn(message, done.stderr)
            self.assertEqual(done.stdout, "")

    def test_unreadable_meshes_are_4_and_unwritable_results_5(self):
        self.assertEqual(run("--mesh", "missing.ply").returncode, 4)
        self.assertEqual(run("--mesh", __file__).returncode, 4)
        self.assertEqual(run("--quick", "--json", "/missing/bench.json").returncode, 5)

    def test_validation_finds_nothing_unexplained(self):
        for arguments, equal in [(["naive", "--build-quality", "high"], True), (["embree"], False)]:
            done = run("-q", "--quick", "--validate", *arguments)
            self.assertEqual(done.returncode, 0, done.stderr)
            lines = done.stdout.splitlines()
            self.assertEqual(lines[-1], "unexplained: 0")
            for line in lines[1:-1]:
                self.assertEqual(line.split()[1], "100000")
                if equal:
                    self.assertEqual(line.split()[2], "100000", line)
        self.assertEqual(len(lines), 10)  # a head, eight meshes, the sum

    def test_a_replay_is_traced_or_refused_with_its_line(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "bad.replay")
            with open(path, "w", encoding="utf-8") as file:
                file.write("garbage\n")
            done = run("--replay", path)
            self.assertEqual(done.returncode, 4)
            self.assertIn(f"{path}: error: line 1", done.stderr)
        self.assertEqual(run("--replay", "missing.replay").returncode, 4)

    def test_help_and_list_name_what_can_be_chosen(self):
        self.assertIn("--configs", run("--help").stdout)
        listed = run("--list")
        self.assertEqual(listed.returncode, 0)
        for name in ["hair", "later", "embree/high/robust/packet16", "sah/medium/portable/stream"]:
            self.assertIn(name, listed.stdout)


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
