#!/usr/bin/python3
"""Each room of runtime/ includes only itself and rooms below it, and nothing of what stands on the runtime.
The order of the rooms is that of the table in runtime/README.md, top to bottom.

usage: layers.py SOURCE_DIR
"""

import pathlib
import re
import sys

source = pathlib.Path(sys.argv[1])
runtime = source / "runtime"
rooms = re.findall(r"^\| `(\w+)/` \|", (runtime / "README.md").read_text(encoding="utf-8"), re.M)
found = sorted(path.name for path in runtime.iterdir() if path.is_dir())
wrong = []
if sorted(rooms) != found:
    wrong.append(f"runtime/README.md lists the rooms {sorted(rooms)}, there are {found}")

files = 0
for path in sorted(runtime.rglob("*.[ch]pp")):
    files += 1
    parts = path.relative_to(runtime).parts
    allowed = rooms[rooms.index(parts[0]):] if len(parts) > 1 and parts[0] in rooms else []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        include = re.match(r'\s*#include "([^"]+)"', line)
        if not include or "/" not in include[1]:  # what the build makes of the room's own files
            continue
        target = include[1].split("/")
        is_own = target[0] == "runtime" and (len(target) == 2 or target[1] in allowed)
        if not is_own:
            wrong.append(f"{path.relative_to(source)}:{number}: {include[1]} is not in a room below")

print("\n".join(wrong) or f"{files} files in {len(rooms)} rooms include downwards only")
sys.exit(bool(wrong) or not files)
