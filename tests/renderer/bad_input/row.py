"""What a row of the table is, and the scenes that rows are made of."""
import dataclasses

# Behind what a row is about: a small image.
CAMERA = """<sensor type="perspective"><transform name="to_world">
<lookat origin="0 0 -4" target="0 0 0" up="0 1 0"/></transform>
<sampler type="independent"><integer name="sample_count" value="1"/></sampler>
<film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="6"/></film></sensor>"""
SHAPE = '<shape type="sphere" id="ball"/>'
LIGHT = '<emitter type="constant"/>'
INTEGRATOR = '<integrator type="path"/>'


def scene(body="", *rest):
    """`body` from line 2 on; behind it what else a scene needs."""
    return "\n".join(['<scene version="3.0.0">', body, *rest, "</scene>", ""])


def whole(body=""):
    return scene(body, INTEGRATOR, CAMERA, SHAPE, LIGHT)


@dataclasses.dataclass
class Row:
    """One bad input and what must come of it."""
    name: str
    code: int
    place: str  # FILE:LINE:COL of the message, or a part of it; empty: no place
    what: str  # how the message goes on behind `error: ` or `warning: `
    files: dict = dataclasses.field(default_factory=dict)  # name: text, bytes, or a function of the path
    arguments: list = dataclasses.field(default_factory=lambda: ["-o", "out.exr", "scene.xml"])
    program: str = "renderer"
    chain: list = dataclasses.field(default_factory=list)  # `  included from` lines
    slow: bool = False  # too much input for a second
    prepare: str = ""  # shell in the folder, before anything is measured
    before: str = ""  # shell right before the program, as `ulimit -s 64;` or `timeout 1`
    as_nobody: bool = False  # without rights
    german: bool = False  # a locale with a decimal comma
    written: list = dataclasses.field(default_factory=list)  # files that it writes; out.exr where the code is 0

    def __post_init__(self):
        if self.code == 0 and not self.written and self.program == "renderer":
            self.written = ["out.exr"]


def bad(name, place, what, body, **more):
    """A scene that is refused for what stands in it from line 2 on."""
    return Row(name, 3, f"scene.xml:{place}", what, {"scene.xml": whole(body)}, **more)


def raw(name, place, what, text, **more):
    """A whole scene file that is refused."""
    return Row(name, 3, f"scene.xml:{place}" if place else "scene.xml", what, {"scene.xml": text}, **more)


def warned(name, place, what, text, **more):
    """A scene that renders, with a warning."""
    return Row(name, 0, f"scene.xml:{place}", what, {"scene.xml": text}, **more)
