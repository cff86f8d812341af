"""stability.json as the page needs it: axes with their methods, and cells by axis and method."""
import json
import math

from page_src.numbers import power


class Method:
    def __init__(self, entry):
        self.name = entry["name"]
        self.what = entry["what"]
        self.default = entry["default"]
        self.limit = entry.get("limit")  # None: never judged
        self.low = entry.get("from")     # range of that limit; None: no bound
        self.high = entry.get("to")

    def judged_at(self, stress):
        return (self.limit is not None and (self.low is None or stress >= self.low)
                and (self.high is None or stress <= self.high))


class Axis:
    """One axis; cells[method name] is its list of cells, ascending in stress."""

    def __init__(self, entry, cells):
        self.name, self.group, self.title = entry["name"], entry["group"], entry["title"]
        self.unit, self.tested, self.failure = entry["unit"], entry["tested"], entry["failure"]
        self.range, self.value, self.stresses = entry["range"], entry["value"], entry["stresses"]
        self.methods = [Method(m) for m in entry["methods"]]
        self.cells = {m.name: [] for m in self.methods}
        for cell in cells:
            if cell["axis"] == self.name:
                self.cells[cell["method"]].append(cell)

    @property
    def counts(self):
        return self.value is None

    def badness(self, cell):
        """The rate or the value; infinite where it is no number."""
        number = cell["rate"] if self.counts else cell["value"]
        return math.inf if number is None else number

    @property
    def limit(self):
        """Of the default."""
        return max((m.limit for m in self.methods if m.default and m.limit is not None), default=0)

    def judged(self, method):
        """The cells over which a method has a limit: all where it has none."""
        cells = self.cells[method.name]
        within = [c for c in cells if method.judged_at(c["stress"])]
        return within if within else cells

    def worst(self, method):
        return max(self.judged(method), key=self.badness)

    def mark(self, method):
        """✓ holds its limit, ✓* only within its range, ✗ not even there; nothing without a limit."""
        if method.limit is None:
            return ""
        if self.wrong(method):
            return " ✗"
        beyond = any(self.badness(c) > method.limit for c in self.cells[method.name])
        return " ✓*" if beyond else " ✓"

    def wrong(self, method):
        """The cells that miss the method's limit."""
        return [c for c in self.cells[method.name] if c.get("ok") is False]

    def shown(self, number):
        """A rate or a value for people."""
        if math.isinf(number):
            return "∞"
        if number == 0:
            return "0"
        if not self.counts:
            return power(number, digits=2)
        return f"{100 * number:.2g} %" if number < 0.995 else "100 %"

    def level(self, number):
        """How bad, in five steps: 0 is within the limit, 4 the worst."""
        if number <= self.limit:
            return 0
        if self.counts:
            return 1 if number < 1e-4 else 2 if number < 1e-2 else 3 if number < 0.1 else 4
        ratio = number / self.limit
        return 1 if ratio < 10 else 2 if ratio < 100 else 3 if ratio < 1e4 else 4


class Results:
    def __init__(self, text):
        self.data = json.loads(text)
        self.axes = [Axis(a, self.data["cells"]) for a in self.data["axes"]]

    @property
    def groups(self):
        """Group names in order, each with its axes and the names of their methods in order."""
        groups = {}
        for axis in self.axes:
            axes, methods = groups.setdefault(axis.group, ([], []))
            axes.append(axis)
            methods += [m.name for m in axis.methods if m.name not in methods]
        return groups

    @property
    def wrong(self):
        """(axis, method, cell) of everything that misses its limit."""
        return [(a, m, c) for a in self.axes for m in a.methods for c in a.wrong(m)]
