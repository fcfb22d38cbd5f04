"""What the command under test was built with: tests of the rest are skipped, by name."""

import subprocess


def has_pages(lineshaft, skipped):
    """Whether it has the page of `lineshaft report`; without it says what is not tested."""
    answer = subprocess.run([str(lineshaft), "report", "none.csv", "-o", "none.html"], capture_output=True, text=True, check=False)
    has = "built without" not in answer.stderr
    if not has:
        print(f"skipped: {skipped}: built without the report's page (tools/setup)")
    return has
