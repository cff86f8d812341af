"""Output files and the environment."""
from row import CAMERA, INTEGRATOR, LIGHT, SHAPE, Row, scene, whole

FILES = {"scene.xml": whole()}
WIDE = whole().replace('value="8"', 'value="65501"').replace('value="6"', 'value="1"')
HUGE = whole().replace('value="8"', 'value="60000"').replace('value="6"', 'value="60000"')


def output(name, place, what, file, code=5, files=None, **more):
    return Row(name, code, place, what, files or FILES, ["-o", file, "scene.xml"], **more)


OUTPUT = [
    output("output directory missing", "none/out.exr", "the folder 'none' cannot be used: No such file or directory", "none/out.exr"),
    output("output is a directory", "a.exr", "is a directory", "a.exr", files={**FILES, "a.exr/b": ""}),
    output("output read-only", "out.exr", "cannot be written: Permission denied", "out.exr", prepare="chmod 444 out.exr", as_nobody=True),
    output("output folder read-only", "sub/out.exr", "cannot write into the folder 'sub': Permission denied", "sub/out.exr",
           files={**FILES, "sub/a": ""}, prepare="chmod 555 sub", as_nobody=True),
    output("unknown extension", "out.webm", "unknown image format (got '.webm', expected one of exr", "out.webm"),
    output("JPEG wider than 65500", "out.jpg", "", "out.jpg", files={"scene.xml": WIDE}),
    *[output(f"disk full, {kind}", f"out.{kind}", "", f"out.{kind}", before="ulimit -f 0;")
      for kind in ("exr", "png", "hdr", "jpg", "tif", "pfm", "ppm")],
    output("/dev/full", "full.png", "", "full.png", prepare="ln -s /dev/full full.png"),
    Row("/dev/full as standard output", 5, "", "cannot write to the standard output", FILES,
        ["-o", "out.exr", "scene.xml"], before="exec >/dev/full;", written=["out.exr"]),
    output("stale temporary file", "", "", "out.exr", code=0,
           before="echo stale > .out.exr.$$.tmp;", written=["out.exr", ".out.exr.*.tmp"]),
]

QUIET = ["-q", "-o", "out.exr", "scene.xml"]
ENDLESS = ["-q", "--spp", "100000000", "-o", "out.exr", "scene.xml"]
ENVIRONMENT = [
    *[Row(f"SIG{name}", 128 + number, "", "", FILES, ENDLESS, before=f"timeout --preserve-status -s {name} 1", slow=True,
          written=["out.exr"]) for name, number in (("TERM", 15), ("INT", 2), ("HUP", 1))],
    Row("SIGKILL leaves no partial file", 137, "", "", FILES, ENDLESS, before="timeout -s KILL 1", slow=True),
    Row("SIGPIPE on stdout", 141, "", "", FILES, before="exec > >(true); sleep 0.3;", written=["out.exr"]),
    Row("a locale with decimal comma", 3, "scene.xml:2:50", "bad value of 'radius' (got '1,5'",
        {"scene.xml": whole('<shape type="sphere"><float name="radius" value="1,5"/></shape>')}, german=True),
    Row("a locale with decimal comma reads a point", 0, "", "",
        {"scene.xml": whole('<shape type="sphere"><float name="radius" value="1.5"/></shape>')}, QUIET, german=True),
    Row("a 64 kB stack", 0, "", "", FILES, QUIET, before="ulimit -s 64;"),
    Row("RLIMIT_AS of 200 MB", 6, "", "out of memory", {"scene.xml": HUGE}, before="ulimit -v 200000;"),
    Row("no GPU", 6, "", "cuda", FILES, ["--device=cuda", "-o", "out.exr", "scene.xml"]),
]

# Rows that run the program elsewhere: the file, and words that stand in it as long as it does.
ELSEWHERE = {
    "unknown flag (with the nearest)": ("command_line_test.cpp", "--acel=sah box.xml"),
    "missing value": ("command_line_test.cpp", '{"--spp", 2'),
    "--threads 0": ("command_line_test.cpp", "--threads 0 box.xml"),
    "--threads -3": ("command_line_test.cpp", "--threads -3 box.xml"),
    "--threads 1e9": ("command_line_test.cpp", "--threads 1e9 box.xml"),
    "contradictory flags": ("command_line_test.cpp", "--quiet --explain box.xml"),
    "two renders to one file": ("io/write_file_test.cpp", "TwoWritersLeaveOneWholeFile"),
}

ROWS = OUTPUT + ENVIRONMENT
