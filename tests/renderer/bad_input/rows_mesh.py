"""Mesh files, and images as tools/compare reads them."""
import struct

from row import LIGHT, CAMERA, Row, scene
from rows_xml import sparse

THREE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"


def mesh_scene(name):
    kind = name.rpartition(".")[2]
    return scene(f'<shape type="{kind}"><string name="filename" value="{name}"/></shape>', CAMERA, LIGHT)


def obj(name, place, what, text, **more):
    code = more.pop("code", 4)
    return Row(f"OBJ {name}", code, f"a.obj:{place}" if place else "a.obj", what,
               {"a.obj": text, "scene.xml": mesh_scene("a.obj")}, **more)


def fine(name, file, text, **more):
    """No word about it."""
    return Row(name, 0, "", "", {file: text, "scene.xml": mesh_scene(file)}, **more)


def polygon(corners):
    points = "".join(f"v {i} {i % 1000 * (i % 1000)} 0\n" for i in range(corners))
    return points + "f " + " ".join(str(i + 1) for i in range(corners)) + "\n"


OBJ = [
    obj("index 0", "4:3", "invalid vertex index (got '0', expected 1 to 3 or -3 to -1)", THREE + "f 0 1 2\n"),
    obj("index > count", "4:7", "invalid vertex index (got '4', expected 1 to 3", THREE + "f 1 2 4\n"),
    obj("negative beyond the start", "4:9", "invalid vertex index (got '-4'", THREE + "f -1 -2 -4\n"),
    obj("4294967297", "4:3", "invalid vertex index (got '4294967297'", THREE + "f 4294967297 2 3\n"),
    obj("face of 1 index", "4:1", "face has too few corners (got '1', expected at least 3)", THREE + "f 1\n"),
    obj("face of 2 indices", "4:1", "face has too few corners (got '2'", THREE + "f 1 2\n"),
    obj("v with 2 values", "1:6", "number is missing (got the end of the line)", "v 1 2\n"),
    obj("v with NaN", "1:7", "invalid number (got 'nan', expected a decimal number)", "v 1 2 nan\n"),
    obj("1 GB line", "4:1", "line is too long (expected at most 32 MiB)", sparse(2**30, (THREE + "v 1 ").encode())),
    fine("OBJ face with 1e6 vertices", "a.obj", polygon(1000000), slow=True),
    obj("no faces", "", "the mesh has no triangles", THREE, code=0),
    obj("all triangles degenerate", "", "2 of 2 triangles have no area and are dropped", THREE + "f 1 1 2\nf 2 2 3\n",
        code=0),
    fine("OBJ CRLF, tabs, no final newline", "a.obj", "v 0\t0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf\t1 2 3"),
    Row("mesh file missing", 4, "scene.xml:2:50", "file 'a.obj' not found", {"scene.xml": mesh_scene("a.obj")}),
    Row("mesh file a directory", 4, "a.obj", "is a directory", {"scene.xml": mesh_scene("a.obj"), "a.obj/b": ""}),
]

XYZ = "property float x\nproperty float y\nproperty float z\n"
VERTICES = "element vertex 3\n" + XYZ
FACE = "element face 1\nproperty list uchar int vertex_indices\n"
POINTS = "0 0 0\n1 0 0\n0 1 0\n"
BINARY_POINTS = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)


def header(lines, kind="ascii"):
    return f"ply\nformat {kind} 1.0\n{lines}end_header\n"


def binary(lines, body):
    return header(lines, "binary_little_endian").encode() + body


def ply(name, place, what, text):
    return Row(f"PLY {name}", 4, f"a.ply:{place}" if place else "a.ply", what,
               {"a.ply": text, "scene.xml": mesh_scene("a.ply")})


BINARY_START = len(header(VERTICES + FACE, "binary_little_endian")) + 36
PLY = [
    ply("bad magic", "1:1", "no PLY file (got 'plx', expected 'ply')", "plx\n"),
    ply("bad format", "2:8", "unknown PLY format (got 'utf8'", "ply\nformat utf8 1.0\n"),
    ply("bad version", "2:14", "unsupported PLY version (got '2.0', expected 1.0)", "ply\nformat ascii 2.0\n"),
    ply("bad type", "4:10", "unknown PLY type (got 'half'",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty half x\n"),
    ply("element vertex 4294967295 with a body of 100 bytes", "3:16", "too few bytes for element 'vertex' (got 100, "
        "expected at least 4294967295 times 12)", binary("element vertex 4294967295\n" + XYZ, b"\1" * 100)),
    ply("negative count", "3:16", "invalid count of elements (got '-1', expected an unsigned integer)",
        "ply\nformat ascii 1.0\nelement vertex -1\n"),
    *[ply(f"list count {count}", "", f"face has too few vertices (got '{count}', expected at least 3)",
          binary(VERTICES + FACE, BINARY_POINTS + bytes([count]) + bytes(4 * count))) for count in (0, 1, 2)],
    ply("list count 255", "", f"body is truncated at byte {BINARY_START + 13}",
        binary(VERTICES + FACE, BINARY_POINTS + struct.pack("<B3i", 255, 0, 1, 2))),
    ply("truncated body", "", f"body is truncated at byte {BINARY_START + 9}",
        binary(VERTICES + FACE, BINARY_POINTS + struct.pack("<B2i", 3, 0, 1))),
    fine("PLY CRLF header before a binary body", "a.ply",
         binary(VERTICES + FACE, b"").replace(b"\n", b"\r\n") + BINARY_POINTS + struct.pack("<B3i", 3, 0, 1, 2)),
    ply("index out of range", "13:7", "invalid vertex index (got '3', expected less than 3)",
        header(VERTICES + FACE) + POINTS + "3 0 1 3\n"),
    ply("no end_header", "7:1", "unknown header line (got '0'", "ply\nformat ascii 1.0\n" + VERTICES + POINTS),
]

# Not read yet: refused by name.
SERIALIZED = [Row("serialized mesh", 3, "scene.xml:2:14", "plugin 'serialized' (shape) is not supported yet",
                  {"scene.xml": scene('<shape type="serialized"/>', CAMERA, LIGHT)})]


def exr(channels, window=(0, 0, 1, 1), pixels=None):
    """An uncompressed EXR of 32-bit floats; `pixels`: the values of each line, channel by channel."""
    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value
    listed = b"".join(c.encode() + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for c in sorted(channels)) + b"\0"
    box = struct.pack("<4i", *window)
    head = struct.pack("<ii", 20000630, 2) + b"".join([
        attribute("channels", "chlist", listed), attribute("compression", "compression", b"\0"),
        attribute("dataWindow", "box2i", box), attribute("displayWindow", "box2i", box),
        attribute("lineOrder", "lineOrder", b"\0"), attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
        attribute("screenWindowCenter", "v2f", bytes(8)), attribute("screenWindowWidth", "float", struct.pack("<f", 1)),
    ]) + b"\0"
    width, height = 2, 2
    values = pixels or [0.5] * (width * len(channels))
    line = struct.pack(f"<{len(values)}f", *values)
    first = len(head) + 8 * height
    table = b"".join(struct.pack("<Q", first + y * (8 + len(line))) for y in range(height))
    return head + table + b"".join(struct.pack("<ii", y, len(line)) + line for y in range(height))


SOUND = exr("RGB")
NAN = float("nan")


def image(name, what, content, file="a.exr", code=4):
    return Row(f"image {name}", code, file, what, {file: content, "b.exr": SOUND}, [file, "b.exr"], "compare",
               written=["stdout"] if code < 2 else [])


IMAGES = [
    image("truncated", "not a readable EXR", SOUND[:len(SOUND) // 2 + 60]),
    image("EXR data window of 2^31", "not a readable EXR", exr("RGB", (0, 0, 2**31 - 2, 1))),
    image("EXR data window of 2^31 squared", "not a readable EXR", exr("RGB", (-2**30, -2**30, 2**30, 2**30))),
    image("content that is not what the extension says", "not a readable image", SOUND, "a.png"),
    image("0 channels", "not a readable EXR", exr("")),
    image("5 channels, none a colour", "not a readable EXR: no colour in the EXR (got the channels 'P Q S T U'",
          exr("PQSTU")),
    image("NaN texels", "beyond the threshold: 2 values are NaN or infinite in one image only",
          exr("RGB", pixels=[NAN] + [0.5] * 5), code=1),
    *[image(f"format .{kind} is refused", f"unknown image format (got '.{kind}', expected one of exr",
            b"GIF89a", f"a.{kind}") for kind in ("gif", "webp", "bmp", "psd", "tga", "dds")],
]

ROWS = OBJ + PLY + SERIALIZED + IMAGES
