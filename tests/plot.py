#!/usr/bin/python3
"""lineshaft plot and report at the prompt: pictures, names with odd characters, wrong input.

usage: plot.py LINESHAFT PROJECT
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

lineshaft, project = (str(pathlib.Path(path).resolve()) for path in sys.argv[1:3])


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

    def test_no_gnuplot(self):
        picture = self.folder / "a.svg"
        answer = self.run_lineshaft("plot", self.trace, "-o", picture, code=3, env={**os.environ, "PATH": "/nowhere"})
        self.assertIn("gnuplot-nox", answer.stderr)
        self.assertFalse(picture.exists())

    def test_report_holds_no_markup_of_its_input(self):
        page = self.folder / "a.html"
        self.run_lineshaft("report", self.trace, "--title", "</script><b>&", "-o", page)
        text = page.read_text(encoding="utf-8")
        self.assertIn("<title>&lt;/script>&lt;b>&amp;</title>", text)
        self.assertEqual(text.count("</script><b>"), 0)
        self.assertIn("Permission is hereby granted", text)  # uPlot's licence

    def test_bad_input(self):
        for command, output in (("report", "a.html"), ("plot", "a.svg")):
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
        self.refused("these are not the results of a study", "report", self.file("x.json", "{}"), "-o", self.folder / "a.html")
        self.refused("neither an .svg", "plot", self.trace, "-o", self.folder / "a.pdf")

    def file(self, name, text):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
