#!/usr/bin/env python3
"""Writes the man page from the command's own help: man_page.py LINESHAFT >lineshaft.1"""

import re
import subprocess
import sys


def said(*arguments):
    return subprocess.run([sys.argv[1], *arguments], capture_output=True, text=True, check=True).stdout


def escaped(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return re.sub(r"^([.'])", r"\\&\1", text, flags=re.M)


def verbatim(text):
    return f".nf\n{escaped(text.strip())}\n.fi\n"


help_text = said("--help")
commands = re.findall(r"^  ([a-z]+) +(.*)", help_text[help_text.index("Subcommands:"):], flags=re.M)
version = said("--version").split()[1]
page = f'.TH LINESHAFT 1 "" "lineshaft {version}"\n'
page += ".SH NAME\nlineshaft \\- a PLC soft\\-runtime for motion control\n"
page += ".SH SYNOPSIS\n.B lineshaft\n.I COMMAND\n[OPTIONS]\n.SH DESCRIPTION\n"
page += escaped(help_text.splitlines()[0]) + "\n.SH COMMANDS\n"
page += "".join(f".TP\n.B {name}\n{escaped(doc)}\n" for name, doc in commands)
for name, _ in commands:
    page += f".SH LINESHAFT {name.upper()}\n" + verbatim(said(name, "--help"))
page += ".SH EXIT STATUS\n" + verbatim(help_text[help_text.index("Exit codes:"):])
sys.stdout.write(page)
