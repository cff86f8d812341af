"""What is run: a method is one choice for each thing that the renderer lets one choose."""
import fnmatch

# Option of the renderer, its default, its other choices.
CHOICES = {
    "accel": ("sah", "naive", "embree"),
    "triangle-test": ("watertight", "moeller-trumbore"),
    "estimator": ("mis", "light", "bsdf"),
    "hemisphere": ("cosine", "uniform"),
    "light-sampling": ("solid-angle", "area"),
    "sampler": ("sobol", "independent"),
    "rr": ("throughput", "none", "constant:0.8"),
    "reuse": ("1", "2", "4"),
    "device": ("cpu", "cuda"),
}
NAMED = {
    "default": {},
    "worst": {"accel": "naive", "estimator": "bsdf", "hemisphere": "uniform",
              "light-sampling": "area", "sampler": "independent", "rr": "none"},
    "textbook": {"accel": "naive", "triangle-test": "moeller-trumbore", "estimator": "light",
                 "light-sampling": "area", "sampler": "independent", "rr": "none"},
}


class Method:
    def __init__(self, name, different):
        self.name = name
        self.choices = {key: different.get(key, values[0]) for key, values in CHOICES.items()}

    def arguments(self):
        """Command line of the renderer."""
        return [word for key, value in self.choices.items() for word in ("--" + key, value)]

    def path(self):
        return "/".join(self.choices.values())


def default_list():
    """The default, the worst sensible, the textbook's, and all that differ in one thing."""
    singles = [Method(f"{key}={value}", {key: value}) for key, values in CHOICES.items()
               for value in values[1:] if key != "device"]
    return [Method(name, different) for name, different in NAMED.items()] + singles


def parse_difference(text):
    """Method of 'key=value+key=value'; ValueError says what is wrong."""
    different = {}
    for part in text.split("+"):
        key, _, value = part.partition("=")
        if key not in CHOICES:
            raise ValueError(f"unknown choice (got '{key}', expected {', '.join(CHOICES)})")
        if value not in CHOICES[key] and not (key == "rr" and value.startswith("constant:")):
            raise ValueError(f"unknown {key} (got '{value}', expected {', '.join(CHOICES[key])})")
        different[key] = value
    return Method(text, different)


def select(patterns):
    """Methods of the default list by name or path, with * and ?, or 'key=value+key=value'."""
    chosen = []
    for pattern in patterns:
        found = [m for m in default_list() if fnmatch.fnmatchcase(m.name, pattern)
                 or fnmatch.fnmatchcase(m.path(), pattern)]
        if not found and "=" in pattern:
            found = [parse_difference(pattern)]
        if not found:
            names = ", ".join(m.name for m in default_list())
            raise ValueError(f"no such method (got '{pattern}', expected {names} or KEY=VALUE+...)")
        chosen += [m for m in found if m.name not in [c.name for c in chosen]]
    return chosen
