# SPDX-License-Identifier: BSD-3-Clause
"""The table in Data/README.md is that of the files in Data: names, sizes, checksums.

With CDM_UPDATE_BASELINES=1 in the environment the sizes and checksums of the table become those of
the files; origins and units of new files in Input are to be filled in by hand.
"""

import hashlib
import os
import re
import sys

DATA = os.environ["CDM_DATA_DIR"]
README = os.path.join(DATA, "README.md")
HEAD = "| file | origin | units | bytes | sha256 |\n|---|---|---|---|---|\n"
ROW = re.compile(r"^\| `(\S+)` \| (.+) \| (.+) \| (\d+) \| `([0-9a-f]{64})` \|\n", re.MULTILINE)


def GetFiles():
    """Names below Data with size and checksum, without the README itself."""
    files = {}
    for folder, _, names in os.walk(DATA):
        for name in names:
            path = os.path.join(folder, name)
            if path != README:
                with open(path, "rb") as file:
                    content = file.read()
                relative = os.path.relpath(path, DATA)
                files[relative] = (len(content), hashlib.sha256(content).hexdigest())
    return files


def GetOrigin(name):
    """The test that draws a baseline or makes a reference; None: the table says it."""
    if name.startswith("References/"):
        return "made by `Testing/References/TestStages.py`"
    if not name.startswith("Baselines/"):
        return None
    # The manual's pictures are named in its pages, not in the test.
    if re.match(r"Baselines/(VTK\d\.\d/)?(Page|Tutorial)\w+\.png$", name):
        return "drawn by `Testing/Plugin/TestDocumentation.py`"
    testing = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    for folder in ("Regression", "Plugin"):
        for script in sorted(os.listdir(os.path.join(testing, folder))):
            if script.startswith("Test") and script.endswith(".py"):
                with open(os.path.join(testing, folder, script), encoding="utf-8") as file:
                    text = file.read()
                # The gallery's tests leave the comparison to GalleryExample.
                if ('"%s"' % os.path.basename(name) in text
                        and re.search("AssertSameAsBaseline|GalleryExample", text)):
                    return "drawn by `Testing/%s/%s`" % (folder, script)
    sys.exit("no test draws Data/%s" % name)


def GetUnits(name):
    """Of coordinates; None: the table says it."""
    if name.startswith("References/"):
        return "of the input"
    return "pixels" if name.startswith("Baselines/") else None


with open(README, encoding="utf-8") as readme:
    text = readme.read()
rows = {name: (origin, units, int(size), checksum)
        for name, origin, units, size, checksum in ROW.findall(text)}
files = GetFiles()

if os.environ.get("CDM_UPDATE_BASELINES") == "1":
    table = ""
    for name, (size, checksum) in sorted(files.items()):
        origin, units = rows.get(name, (None, None))[:2]
        origin = GetOrigin(name) or origin or "unknown"
        units = GetUnits(name) or units or "unknown"
        table += "| `%s` | %s | %s | %d | `%s` |\n" % (name, origin, units, size, checksum)
    begin = text.index(HEAD) + len(HEAD)
    end = text.find("\n\n", begin - 1)
    with open(README, "w", encoding="utf-8") as readme:
        readme.write(text[:begin] + table + (text[end + 1:] if end >= 0 else ""))
    print("new table of %d files" % len(files))
    sys.exit(0)

faults = ["%s: not in the table" % name for name in files.keys() - rows.keys()]
faults += ["%s: in the table, but not there" % name for name in rows.keys() - files.keys()]
for name in files.keys() & rows.keys():
    if rows[name][2:] != files[name]:
        faults.append("%s: %s in the table, but %s" % (name, rows[name][2:], files[name]))
    if "unknown" in rows[name][:2]:
        faults.append("%s: of unknown origin or units" % name)
    if GetOrigin(name) not in (None, rows[name][0]):
        faults.append("%s: has another origin" % name)
print("\n".join(sorted(faults)) or "%d files are as in Data/README.md" % len(files))
sys.exit(1 if faults or not files else 0)
