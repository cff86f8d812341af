#!/usr/bin/env python3
"""The second chart of tools/chart on results that are known. Skipped (77) without numpy."""
import os
import re
import sys
import tempfile
import unittest
import xml.etree.ElementTree

try:
    import numpy as np
except ImportError:
    print("SKIPPED: needs python3-numpy")
    sys.exit(77)
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "../../tools"))
from chart_src import accelerators as ac  # noqa: E402
from chart_src import statistics as st  # noqa: E402
from chart_src.accelerator_svg import accelerator_svg, overlap, place_labels  # noqa: E402

RESULTS = os.path.join(HERE, "../../tools/results")
SVG = "{http://www.w3.org/2000/svg}"


def bench(*cells):
    """Each cell is {configuration: speeds of the repetitions}."""
    meshes = [{"cells": [{"entries": [{"config": c, "mrays_per_s": s} for c, s in cell.items()]}]} for cell in cells]
    return {"cpu": "one", "embree": "3", "meshes": meshes}


def stability(rates):
    """`rates`: {method: [(axis, failures)]} of 1000 trials each."""
    axes = [{"name": n, "group": g, "value": None} for n, g in (("offset", "triangles"), ("needle", "triangles"), ("slab", "boxes"))]
    cells = [{"axis": a, "method": m, "trials": 1000, "failures": f, "rate": f / 1000}
             for m, each in rates.items() for a, f in each]
    return {"cpu": "two", "axes": axes, "cells": cells}


class Accelerators(unittest.TestCase):
    def test_speed_is_the_geometric_mean_of_what_all_have_traced(self):
        speeds, cells = ac.speeds_of(bench({"naive": [1, 1], "sah/medium/avx2": [4, 8], "sah/medium/avx2/stream": [99, 99],
                                            "sah/high/avx2": [99, 99]},
                                           {"naive": [4, 4], "sah/medium/avx2": [9, 18]},
                                           {"sah/medium/avx2": [1000, 1000]}))  # naive was left out
        self.assertEqual((sorted(speeds), cells), (["naive", "sah/medium/avx2"], 2))
        self.assertAlmostEqual(speeds["naive"][0], 2)
        self.assertAlmostEqual(speeds["sah/medium/avx2"][0], 6 * 2 ** 0.5)
        self.assertTrue(speeds["sah/medium/avx2"][1] < 6 < 12 < speeds["sah/medium/avx2"][2])

    def test_failures_are_those_of_all_axes_of_triangles(self):
        rows = ac.failures_of(stability({"naive": [("offset", 0), ("needle", 0), ("slab", 500)],
                                         "embree-default": [("offset", 10), ("needle", 90)]}))
        self.assertEqual((rows["naive"]["failures"], rows["naive"]["trials"], rows["naive"]["low"]), (0, 2000, 0))
        self.assertAlmostEqual(rows["naive"]["high"], 3 / 2000, delta=5e-6)  # the rule of three
        self.assertAlmostEqual(rows["embree-default"]["rate"], 0.05)
        self.assertEqual((rows["embree-default"]["worst_rate"], rows["embree-default"]["worst_axis"]), (0.09, "needle"))

    def test_intervals_of_rates_are_wilsons(self):
        # As interval.cpp gives them to stability.json.
        np.testing.assert_allclose(st.rate_interval(4, 200000), (7.77764e-06, 5.14285e-05), rtol=1e-4)
        np.testing.assert_allclose(st.rate_interval(15273, 200000), (0.0752092, 0.0775371), rtol=1e-5)
        self.assertAlmostEqual(st.rate_interval(0, 1)[1], 0.95)  # one trial excludes nothing below

    def test_every_accelerator_meets_its_own_failures(self):
        names = {c: ac.kind_of(c) for c in ("naive", "naive/mt", "sah/medium/portable", "sah/medium/avx512/mt",
                                            "embree/medium/default", "embree/medium/robust")}
        self.assertEqual([m for m, _ in names.values()],
                         ["naive", "moeller-trumbore-float", "sah-portable", "moeller-trumbore-float",
                          "embree-default", "embree-robust"])
        self.assertEqual(len({name for _, name in names.values()}), len(names))
        for other in ("sah/high/avx2", "sah/medium/avx2/stream", "embree/medium/robust/packet16", "naive/x"):
            self.assertIsNone(ac.kind_of(other))

    def test_who_is_beaten_in_both_is_not_marked(self):
        both = ac.compare(bench({"naive": [1, 1], "sah/medium/avx2": [3, 3], "embree/medium/default": [5, 5],
                                 "embree/medium/robust": [2, 2]}),
                          stability({"naive": [("offset", 0)], "sah-avx2": [("offset", 0)],
                                     "embree-default": [("offset", 50)], "embree-robust": [("offset", 1)]}))
        self.assertEqual({p["config"] for p in both["points"] if p["pareto"]}, {"sah/medium/avx2", "embree/medium/default"})

    def test_results_of_something_else_are_refused(self):
        for one, two in (({}, {}), ([], {}), (bench({"naive": [1]}), {"cells": 1}), (bench({"naive": [-1]}), stability({}))):
            with self.assertRaises(ac.InputError):
                ac.compare(one, two)
        with tempfile.TemporaryDirectory() as folder:
            self.assertIsNone(ac.widest(folder))
            for text in (None, "{"):
                path = os.path.join(folder, "bench-x.json")
                if text:
                    with open(path, "w", encoding="utf-8") as file:
                        file.write(text)
                with self.assertRaisesRegex(ac.InputError, re.escape(path) + ": error: "):
                    ac.load(path)

    def test_the_results_in_the_repository_give_a_chart(self):
        path = ac.widest(RESULTS)
        data = ac.compare(ac.load(path), ac.load(ac.results(RESULTS, "stability")[0]))
        by_method = {p["method"]: p for p in data["points"]}
        self.assertTrue({"naive", "sah-avx512", "embree-default", "embree-robust"} <= set(by_method))
        self.assertEqual(by_method["sah-avx512"]["failures"], 0)
        self.assertGreater(by_method["embree-default"]["rate"], by_method["embree-robust"]["high"])
        root = xml.etree.ElementTree.fromstring(accelerator_svg(data))
        band, = [r for r in root.findall(SVG + "rect") if r.get("class") == "band"]
        top = float(band.get("y"))
        shown = {}
        for group in root.findall(SVG + "g"):
            name = group.find(SVG + "title").text.split(":")[0]
            shape = group.find(SVG + "polygon") if group.find(SVG + "polygon") is not None else group.find(SVG + "circle[@r='3.6']")
            shown[name] = float(shape.get("cy") or shape.get("points").split()[0].split(",")[1])
        self.assertEqual(set(shown), {p["name"] for p in data["points"]})
        for p in data["points"]:
            self.assertEqual(shown[p["name"]] > top, p["failures"] == 0, p["name"])
        self.assertEqual(len(set(shown.values())), len([p for p in data["points"] if not p["failures"]])
                         + len({round(shown[p["name"]], 1) for p in data["points"] if p["failures"]}))  # a lane each

    def test_labels_meet_neither_each_other_nor_markers(self):
        places = [(100, 100), (104, 101), (98, 97), (290, 100), (102, 110)]
        frame = (0, 0, 300, 200)
        boxes = place_labels(places, ["a long name of it"] * 5, [(120, 0, 124, 90)], frame)
        for i, box in enumerate(boxes):
            self.assertTrue(box[0] >= 0 and box[2] <= 300 and box[1] >= 0 and box[3] <= 200)
            self.assertFalse(any(overlap(box, other) for other in boxes[:i]))
            self.assertFalse(any(box[0] < x < box[2] and box[1] < y < box[3] for x, y in places))


if __name__ == "__main__":
    unittest.main()
