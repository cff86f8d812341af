"""Tests of tools/setup's command line: what it refuses before it installs or builds.

    setup_command_test.py SETUP
"""
import os
import subprocess
import sys
import unittest

SETUP = os.path.abspath(sys.argv.pop(1))
ROOT = os.path.dirname(os.path.dirname(SETUP))


def run(*arguments):
    return subprocess.run([SETUP, *arguments], capture_output=True, text=True, timeout=60)


class SetupCommand(unittest.TestCase):
    def test_help_is_its_head(self):
        done = run("--help")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("tools/setup PRESET", done.stdout)
        self.assertNotIn("pipefail", done.stdout)

    def test_an_unknown_preset_is_refused_and_leaves_no_folder(self):
        for name in ("--releese", "releas", "rel.ase", ".*", ""):
            done = run(name)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn("unknown preset (got '%s'" % name, done.stderr)
            self.assertFalse(os.path.exists(os.path.join(ROOT, "build-" + name)))

    def test_a_package_without_a_name_is_refused(self):
        done = run("--with")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("--with needs a package", done.stderr)


if __name__ == "__main__":
    unittest.main()
