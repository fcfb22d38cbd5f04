#!/usr/bin/python3
"""The user program of Wei et al. in SCL gives the same trace bytes as the block circle_ratio.

usage: structured_text.py LINESHAFT SOURCE_DIR
"""

import itertools
import pathlib
import subprocess
import sys
import tempfile

METHODS = ("immediate", "early", "centred", "balanced", "ramp")
RADII = ("20 mm", "50 mm")
TASKS = ("main", "post_servo")


def trace(lineshaft, program, path, settings):
    command = [lineshaft, "run", program, "--quiet", "--trace", path]
    for name, value in settings.items():
        command += ["--set", f"{name}={value}"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return path.read_bytes()


def main():
    lineshaft = str(pathlib.Path(sys.argv[1]).resolve())
    papers = pathlib.Path(sys.argv[2]).resolve() / "programs/paper"
    differ = runs = 0
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "trace.csv")
        for method, radius, task in itertools.product(METHODS, RADII, TASKS):
            settings = {"method": method, "radius": radius, "user_program": task}
            block = trace(lineshaft, papers / "wei2025_circle.yaml", path, settings)
            scl = trace(lineshaft, papers / "wei2025_circle_scl.yaml", path, settings)
            runs += 1
            if block != scl:
                differ += 1
                print(f"{settings}: the traces differ")
    print(f"{runs} circles in SCL, {differ} with other bytes than the block's")
    return differ > 0


if __name__ == "__main__":
    sys.exit(main())
