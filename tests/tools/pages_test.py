#!/usr/bin/env python3
"""The pages of tools/chart and tools/stability in headless Chromium, on a phone and a desktop, light and dark.

Drawn anew from the results in the repository. Skipped (77) where no Chromium is installed.
"""
import importlib.util
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
TOOLS = os.path.join(HERE, "../../tools")
sys.path[:0] = [os.path.join(HERE, "../support"), TOOLS]
from browser import Browser, find_browser  # noqa: E402

RESULTS = os.path.join(TOOLS, "results")
SCREENS = {"phone": (360, 800), "desktop": (1280, 900)}
OPEN_ALL = "document.querySelectorAll('details').forEach(d => { d.open = true; })"


def read(*path):
    with open(os.path.join(*path), encoding="utf-8") as file:
        return file.read()


CHECKS = read(HERE, "page_checks.js")


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(holder.cleanup)
        cls.folder = holder.name
        shutil.copy(os.path.join(RESULTS, "stability-amd-epyc-zen4.json"), os.path.join(cls.folder, "stability.json"))
        subprocess.run([sys.executable, os.path.join(TOOLS, "stability_src/write_page.py"), cls.folder], check=True)
        shutil.copy(os.path.join(RESULTS, "stability-amd-epyc-zen4.html"), os.path.join(cls.folder, "committed.html"))
        from chart_src.page import page  # which wants numpy
        with open(os.path.join(cls.folder, "chart.html"), "w", encoding="utf-8") as file:
            file.write(page(json.loads(read(RESULTS, "chart-amd-epyc-zen4.json"))))
        cls.browser = cls.enterClassContext(Browser(find_browser()))

    def show(self, name, screen="phone", dark=False):
        self.browser.open(f"file://{self.folder}/{name}", *SCREENS[screen], dark)
        self.browser.evaluate(OPEN_ALL)
        pictures = os.environ.get("PLUMB_SCREENSHOTS")  # a folder, for eyes
        if pictures:
            self.browser.screenshot(os.path.join(pictures, f"{name[:-5]}-{screen}-{'dark' if dark else 'light'}.png"))

    def found(self):
        return self.browser.evaluate(CHECKS)

    def check_everywhere(self, name, choices):
        for screen in SCREENS:
            for dark in (False, True):
                self.show(name, screen, dark)
                paper = self.browser.evaluate("getComputedStyle(document.body).backgroundColor")
                self.assertEqual(paper, "rgb(24, 24, 24)" if dark else "rgb(255, 255, 255)")
                for choice in range(choices):
                    with self.subTest(screen=screen, dark=dark, choice=choice):
                        if choices > 1:
                            self.choose(choice)
                        self.assertEqual(self.found(), [])

    def choose(self, number):
        """The measure of every scene; exactly its picture is shown."""
        shown = self.browser.evaluate(
            "[...document.querySelectorAll('.choice')].map(c => { c.querySelectorAll('input')[%d].click();"
            "return [...c.querySelectorAll('figure')].map(f => f.getClientRects().length) })" % number)
        self.assertTrue(shown)
        for figures in shown:
            self.assertEqual([bool(n) for n in figures], [i == number for i in range(3)])

    def test_the_chart_reads_everywhere(self):
        self.check_everywhere("chart.html", 3)

    def test_the_stability_map_reads_everywhere(self):
        self.check_everywhere("stability.html", 1)
        self.show("committed.html")
        self.assertEqual(self.found(), [])

    def test_what_is_broken_is_found(self):
        for page, style, sentence in (
                ("chart.html", ".plot text{font-size:5px!important}", "has letters of"),
                ("chart.html", "p{font-size:7px}", "has letters of"),
                ("chart.html", ".soft{color:#999!important}", "has a contrast of"),
                ("chart.html", ".plot text{fill:#aaa!important}", "has a contrast of"),
                ("chart.html", "h1{width:500px}", "and scrolls in 360"),
                ("chart.html", "body{overflow-x:hidden}h1{white-space:nowrap;margin-left:200px}", "is cut off"),
                ("chart.html", ".plot text{transform:translateX(60px)}", "is cut off"),
                ("chart.html", ".plot text{font-size:17px!important}", "overlap"),
                ("chart.html", ".plot .curve{stroke:#ddd!important}", "has a contrast of"),
                ("chart.html", ".plot .front{fill:#888!important}", "the front is filled"),
                ("stability.html", ".l4{color:#a33!important}", "has a contrast of"),
                ("stability.html", "figure svg{min-width:0!important}", "has letters of")):
            with self.subTest(style=style):
                self.show(page)
                self.browser.evaluate("document.head.insertAdjacentHTML('beforeend', '<style>%s</style>')" % style)
                self.assertTrue(any(sentence in line for line in self.found()), self.found())

    def test_lines_that_differ_by_colour_alone_are_found(self):
        self.show("chart.html")
        self.assertEqual(self.found(), [])
        self.browser.evaluate(
            "document.querySelectorAll('svg path.curve').forEach(p => p.removeAttribute('stroke-dasharray'));"
            "document.querySelectorAll('svg polygon').forEach(p => p.setAttribute('points', '-3,-3 3,-3 3,3'))")
        self.assertTrue(any("look the same without colour" in line for line in self.found()), self.found())


if __name__ == "__main__":
    if find_browser() is None:
        print("SKIPPED: needs chromium-headless-shell or chromium")
        sys.exit(77)
    if importlib.util.find_spec("numpy") is None:
        print("SKIPPED: needs python3-numpy")
        sys.exit(77)
    unittest.main()
