#!/usr/bin/python3
"""lineshaft plot and report at the prompt: pictures, names with odd characters, wrong input.

usage: plot.py LINESHAFT PROJECT
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

from built import has_pages

lineshaft, project = (str(pathlib.Path(path).resolve()) for path in sys.argv[1:3])

pages = has_pages(lineshaft, "reports at the prompt")


class Prompt(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.trace = self.folder / "it's \"a\" $(trace) `x`.csv"
        program = f"{project}/programs/04_circle.yaml"
        self.run_lineshaft("run", program, "--quiet", "--trace", self.trace)

    def run_lineshaft(self, *arguments, code=0, **more):
        answer = subprocess.run([lineshaft, *map(str, arguments)], capture_output=True, text=True, **more)
        self.assertEqual(answer.returncode, code, answer.stderr)
        return answer

    def refused(self, text, *arguments):
        answer = self.run_lineshaft(*arguments, code=2)
        self.assertIn(text, answer.stderr)

    def test_pictures(self):
        svg, png = self.folder / "a'b\"c $x.svg", self.folder / "path.png"
        self.run_lineshaft("plot", self.trace, "-o", svg, "--title", "it's `100 %` <fine> {a_b}")
        text = "".join(xml.etree.ElementTree.parse(svg).getroot().itertext())
        for wanted in ("it's `100 %` <fine> {a_b}", "x.position", "[mm/s]", "time [s]"):
            self.assertIn(wanted, text)
        self.run_lineshaft("plot", self.trace, "--path", "x.position,y.position", "-o", png)
        self.assertEqual(png.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.run_lineshaft("plot", self.trace, "--signals", "x.velocity", "-o", svg)
        self.assertNotIn("x.position", svg.read_text(encoding="utf-8"))

    def test_long_names_have_room(self):
        name = "a_carriage_of_a_very_long_name"
        program = self.file("long.yaml", f"""lineshaft: 1
tasks: {{t: {{every: 2 ms}}}}
blocks:
  {name}: {{type: axis, task: t}}
  feed: {{type: MC_MoveVelocity, task: t, Axis: {name}, Velocity: 10 mm/s, Execute: true}}
run: {{for: 0.1 s}}
trace: {{task: t, signals: [{name}.velocity, {name}.actual_velocity, {name}.error, {name}.actual_position]}}
""")
        trace, picture = self.folder / "long.csv", self.folder / "long.svg"
        self.run_lineshaft("run", program, "--quiet", "--trace", trace)
        said = self.run_lineshaft("plot", trace, "-o", picture, "--width", "1400")
        self.assertEqual(said.stderr, "", "a signal that stays as it is needs no warning")
        texts = []
        for group in xml.etree.ElementTree.parse(picture).getroot().iter("{http://www.w3.org/2000/svg}g"):
            text = "".join(group.itertext()).strip()
            place = re.match(r"translate\(([\d.]+),", group.get("transform", ""))
            if place and text and "rotate" not in group.get("transform"):
                texts.append((text, float(place[1]), group.get("text-anchor")))
        narrowest = 6  # pixels a character of DejaVu Sans 12 at least, on average
        wide = [one for one in texts if name in one[0]]
        self.assertEqual(len(wide), 4)
        for text, x, anchor in wide:
            if anchor == "end":
                self.assertGreater(x - narrowest * len(text), 0, text)
            else:
                ticks = [place for number, place, how in texts if how == "middle" and re.fullmatch(r"[\d.]+", number)]
                self.assertGreater(x, max(ticks), "the legend is beside the curves")
                self.assertLess(x + narrowest * len(text), 1400, text)

    def test_no_gnuplot(self):
        picture = self.folder / "a.svg"
        answer = self.run_lineshaft("plot", self.trace, "-o", picture, code=3, env={**os.environ, "PATH": "/nowhere"})
        self.assertIn("gnuplot-nox", answer.stderr)
        self.assertFalse(picture.exists())

    @unittest.skipUnless(pages, "built without the report's page")
    def test_report_holds_no_markup_of_its_input(self):
        page = self.folder / "a.html"
        self.run_lineshaft("report", self.trace, "--title", "</script><b>&", "-o", page)
        text = page.read_text(encoding="utf-8")
        self.assertIn("<title>&lt;/script>&lt;b>&amp;</title>", text)
        self.assertEqual(text.count("</script><b>"), 0)
        self.assertIn("Permission is hereby granted", text)  # uPlot's licence

    def test_bad_input(self):
        for command, output in (("report", "a.html"), ("plot", "a.svg")):
            if command == "report" and not pages:
                continue
            to = ("-o", self.folder / output)
            make = lambda text: self.file("bad.csv", text)
            self.refused("no column", command, self.trace, "--signals", "x.posion", *to)
            self.refused("empty", command, make(""), *to)
            self.refused("no rows", command, make("time,a\n"), *to)
            self.refused("time falls", command, make("time,a\n0,1\n2,1\n1,1\n"), *to)
            self.refused("no_such.csv", command, self.folder / "no_such.csv", *to)
            cut = self.file("cut.csv", self.trace.read_text(encoding="utf-8")[:5000])
            shutil.copy(f"{self.trace}-metadata.json", f"{cut}-metadata.json")
            self.refused("cut", command, cut, *to)
            one, two = self.file("1.csv", "time,a\n0,1\n1,1\n2,1\n"), self.file("2.csv", "time,a\n0,1\n2,1\n4,1\n")
            other = self.file("3.csv", "time,b\n0,1\n1,1\n2,1\n")
            if command == "plot":  # a page draws runs of other signals and other intervals side by side
                self.refused("the trace has a row each 2000 ms, but each 1000 ms", command, one, two, *to)
                self.refused("the trace has no column 'a'", command, one, other, *to)
            foreign = self.file("4.csv", other.read_text(encoding="utf-8"))
            shutil.copy(f"{self.trace}-metadata.json", f"{foreign}-metadata.json")
            self.refused("it is not the file that was recorded", command, foreign, *to)
            self.assertFalse((self.folder / output).exists())
        if pages:
            self.refused("these are not the results of a study", "report", self.file("x.json", "{}"), "-o", self.folder / "a.html")
        self.refused("neither an .svg", "plot", self.trace, "-o", self.folder / "a.pdf")

    def file(self, name, text):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
