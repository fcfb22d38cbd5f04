#!/usr/bin/python3
"""Each room includes only itself and rooms below it; runtime/ includes nothing of what stands on it.
The order of a house's rooms is that of the table in its README, top to bottom: runtime/, blocks/, and each room
whose README has a table of rooms itself, as runtime/st/. What stands beside the rooms of a house is below them
if neither the header nor its source includes one.

usage: layers.py SOURCE_DIR
"""

import pathlib
import re
import sys

source = pathlib.Path(sys.argv[1])
wrong = []


def includes(path):
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if found := re.match(r'\s*#include "([^"]+)"', line):
            yield number, found[1]


def refuse(path, number, include):
    wrong.append(f"{path.relative_to(source)}:{number}: {include} is not in a room below")


def is_below_rooms(header, house, rooms):
    """Of a header that stands beside the rooms."""
    starts = tuple(f"{house.relative_to(source)}/{room}/" for room in rooms)
    return not any(include.startswith(starts) for path in (header, header.with_suffix(".cpp")) if path.exists()
                   for _, include in includes(path))


def check_house(house):
    """The number of files in rooms, and of rooms."""
    readme = house / "README.md"
    rooms = re.findall(r"^\| `(\w+)/` \|", readme.read_text(encoding="utf-8"), re.M) if readme.exists() else []
    if not rooms:
        return 0, 0
    found = sorted(path.name for path in house.iterdir() if path.is_dir())
    if sorted(rooms) != found:
        wrong.append(f"{readme.relative_to(source)} lists the rooms {sorted(rooms)}, there are {found}")
    files, houses = 0, len(rooms)
    inside = f"{house.relative_to(source)}/"
    for place, room in enumerate(rooms):
        for path in sorted((house / room).rglob("*.[ch]pp")):
            files += 1
            for number, include in includes(path):
                if not include.startswith(inside):
                    continue
                first, *rest = include[len(inside):].split("/")
                allowed = first in rooms[place:] if rest else is_below_rooms(source / include, house, rooms)
                if not allowed:
                    refuse(path, number, include)
        houses += check_house(house / room)[1]
    return files, houses


def check_reach(folder, *reached):
    """What is included of the project in a folder is of these folders."""
    for path in sorted((source / folder).rglob("*.[ch]pp")):
        for number, include in includes(path):
            if not include.startswith(reached):
                refuse(path, number, include)


check_reach("runtime", "runtime/")
check_reach("blocks", "runtime/", "blocks/")
counts = [check_house(source / name) for name in ("runtime", "blocks")]
print("\n".join(wrong) or f"{sum(files for files, _ in counts)} files in {sum(rooms for _, rooms in counts)} rooms "
      "include downwards only")
sys.exit(bool(wrong) or not all(files for files, _ in counts))
