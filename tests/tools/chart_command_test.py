#!/usr/bin/env python3
"""tools/chart as a user meets it: a tiny run's JSON and page, its time, a signal, mistakes.

    chart_command_test.py RENDERER MAIN.py SCENE.xml

Skipped (77) without numpy.
"""
import html.parser
import importlib.util
import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest

RENDERER = MAIN = SCENE = ""
VOID = {"meta", "input"}
PICTURES = ["accelerators", "cornell-box", "cornell-box-flip", "cornell-box-relmse"]


class Nesting(html.parser.HTMLParser):
    """Raises unless every element is closed in order; counts them."""

    def __init__(self, text):
        super().__init__()
        self.open, self.count = [], {}
        self.feed(text)
        self.close()
        if self.open:
            raise ValueError(f"left open: {self.open}")

    def handle_starttag(self, tag, attrs):
        self.count[tag] = self.count.get(tag, 0) + 1
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.count[tag] = self.count.get(tag, 0) + 1

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            raise ValueError(f"</{tag}> closes nothing")


def read(*path):
    with open(os.path.join(*path), encoding="utf-8") as file:
        return file.read()


class ChartCommand(unittest.TestCase):
    def setUp(self):
        self.holder = tempfile.TemporaryDirectory()
        self.addCleanup(self.holder.cleanup)
        self.out = os.path.join(self.holder.name, "out")

    def command(self, *arguments):
        return [sys.executable, MAIN, "--renderer", RENDERER, "--cache", os.path.join(self.holder.name, "cache"),
                "--out", self.out, "--width", "8", *arguments]

    def run_chart(self, *arguments):
        return subprocess.run(self.command(*arguments), capture_output=True, text=True, timeout=300, check=False)

    def test_tiny_run_tells_everything_in_json_and_page(self):
        done = self.run_chart("--quick", "--time", "120", "--max-spp", "4", "--methods", "default,worst",
                              "sampler=independent", "--", SCENE)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("cornell-box: reference\n", done.stderr)  # progress, in lines
        self.assertNotIn("\r", done.stderr)
        text = read(self.out, "chart.json")
        self.assertNotIn(os.path.dirname(MAIN), text)  # no paths of this machine
        data = json.loads(text)
        self.assertEqual((data["complete"], data["width"], data["seeds"]), (True, 8, 2))  # --quick leaves --width
        self.assertEqual([m["name"] for m in data["methods"]], ["default", "worst", "sampler=independent"])
        self.assertEqual(data["methods"][1]["choices"]["estimator"], "bsdf")
        scene, = data["scenes"]
        self.assertGreaterEqual(scene["reference"]["spp"], 64 * 4)
        self.assertEqual(len(scene["runs"]), 3 * 3 * 2)  # methods, levels, seeds
        for run in scene["runs"]:
            self.assertEqual(run["samples"], 8 * 8 * run["spp"])
            self.assertTrue(run["wall_s"] > 0 and run["cpu_s"] > 0 and run["rays"] > 0 and run["memory_bytes"] > 0)
            self.assertLess(run["cpu_s"], 1.1 * run["wall_s"])  # one thread; starting is not counted
            self.assertTrue(run["mse_raw"] >= run["mse"] and run["relmse"] > 0)
            self.assertTrue(0 < scene["reference"]["flip"] < 1 and 0 < run["flip"] < 1)
        for row in scene["summary"]:
            mean, low, high = row["efficiency"]
            self.assertTrue(0 < low <= mean <= high)
            slope, low, high = row["slope"]  # of 64 pixels at 4 spp: any number may come out
            self.assertTrue(low <= slope <= high)
        self.check_page(["default", "worst", "sampler=independent"])
        drawn = importlib.util.find_spec("matplotlib") is not None
        names = [p + end for p in PICTURES for end in ((".png", ".svg") if drawn else (".svg",))]
        self.assertEqual(sorted(os.listdir(self.out)), sorted(names + ["chart.html", "chart.json"]))
        for name in names:
            with open(os.path.join(self.out, name), "rb") as file:
                begin = file.read(24)
            if name.endswith(".png"):
                self.assertEqual((begin[:8], begin[16:20]), (b"\x89PNG\r\n\x1a\n", (1008).to_bytes(4, "big")), name)
            else:
                self.assertTrue(begin.startswith(b'<svg class="plot" '), name)

    def check_page(self, methods):
        page = read(self.out, "chart.html")
        count = Nesting(page).count
        second = json.loads(read(self.out, "chart.json"))["accelerators"]["points"]
        self.assertGreaterEqual(len(second), 4)
        self.assertEqual((count["svg"], count["table"], count["input"]), (3 + 1, 1 + 1, 3))  # measures, accelerators
        self.assertEqual(count["tr"], 1 + len(methods) + 1 + len(second))
        for m in methods:
            self.assertEqual(page.count(f"<title>{m}</title>"), 3)
        self.assertIn("prefers-color-scheme:dark", page)
        for outside in ("http://", "https://", "src=", "<link"):
            self.assertNotIn(outside, page.replace("http://www.w3.org/2000/svg", ""))
        dashes = {p.split('stroke-dasharray="')[1].split('"')[0] if "stroke-dasharray" in p else ""
                  for p in page.split("\n") if 'class="curve ' in p}
        self.assertEqual(len(dashes), len(methods))  # told apart without colour
        self.assertIn('class="front"', page)

    def test_scenes_can_be_added_to_an_earlier_run(self):
        other = os.path.join(self.holder.name, "other.xml")
        with open(SCENE, encoding="utf-8") as file:
            text = file.read()
        with open(other, "w", encoding="utf-8") as file:
            file.write(text.replace('"meshes/', '"' + os.path.join(os.path.dirname(SCENE), "meshes/")))
        common = ("--quick", "--max-spp", "2", "--time", "60", "--add", "-q")
        for methods, scene in (("default", SCENE), ("worst", other), ("default", SCENE)):
            done = self.run_chart(*common, "--methods", methods, "--", scene)
            self.assertEqual(done.returncode, 0, done.stderr)
        data = json.loads(read(self.out, "chart.json"))
        self.assertEqual([s["name"] for s in data["scenes"]], ["cornell-box", "other"])
        self.assertEqual([{r["method"] for r in s["runs"]} for s in data["scenes"]], [{"default"}, {"worst"}])
        self.assertEqual([m["name"] for m in data["methods"]], ["default", "worst"])
        kept = read(self.out, "chart.json")
        done = self.run_chart(*common, "--seeds", "3", "--", SCENE)
        self.assertEqual(done.returncode, 4)
        self.assertIn("chart.json: error: --add: another seeds (got '2', expected '3')\n", done.stderr)
        self.assertEqual(read(self.out, "chart.json"), kept)

    def test_signals_keep_what_is_done(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            with subprocess.Popen(self.command("--time", "120", "--max-spp", "64", "--methods", "default", "worst",
                                               "--", SCENE),
                                  stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
                for line in process.stderr:
                    if "4 spp" in line:  # two levels are there
                        process.send_signal(number)
                        break
                process.communicate(timeout=120)
            self.assertEqual(process.returncode, 128 + number)
            data = json.loads(read(self.out, "chart.json"))
            self.assertFalse(data["complete"])
            self.assertGreaterEqual(len(data["scenes"][0]["runs"]), 2 * 2 * 4)
            self.check_page(["default", "worst"])
            self.assertIn("Stopped before its end", read(self.out, "chart.html"))
            os.remove(os.path.join(self.out, "chart.json"))

    def test_time_bounds_the_whole(self):
        def cpu_s():  # of the children that have ended: a busy machine is no matter
            used = resource.getrusage(resource.RUSAGE_CHILDREN)
            return used.ru_utime + used.ru_stime
        before, begun = cpu_s(), time.monotonic()
        done = self.run_chart("--time", "4", "--width", "64", "-q", "--", SCENE, SCENE)
        self.assertEqual(done.returncode, 0, done.stderr)
        # Starting Python, one render and drawing take 2 to 3 s; 4 s for each of both would be 10 and more.
        self.assertLess(cpu_s() - before, 4 + 3.8)
        self.assertGreater(time.monotonic() - begun, 1)

    def test_mistakes_get_one_line_and_leave_what_was_there(self):
        os.mkdir(self.out)
        kept = os.path.join(self.out, "chart.json")
        with open(kept, "w", encoding="utf-8") as file:
            file.write("earlier")
        broken = os.path.join(self.holder.name, "broken.xml")
        with open(broken, "w", encoding="utf-8") as file:
            file.write("<scene")
        for code, arguments in ((2, ["--time", "0"]), (2, ["--time", "nan"]), (2, ["--seeds", "-1"]),
                                (2, ["--bad"]), (2, ["--methods", "rr=fast"]), (2, ["--methods", "none"]),
                                (3, ["nothing.xml"]), (3, [self.out]), (3, [broken]),
                                (4, ["--bench", "nothing.json", SCENE]), (4, ["--stability", broken, SCENE]),
                                (4, ["--bench", kept, SCENE]),
                                (5, ["--out", os.path.join(kept, "in"), SCENE]), (5, ["--out", kept, SCENE]),
                                (6, ["--renderer", os.path.join(self.out, "none"), SCENE])):
            with self.subTest(arguments=arguments):
                done = self.run_chart("-q", *arguments)
                self.assertEqual(done.returncode, code, done.stderr)
                self.assertRegex(done.stderr, r"\A[^\n]*error: [^\n]+\n\Z")
                self.assertEqual(done.stdout, "")
                self.assertEqual(read(kept), "earlier")
                self.assertEqual(os.listdir(self.out), ["chart.json"])


if __name__ == "__main__":
    if importlib.util.find_spec("numpy") is None:
        print("SKIPPED: needs python3-numpy")
        sys.exit(77)
    RENDERER, MAIN, SCENE = map(os.path.abspath, sys.argv[1:4])
    unittest.main(argv=sys.argv[:1])
