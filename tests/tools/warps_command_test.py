#!/usr/bin/env python3
"""plumb_warps as a user meets it: lines, JSON, exit codes.

    warps_command_test.py PLUMB_WARPS PROJECT_FOLDER
"""
import json
import os
import subprocess
import sys
import tempfile
import unittest

WARPS = PROJECT = ""


def run(*arguments):
    return subprocess.run([WARPS, *arguments], capture_output=True, text=True, timeout=300)


class WarpsCommand(unittest.TestCase):
    def test_rays_and_paths_of_every_tree_and_way(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "warps.json")
            done = run("--quick", "--meshes", "cornell,hall", "--json", path,
                       os.path.join(PROJECT, "scenes", "cornell-box.xml"))
            self.assertEqual(done.returncode, 0, done.stderr)
            with open(path, encoding="utf-8") as file:
                found = json.load(file)
        self.assertEqual(len(found["rays"]), 2 * 5 * 7)
        self.assertEqual(len(found["paths"]), 8)
        self.assertEqual(len(done.stdout.splitlines()), 78)
        self.assertIn("not measured", found["model"])
        for cell in found["rays"] + found["paths"]:
            self.assertGreater(cell["lanes_used"], 1 / 32)
            self.assertLessEqual(cell["lanes_used"], 1)
            self.assertGreater(cell["warp_instructions"], cell["warp_instructions_alu"])
            self.assertGreater(cell.get("g_rays_per_s", 0) + cell.get("m_paths_per_s", 0), 0)
        cells = {(c["mesh"], c["rays"], c["tree"], c["way"]): c["warp_instructions"] for c in found["rays"]}
        for kind in ("primary", "diffuse", "later"):  # why lanes wait at leaves
            self.assertLess(cells["hall", kind, "binary", "as built"], cells["hall", kind, "binary", "together"])

    def test_mistakes(self):
        for arguments, code, text in (
                ([], 2, "one of them is needed"),
                (["--meshes", "cow"], 2, "cow not in"),
                (["nosuch.xml"], 2, "nosuch.xml"),
                (["--meshes", "cornell", "--json", "/nosuch/x.json"], 5, "/nosuch"),
                ([os.path.join(PROJECT, "README.md")], 3, "README.md:1:1: error:")):
            done = run(*arguments)
            self.assertEqual(done.returncode, code, arguments)
            self.assertIn(text, done.stderr)
            self.assertEqual(done.stdout, "")


if __name__ == "__main__":
    WARPS, PROJECT = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1])
