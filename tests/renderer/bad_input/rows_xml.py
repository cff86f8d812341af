"""Scene files: XML, values, references."""
from row import CAMERA, INTEGRATOR, LIGHT, SHAPE, Row, bad, raw, scene, warned, whole


def radius(value):
    return f'<shape type="sphere"><float name="radius" value="{value}"/></shape>'


def film(body):
    return f'<sensor type="perspective"><film type="hdrfilm">\n{body}</film></sensor>'


def cube(operation):
    return f'<shape type="cube"><transform name="to_world">\n{operation}</transform></shape>'


def sparse(size, start):
    """A file that takes no space on the disk."""
    def make(path):
        with open(path, "wb") as file:
            file.write(start)
            file.truncate(size)
    return make


BILLION_LAUGHS = '<!DOCTYPE s [<!ENTITY a "lol">' + "".join(
    f'<!ENTITY {chr(98 + i)} "{f"&{chr(97 + i)};" * 10}">' for i in range(9)) + "]>\n<scene>&j;</scene>"
DEEP = {f"deep{i}.xml": f'<scene version="3.0.0"><include filename="deep{i + 1}.xml"/></scene>' for i in range(20)}
RGB = '<bsdf type="diffuse"><rgb name="reflectance" value="{}"/></bsdf>'

FILES = [
    Row("missing file", 3, "scene.xml", "cannot open: No such file or directory"),
    Row("directory", 3, "scene.xml", "is a directory (expected a file)", {"scene.xml/a": ""}),
    Row("unreadable", 3, "scene.xml", "cannot open: Permission denied", {"scene.xml": whole()},
        prepare="chmod 000 scene.xml", as_nobody=True),
    raw("empty", "1:1", "no XML element in the file", ""),
    raw("only white space", "1:1", "no XML element in the file", " \n\t\n"),
    raw("NUL bytes", "2:3", "NUL byte in XML", "<scene>\n a\0b</scene>"),
    raw("odd-length UTF-16", "", "UTF-16 text of odd length (got 5 bytes)", b"\xff\xfe<\0s"),
    raw("bad UTF-8", "1:12", "bad UTF-8 (got byte 0xc3)", b'<scene id="\xc3("/>'),
    raw("truncated", "2:17", "unexpected end of the file", '<scene version="3.0.0">\n<shape type="sph'),
    raw("mismatched tags", "3:1", "mismatched tags (got </scene>, expected </shape>", "<scene>\n <shape>\n</scene>"),
    raw("two roots", "2:1", "second root element", '<scene version="3.0.0"/>\n<scene/>'),
    raw("duplicate attribute", "2:2", "attribute 'version' given twice", "<scene version='3.0.0'\n version='2.0.0'/>"),
    raw("DOCTYPE: billion laughs", "1:1", "a DOCTYPE is refused", BILLION_LAUGHS),
    raw("DOCTYPE: external entity", "1:22", "a DOCTYPE is refused",
        '<?xml version="1.0"?><!DOCTYPE scene SYSTEM "file:///etc/passwd"><scene/>'),
    raw("undefined entity", "1:13", "undefined entity (got '&nbsp;'", "<scene id='a&nbsp;b'/>"),
    raw("nesting of 1e5", "1:386", "elements nested too deeply (expected at most 64)",
        "<scene>" + "<bsdf>" * 100000),
    raw("a 100 MB attribute", "1:12", "value of 'id' too long (got 100000000 bytes, expected at most 1048576)",
        b'<scene id="' + b"a" * 100_000_000 + b'"/>'),
    Row("include cycle", 3, "b.xml:2:20", "'scene.xml' includes itself",
        {"scene.xml": scene("<include filename='b.xml'/>"),
         "b.xml": scene("<include filename='scene.xml'/>")}, chain=["scene.xml:2:1"]),
    Row("include depth > 15", 3, "deep14.xml:1:43", "includes nested too deeply (expected at most 15)",
        {"scene.xml": scene('<include filename="deep0.xml"/>'), **DEEP},
        chain=[f"deep{i}.xml:1:24" for i in range(13, -1, -1)] + ["scene.xml:2:1"]),
    bad("include missing", "2:20", "included file 'none.xml' not found", '<include filename="none.xml"/>'),
    raw("larger than 1 GiB", "", "is too large", sparse(2**31, b"<scene>")),
]

NAMES = [
    raw("unknown root", "1:1", "unknown root element (got <scenes>, expected <scene>)", '<scenes version="3.0.0"/>'),
    bad("unknown plugin", "2:14", "unknown plugin 'cubes' (shape) (did you mean 'cube'?)", '<shape type="cubes"/>'),
    bad("missing required attribute", "2:1", "missing attribute 'type' of <shape>", "<shape/>"),
    bad("a property given twice", "3:14", "property 'radius' of shape 'sphere' given twice",
        '<shape type="sphere"><float name="radius" value="1"/>\n<float name="radius" value="2"/></shape>'),
    bad("duplicate id", "3:26", "id 'a' given twice (first at scene.xml:2:1)",
        '<bsdf type="diffuse" id="a"/>\n<bsdf type="diffuse" id="a"/>'),
    bad("reference to nothing", "2:29", "reference to nothing (got 'bal', expected the id of an element) "
        "(did you mean 'ball'?)", '<shape type="cube"><ref id="bal"/></shape>'),
    bad("reference cycle", "2:1", "reference cycle (bsdf 'a' contains itself)",
        '<bsdf type="twosided" id="a"><ref id="b"/></bsdf>\n<bsdf type="twosided" id="b"><ref id="a"/></bsdf>'),
    bad("undefined $param", "2:50", "undefined parameter '$rad'", radius("$rad")),
    raw("unsupported version", "1:17", "unsupported scene version (got '4.0.0', expected 0.4 to 3.x)",
        '<scene version="4.0.0"/>'),
    bad("unknown property of a known plugin", "2:35", "unknown property 'raduis' of shape 'sphere' "
        "(did you mean 'radius'?)", '<shape type="sphere"><float name="raduis" value="1"/></shape>'),
    bad("a known plugin, not supported", "2:13", "plugin 'roughconductor' (bsdf) is not supported yet",
        '<bsdf type="roughconductor"/>'),
]

FLOATS = [bad(f"float '{value}'", f"2:{50 if value else 43}", f"bad value of 'radius' (got '{value}', expected a "
              "finite decimal number)", radius(value))
          for value in ("1,5", "12abc", "", " ", "nan", "1e999")]
INTEGERS = [bad(f"integer {value}", "3:35", f"bad value of 'crop_width' (got '{value}', expected an integer from 1",
                film(f'<integer name="crop_width" value="{value}"/>'))
            for value in ("99999999999", "-1")]
SIZES = [bad(f"{side} {value}", f"3:{25 + len(side)}", f"bad value of '{side}' (got '{value}', expected an "
             "integer from 1 to 65536)", film(f'<integer name="{side}" value="{value}"/>'))
         for side in ("width", "height") for value in ("0", "-1", "1000000000")]

VALUES = FLOATS + INTEGERS + SIZES + [
    bad("spp 0", "3:37", "bad value of 'sample_count' (got '0', expected an integer from 1",
        '<sensor type="perspective"><sampler type="sobol">\n'
        '<integer name="sample_count" value="0"/></sampler></sensor>'),
    *[bad(f"fov {value}", "2:53", f"bad value of 'fov' (got '{value}', expected degrees above 0 and below 180)",
          f'<sensor type="perspective"><float name="fov" value="{value}"/></sensor>') for value in ("0", "180")],
    bad("look-at with origin = target", "3:1", "lookat with origin = target",
        cube('<lookat origin="1 2 3" target="1 2 3" up="0 1 0"/>')),
    bad("up parallel to the view", "3:1", "lookat with 'up' parallel to the view",
        cube('<lookat origin="0 0 0" target="0 5 0" up="0 1 0"/>')),
    bad("singular matrix", "3:16", "matrix is singular", cube('<matrix value="1 0 0 0 0 1 0 0 1 1 0 0 0 0 0 1"/>')),
    bad("15 values", "3:16", "bad matrix (got 15 numbers, expected 16 or 9)",
        cube('<matrix value="1 0 0 0 0 1 0 0 0 0 1 0 0 0 0"/>')),
    *[bad(f"radius {value}", "2:50", f"bad value of 'radius' (got '{value}', expected a number above 0)",
          radius(value)) for value in ("0", "-1")],
    *[bad(f"reflectance {value}", "2:53", f"bad value of 'reflectance' (got '{value}', expected values from 0 to 1",
          RGB.format(value)) for value in ("0.5 1.1 0.5", "-0.1")],
    bad("negative radiance", "2:54", "bad value of 'radiance' (got '-1'",
        '<emitter type="constant"><rgb name="radiance" value="-1"/></emitter>'),
]

WARNINGS = [
    warned("no sensor", "1:1", "no sensor (a default camera", scene(INTEGRATOR, SHAPE, LIGHT),
           arguments=["--spp", "1", "-o", "out.exr", "scene.xml"], slow=True),
    warned("two sensors", "11:1", "second sensor (the first, at scene.xml:7:1, is used)",
           scene("", *[""] * 3, INTEGRATOR, CAMERA, CAMERA, SHAPE, LIGHT)),
    warned("no emitter", "1:1", "no emitter (the image will be black)", scene(INTEGRATOR, CAMERA, SHAPE)),
]

REPORTED = [
    Row("a property that changes no pixel", 0, "", "ignored    scene.xml:2:",
        {"scene.xml": whole('<shape type="cube"><float name="silhouette_sampling_weight" value="1"/></shape>')},
        ["--explain", "scene.xml"], written=["stdout"]),
    Row("a named substitute with --lenient", 0, "", "ignored    scene.xml:2:1: plugin 'roughconductor' (bsdf) is not "
        "supported yet", {"scene.xml": whole('<bsdf type="roughconductor"/>')},
        ["--lenient", "--explain", "scene.xml"], written=["stdout"]),
]

ROWS = FILES + NAMES + VALUES + WARNINGS + REPORTED
