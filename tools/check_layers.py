#!/usr/bin/env python3
"""Checks that the house stands as planned: who includes whom, which file wraps which library.

    tools/check_layers.py [ROOT]

Reads the sources under ROOT (default: the project), prints a line `FILE:LINE: what` for each
violation and exits 1 if there is one. It runs with the tests. The tables below are the rules; a
new library or a new room is a line in them.
"""
import os
import re
import sys

# Who may include whom. The longest prefix of a file's path that stands here is its room; what it
# includes must begin with one of the entries.
KERNEL_BASE = ["accel/", "renderer/scene/"]
GEOMETRY = ["accel/math/", "accel/geometry.h", "accel/triangle.h", "accel/sphere.h"]
ROOMS = {
    "accel/": ["accel/"],
    "accel/math/": ["accel/math/"],
    "accel/parallel/": ["accel/parallel/"],
    "renderer/scene/": GEOMETRY + ["renderer/scene/"],
    "renderer/sampling/": GEOMETRY + ["renderer/scene/", "renderer/sampling/"],
    "renderer/shading/": GEOMETRY + ["renderer/scene/", "renderer/sampling/", "renderer/shading/"],
    "renderer/integrate/": GEOMETRY
    + ["accel/intersector.h", "accel/parallel/parallel.h", "renderer/scene/", "renderer/sampling/", "renderer/shading/"]
    + ["renderer/integrate/"],
    "renderer/io/": GEOMETRY + ["renderer/scene/", "renderer/io/"],
    "cuda/": KERNEL_BASE + ["renderer/sampling/", "renderer/shading/", "renderer/integrate/", "cuda/"],
    "renderer/": ["accel/", "renderer/", "cuda/"],
    "tools/": ["accel/", "renderer/", "cuda/", "tools/"],
    "tests/": ["accel/", "renderer/", "cuda/", "tools/", "tests/"],
}

# Which files may include which library: pattern of the header, prefixes or whole paths. A program
# file is one directly in renderer/.
PROGRAM = re.compile(r"renderer/[^/]+$")
LIBRARIES = [
    ("Embree", r"embree[34]/", ["accel/embree/"]),
    ("pugixml", r"pugi", ["renderer/io/xml_node.cpp"]),
    ("OpenImageIO", r"OpenImageIO/", ["renderer/io/oiio_module/"]),
    ("OpenColorIO", r"OpenColorIO/", ["renderer/io/colour.cpp"]),
    ("OpenEXR", r"(OpenEXR/|Imath/)?(Imf|Imath|Iex|Ilm|half\.h)", ["renderer/io/exr_"]),
    ("TBB", r"(oneapi/)?tbb/", ["accel/parallel/parallel.cpp"]),
    ("CLI11", r"CLI/", [PROGRAM, "tools/"]),
    ("fmt", r"fmt/", [PROGRAM, "renderer/io/", "renderer/scene/", "tools/", "tests/"]),
    ("zlib", r"zlib\.h", ["renderer/io/", "tests/"]),
    ("CUDA", r"cuda", ["cuda/"]),
    ("GoogleTest", r"g(test|mock)/", ["tests/"]),
    ("Google Benchmark", r"benchmark/", ["tools/", "tests/"]),
    ("POSIX", r"(unistd|fcntl|dlfcn|termios|poll|signal|sys/\w+)\.h", [PROGRAM, "accel/sah/tree_memory.cpp", "renderer/io/", "tools/", "tests/"]),
    ("vector intrinsics", r"\w+intrin\.h", ["accel/"]),
]
STANDARD = re.compile(r"[a-z_0-9]+$")  # <vector>, <cmath>

# These build with a C++20 compiler (or nvcc) alone, whatever the table above allows their folder.
ALONE = re.compile(
    r"accel/(?!embree/|parallel/parallel\.cpp)|cuda/|renderer/(sampling|shading)/|renderer/integrate/(path|pixel)\.h|renderer/scene/\w+\.h"
)
ALONE_MAY = {"vector intrinsics", "CUDA", "POSIX"}

# Headers that the build writes, and who includes them.
GENERATED = {"display_ocio.h": "renderer/io/colour.cpp"}

SOURCES = (".h", ".cpp", ".cu", ".cuh")
SCANNED = ["accel", "renderer", "cuda", "tools", "tests"]
MAX_LINES = 400
INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)[>"]')
# Broken in two so that this file and its test do not report themselves.
LEFT_BEHIND = re.compile(r"\b(TO" r"DO|FIX" r"ME|XX" r"X|HA" r"CK)\b")
FAST_MATH = re.compile(r"-ffast-math|-Ofast|-funsafe-math-optimizations|use_fast_math|fp:fast")


def matches(path, allowed):
    return any(a.match(path) if isinstance(a, re.Pattern) else path.startswith(a) for a in allowed)


def check_project_include(path, header, root):
    if GENERATED.get(header) == path:
        return None
    if not os.path.exists(os.path.join(root, header)):
        return f'"{header}" is not a path from the root (third-party and standard headers take <>)'
    room = max((r for r in ROOMS if path.startswith(r)), key=len)
    if not matches(header, ROOMS[room]):
        return f'{room} must not include "{header}"'
    return None


def check_system_include(path, header):
    if STANDARD.match(header):
        return None
    for name, pattern, allowed in LIBRARIES:
        if re.match(pattern, header):
            if not matches(path, allowed):
                where = ", ".join("renderer/*" if a is PROGRAM else a for a in allowed)
                return f"<{header}>: {name} may be included only in {where}"
            if ALONE.match(path) and name not in ALONE_MAY:
                return f"<{header}>: this file builds with the compiler alone, without {name}"
            return None
    return f"<{header}> is no library that check_layers.py knows"


def check_source(path, lines, root):
    if len(lines) > MAX_LINES:
        yield MAX_LINES + 1, f"{len(lines)} lines (at most {MAX_LINES}: one idea a file)"
    # A .cpp may leave it to its own header, which then comes first.
    first = lines[0] if lines else ""
    own_header = not path.endswith(".h") and first.startswith(f'#include "{os.path.dirname(path)}/')
    if not first.startswith("/// \\file ") and not own_header:
        yield 1, "the first line must say what the file is (/// \\file ...)"
    if path.endswith((".h", ".cuh")) and not any(line.strip() == "#pragma once" for line in lines):
        yield 1, "header without #pragma once"
    for number, line in enumerate(lines, 1):
        include = INCLUDE.match(line)
        if include:
            quoted = include.group(1) == '"'
            header = include.group(2)
            message = check_project_include(path, header, root) if quoted else check_system_include(path, header)
            if message:
                yield number, message


def check_file(path, root):
    name = os.path.basename(path)
    is_source = path.endswith(SOURCES)
    is_build_file = name in ("CMakeLists.txt", "CMakePresets.json") or name.endswith(".cmake")
    try:
        with open(os.path.join(root, path), encoding="utf-8") as file:
            lines = file.read().splitlines()
    except UnicodeDecodeError:
        if is_source:
            yield 1, "not UTF-8"
        return
    if is_source:
        yield from check_source(path, lines, root)
    for number, line in enumerate(lines, 1):
        if LEFT_BEHIND.search(line):
            yield number, "left behind: " + line.strip()
        if is_build_file and FAST_MATH.search(line):
            yield number, "fast math loses hits: " + line.strip()


def files_of(root):
    """Paths from the root, in order: everything in the rooms, and the build files at the root."""
    for name in ("CMakeLists.txt", "CMakePresets.json"):
        if os.path.isfile(os.path.join(root, name)):
            yield name
    for room in SCANNED:
        for folder, folders, names in os.walk(os.path.join(root, room)):
            folders[:] = sorted(f for f in folders if f != "__pycache__")
            for name in sorted(names):
                yield os.path.relpath(os.path.join(folder, name), root)


def violations(root):
    for path in files_of(root):
        for number, message in check_file(path, root):
            yield f"{path}:{number}: {message}"


def main(arguments):
    root = arguments[0] if arguments else os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
    found = list(violations(root))
    for line in found:
        print(line)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
