"""Tests of tools/check_layers.py: each rule is red on a small tree that breaks it, and only there."""
import os
import sys
import tempfile
import unittest

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "tools"))
sys.dont_write_bytecode = True
import check_layers  # noqa: E402

HEADER = "/// \\file  A header.\n#pragma once\n"
# A tree that breaks nothing: every test puts one file beside it or in place of one of these.
SOUND = {
    "accel/math/vec.h": HEADER + "#include <cmath>\n",
    "accel/geometry.h": HEADER + '#include "accel/math/vec.h"\n',
    "accel/intersector.h": HEADER + '#include "accel/geometry.h"\n',
    "accel/parallel/parallel.cpp": "/// \\file  Threads.\n#include <tbb/task_arena.h>\n",
    "accel/embree/embree_intersector.cpp": "/// \\file  Embree.\n#include <embree3/rtcore.h>\n",
    "renderer/scene/scene.h": HEADER + '#include "accel/geometry.h"\n',
    "renderer/shading/bsdf.h": HEADER + '#include "renderer/scene/scene.h"\n',
    "renderer/integrate/path.h": HEADER + '#include "renderer/shading/bsdf.h"\n',
    "renderer/integrate/render.h": HEADER + '#include "accel/intersector.h"\n',
    "renderer/integrate/render.cpp": '#include "renderer/integrate/render.h"\n\n#include <vector>\n',
    "renderer/io/xml_node.cpp": "/// \\file  XML.\n#include <pugixml.hpp>\n#include <unistd.h>\n",
    "renderer/main.cpp": '/// \\file  Program.\n#include "renderer/integrate/render.h"\n#include <CLI/CLI.hpp>\n',
    "CMakeLists.txt": "add_compile_options(-ffp-contract=off)\n",
}


class CheckLayers(unittest.TestCase):
    def found(self, changes):
        with tempfile.TemporaryDirectory() as root:
            for path, text in {**SOUND, **changes}.items():
                os.makedirs(os.path.dirname(os.path.join(root, path)), exist_ok=True)
                with open(os.path.join(root, path), "w", encoding="utf-8") as file:
                    file.write(text)
            return list(check_layers.violations(root))

    def expect(self, path, text, line, words):
        """The one violation of SOUND with this file in it stands at this line."""
        found = self.found({path: text})
        self.assertEqual(len(found), 1, found)
        self.assertTrue(found[0].startswith(f"{path}:{line}: "), found)
        self.assertIn(words, found[0])

    def test_a_sound_tree_is_green(self):
        self.assertEqual(self.found({}), [])

    def test_math_includes_only_math(self):
        self.expect("accel/math/ray.h", HEADER + '#include "accel/geometry.h"\n', 3, "must not include")

    def test_accel_does_not_know_the_renderer(self):
        self.expect("accel/bvh.h", HEADER + '#include "renderer/scene/scene.h"\n', 3, "must not include")

    def test_io_does_not_know_integrate(self):
        self.expect("renderer/io/load.h", HEADER + '#include "renderer/integrate/render.h"\n', 3, "must not include")

    def test_integrate_does_not_know_io(self):
        text = HEADER + '#include "renderer/io/load.h"\n'
        found = self.found({"renderer/io/load.h": HEADER, "renderer/integrate/film.h": text})
        self.assertEqual(len(found), 1, found)
        self.assertIn("renderer/integrate/film.h:3: ", found[0])

    def test_integrate_sees_only_the_interface_of_accel(self):
        text = HEADER + '#include "accel/sah/build_sah.h"\n'
        found = self.found({"accel/sah/build_sah.h": HEADER, "renderer/integrate/film.h": text})
        self.assertEqual(len(found), 1, found)

    def test_scene_does_not_know_shading(self):
        self.expect("renderer/scene/light.h", HEADER + '#include "renderer/shading/bsdf.h"\n', 3, "must not include")

    def test_a_library_stays_in_the_file_that_wraps_it(self):
        for header in ("embree3/rtcore.h", "pugixml.hpp", "OpenImageIO/imageio.h", "ImfHeader.h", "tbb/parallel_for.h",
                       "OpenColorIO/OpenColorIO.h", "CLI/CLI.hpp", "gtest/gtest.h"):
            with self.subTest(header):
                text = f"/// \\file  Loads.\n#include <{header}>\n"
                self.expect("renderer/io/load_scene.cpp", text, 2, "may be included only in")

    def test_kernels_include_no_library(self):
        for path in ("renderer/shading/fresnel.h", "renderer/integrate/pixel.h", "renderer/scene/rgb.h"):
            with self.subTest(path):
                self.assertEqual(len(self.found({path: HEADER + "#include <fmt/format.h>\n"})), 1)

    def test_an_unknown_library_is_red(self):
        self.expect("renderer/io/a.h", HEADER + "#include <boost/any.hpp>\n", 3, "no library that")

    def test_a_quoted_include_is_a_path_from_the_root(self):
        self.expect("renderer/io/a.h", HEADER + '#include "xml_node.h"\n', 3, "path from the root")

    def test_400_lines_are_green_and_401_red(self):
        self.assertEqual(self.found({"accel/long.h": HEADER + "\n" * 398}), [])
        self.expect("accel/long.h", HEADER + "\n" * 399, 401, "401 lines")

    def test_every_header_guards_itself_and_says_what_it_is(self):
        self.expect("accel/a.h", "/// \\file  A.\n", 1, "#pragma once")
        self.expect("accel/a.h", "#pragma once\n", 1, "\\file")

    def test_a_source_without_header_says_what_it_is(self):
        self.expect("accel/a.cpp", "#include <vector>\n", 1, "\\file")

    def test_fast_math_is_red_in_build_files(self):
        self.expect("accel/CMakeLists.txt", "set(A 1)\nadd_compile_options(-ffast-math)\n", 2, "fast math")
        self.expect("CMakePresets.json", '{ "flags": "-Ofast" }\n', 1, "fast math")

    def test_what_was_left_behind_is_red(self):
        self.expect("accel/a.h", HEADER + "// TO" "DO later\n", 3, "left behind")


if __name__ == "__main__":
    unittest.main()
