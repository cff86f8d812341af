#!/usr/bin/env python3
"""plumb_stability and its page as a user meets them: exit codes, messages, the JSON, the pictures.

    stability_command_test.py PROGRAM WRITE_PAGE
"""
import copy
import html.parser
import json
import os
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

PROGRAM = WRITE_PAGE = ""


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=300)


def write_page(*arguments):
    return subprocess.run([sys.executable, WRITE_PAGE, *arguments], capture_output=True, text=True, timeout=300)


class Page(html.parser.HTMLParser):
    """Collects what a page links to, its ids, its cells, and checks that tags close."""

    VOID = {"meta", "br", "img", "link", "hr", "input"}

    def __init__(self, text):
        super().__init__()
        self.links, self.ids, self.open, self.tags, self.cells = [], set(), [], [], []
        self.in_cell = False
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.tags.append((tag, values))
        if "href" in values:
            self.links.append(values["href"])
        if "id" in values:
            self.ids.add(values["id"])
        if tag == "td":
            self.cells.append((values.get("class", ""), ""))
            self.in_cell = True
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if self.open.pop() != tag:
            raise AssertionError(f"</{tag}> at {self.getpos()}")
        self.in_cell = self.in_cell and tag != "td"

    def handle_data(self, data):
        if self.in_cell:
            kind, text = self.cells[-1]
            self.cells[-1] = (kind, text + data)


def shape_of(marker):
    """Offsets of a marker's corners from its first one; none of a circle's."""
    corners = [tuple(map(float, c.split(","))) for c in marker.get("points", "").split()]
    return tuple((round(x - corners[0][0]), round(y - corners[0][1])) for x, y in corners)


class StabilityCommand(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = os.path.join(cls.temporary.name, "new", "map")
        cls.done = run("--quick", "--out", cls.folder)
        with open(os.path.join(cls.folder, "stability.json"), encoding="utf-8") as file:
            cls.result = json.load(file)
        cls.page_done = write_page(cls.folder)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def read(self, name):
        with open(os.path.join(self.folder, name), encoding="utf-8") as file:
            return file.read()

    def test_a_quick_run_sweeps_every_axis_and_the_defaults_hold(self):
        self.assertEqual(self.done.returncode, 0, self.done.stderr)
        axes = {a["name"]: a for a in self.result["axes"]}
        self.assertGreaterEqual(len(axes), 27)
        self.assertEqual(len(self.done.stdout.splitlines()), len(axes) + 1)
        self.assertIn("sphere-wall", self.done.stderr) # progress
        expected = sum(len(a["stresses"]) * len(a["methods"]) for a in axes.values())
        self.assertEqual(len(self.result["cells"]), expected)
        self.assertTrue(any(c["default"] and "ok" in c for c in self.result["cells"]))
        for cell in self.result["cells"]:
            axis = axes[cell["axis"]]
            self.assertIn(cell["stress"], axis["stresses"])
            self.assertTrue(cell.get("ok", True), cell)
            if axis["value"] is None:
                self.assertAlmostEqual(cell["rate"], cell["failures"] / cell["trials"], delta=1e-6)
                self.assertLessEqual(cell["low"], cell["rate"] + 1e-6)
                self.assertGreaterEqual(cell["high"], cell["rate"] - 1e-6)
            else:
                self.assertIn("value", cell)

    def test_the_same_seed_gives_the_same_numbers_for_any_number_of_threads(self):
        cells = []
        for threads, seed in [("1", "5"), ("2", "5"), ("1", "6")]:
            folder = os.path.join(self.temporary.name, "threads")
            done = run("-q", "--quick", "--axes", "slab-*,self-hit", "--threads", threads, "--seed", seed, "--out", folder)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(done.stderr, "")
            with open(os.path.join(folder, "stability.json"), encoding="utf-8") as file:
                cells.append(json.load(file)["cells"])
        self.assertEqual(cells[0], cells[1])
        self.assertNotEqual(cells[0], cells[2])
        self.assertEqual({c["axis"] for c in cells[0]},
                         {"slab-zero", "slab-plane", "slab-thin", "slab-offset", "self-hit"})

    def test_usage_errors_are_2_and_name_the_nearest(self):
        for arguments, message in [
            (["--quikc"], "did you mean '--quick'?"),
            (["--axes", "ofset"], "did you mean 'offset'?"),
            (["--axes", "x*"], "--list"),
            (["--threads", "-1"], "--threads"),
            (["--threads", "2000"], "--threads"),
            (["--seed", "x"], "--seed"),
            (["--seed", "-1"], "--seed"),
            (["--out"], "--out"),
            (["stray"], "stray"),
        ]:
            done = run(*arguments)
            self.assertEqual(done.returncode, 2, arguments)
            self.assertIn(message, done.stderr)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            self.assertEqual(done.stdout, "")

    def test_a_folder_that_cannot_be_written_is_5_at_once_and_nothing_is_left(self):
        with tempfile.TemporaryDirectory() as folder:
            taken = os.path.join(folder, "file")
            with open(taken, "w", encoding="utf-8") as file:
                file.write("mine")
            busy = os.path.join(folder, "busy")
            os.makedirs(os.path.join(busy, "stability.json"))
            for out in [taken, os.path.join(taken, "below"), "/proc/none/here", busy]:
                done = run("--out", out) # not --quick: it must not begin
                self.assertEqual(done.returncode, 5, out)
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                self.assertIn(": error: ", done.stderr)
            self.assertEqual(sorted(os.listdir(folder)), ["busy", "file"])

    def test_help_and_list_name_what_can_be_chosen(self):
        self.assertIn("--axes", run("--help").stdout)
        listed = run("--list")
        self.assertEqual(listed.returncode, 0)
        for name in ["self-hit", "embree-robust", "+ watertight", "roulette"]:
            self.assertIn(name, listed.stdout)

    def test_the_page_holds_every_method_and_leads_to_every_curve(self):
        self.assertEqual(self.page_done.returncode, 0, self.page_done.stderr)
        text = self.read("stability.html")
        page = Page(text)
        self.assertEqual(page.open, [])
        for axis in self.result["axes"]:
            self.assertIn(axis["name"], page.ids)
            # One in the head of its column, one in each method's cell.
            self.assertEqual(page.links.count("#" + axis["name"]), 1 + len(axis["methods"]), axis["name"])
        self.assertTrue(all(link.startswith("#") and link[1:] in page.ids for link in page.links))
        for tag, values in page.tags: # one file: nothing is fetched
            self.assertNotIn(tag, ["script", "link", "img", "iframe"])
            self.assertNotIn("src", values)
        self.assertIn(("meta", {"name": "viewport", "content": "width=device-width, initial-scale=1"}), page.tags)
        self.assertIn("prefers-color-scheme:dark", text)
        self.assertIn("Every default holds its limit", text)
        self.assertNotIn("✗ A method", text)
        self.assertIn("quick run", text)
        self.assertLess(len(text.encode()), 500000)

    def test_defaults_show_a_tick_and_alternatives_do_not(self):
        cells = Page(self.read("stability.html")).cells
        marked = [c for c in cells if "✓" in c[1]]
        self.assertEqual(len(marked), sum("limit" in m for a in self.result["axes"] for m in a["methods"]))
        self.assertTrue(all("l0" in c[0] for c in marked), marked)
        self.assertTrue(any("l4" in c[0] and c[1].endswith("%") for c in cells))

    def test_pictures_are_svg_with_a_curve_for_each_method(self):
        for axis in self.result["axes"]:
            text = self.read(f"curves/{axis['name']}.svg")
            root = xml.etree.ElementTree.fromstring(text)
            svg = "{http://www.w3.org/2000/svg}"
            curves = [g for g in root.findall(svg + "g")]
            self.assertEqual(sorted(g.find(svg + "title").text for g in curves),
                             sorted(m["name"] for m in axis["methods"]))
            looks = set()
            for g in curves:
                path = g.find(svg + "path")
                points = path.get("d")[1:].split("L")
                self.assertEqual(len(points), len(axis["stresses"]))
                height = float(root.get("viewBox").split()[3])
                for point in points:
                    x, y = map(float, point.split())
                    self.assertTrue(0 <= x <= 640 and 0 <= y <= height, (axis["name"], point))
                shapes = [e for e in g if e.tag in (svg + "circle", svg + "polygon")]
                self.assertEqual(len(shapes), len(points))
                looks.add((shape_of(shapes[0]), "hollow" in shapes[0].get("class")))
            self.assertEqual(len(looks), len(curves), axis["name"]) # no two alike, colours aside
            self.assertIn("prefers-color-scheme:dark", text)
        xml.etree.ElementTree.fromstring(self.read("map.svg"))

    def page_of(self, change):
        """The page of a doctored result: what write_page said, and the page."""
        result = copy.deepcopy(self.result)
        change(result)
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "stability.json"), "w", encoding="utf-8") as file:
                json.dump(result, file)
            done = write_page(folder)
            path = os.path.join(folder, "stability.html")
            if not os.path.exists(path):
                return done, ""
            with open(path, encoding="utf-8") as file:
                return done, file.read()

    def test_a_default_that_fails_is_red_and_1(self):
        def break_one(result):
            for cell in result["cells"]:
                if cell["axis"] == "needle" and cell["method"] == "watertight" and cell["stress"] == 1e3:
                    cell.update(failures=8, rate=0.002, low=0.0008, high=0.0036, ok=False)
        done, text = self.page_of(break_one)
        self.assertEqual(done.returncode, 1)
        self.assertIn('<p class="red">✗', text)
        self.assertIn("watertight: 8 of 4000 fail at 1000", text)
        bad = [c for c in Page(text).cells if "bad" in c[0]]
        self.assertEqual(bad, [("l2 bad", "0.2 % ✗")])

    def test_text_is_escaped(self):
        def mark_up(result):
            result["cpu"] = "<b>&"
            result["axes"][0]["title"] = "a < b & \"c\""
        done, text = self.page_of(mark_up)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("&lt;b&gt;&amp;", text)
        self.assertEqual(Page(text).open, [])

    def test_bad_input_of_the_page_has_one_line_and_a_code(self):
        self.assertEqual(write_page().returncode, 2)
        self.assertEqual(write_page("a", "--pgn").returncode, 2)
        self.assertEqual(write_page("/missing").returncode, 4)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "stability.json")
            for text in ["", "{", "{}", "[]", '{"axes": [1], "cells": []}']:
                with open(path, "w", encoding="utf-8") as file:
                    file.write(text)
                done = write_page(folder)
                self.assertEqual(done.returncode, 4, text)
                self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
                self.assertIn(f"{path}: error: ", done.stderr)
            self.assertEqual(os.listdir(folder), ["stability.json"])
            with open(path, "w", encoding="utf-8") as file:
                json.dump(self.result, file)
            os.mkdir(os.path.join(folder, "stability.html"))
            done = write_page(folder)
            self.assertEqual(done.returncode, 5)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            self.assertFalse([n for n in os.listdir(folder) if n.endswith(".tmp")])


if __name__ == "__main__":
    WRITE_PAGE = os.path.abspath(sys.argv.pop(2))
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
