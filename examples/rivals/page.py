#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Certifies rasterizers that Debian and npm deliver, and writes docs/rivals.md.

usage: examples/rivals/page.py COMMAND [--write] [--only NAMES] [--packages]
COMMAND is the surefill command. Each row of ROWS whose package is there is certified at level quick and held against what is
written beside it here: the verdict, and the checks that find something. --write makes docs/rivals.md of it; without it, the
page is held against this run too. --packages prints the packages of all rows.
Exit 0: as it is written. 1: not so. 77: no row has its package here.
"""
import dataclasses
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/rivals.md"
PYTHON = "/usr/bin/python3"  # Debian's, which sees Debian's packages


@dataclasses.dataclass(frozen=True)
class Row:
    name: str
    package: str  # of Debian; or npm:NAME@VERSION
    options: str  # of `surefill certify`
    version: str  # of the rasterizer that this row is about
    verdict: str  # "certified" or "not certified"
    found: str  # the checks that find something
    cause: str  # by hand: what it does, and whether that is wrong
    unfair: str = ""  # by hand: what certify says of it that is not so


def python(name):
    return f'--command "{PYTHON} examples/rivals/{name}.py"'


ROWS = (
    Row("GDAL, RasterizeLayer", "python3-gdal", python("gdal_rasterize"), "3.6.2", "certified", "",
        "Right: samples at the centres of pixels, float64, each sample on an edge owned once."),
    Row("scikit-image, draw.polygon", "python3-skimage", python("scikit_image"), "0.19.3", "certified", "",
        "Right, and not watertight: samples on an edge are covered by both neighbours."),
    Row("cairo, ANTIALIAS_NONE", "python3-cairo", python("cairo_fill"), "1.16.0", "not certified", "clear-samples",
        "A fault: positions are 24.8 fixed point, and what lies at 2^23 pixels or beyond wraps: the triangle is lost (at 2^23 - 1 it is "
        "drawn). Under 300 random triangles, 12 of 43,200 samples are other than on that grid of 8 bits."),
    Row("Agg in matplotlib, not antialiased", "python3-matplotlib", python("matplotlib_agg"), "3.6.3", "certified", "",
        "It does not look at samples: each pixel is drawn of which the triangle covers 1/256 or more (over 60 random triangles, no pixel "
        "beside the triangle was drawn, and none missed with more than 0.0039 of its area). Meshes overlap along their edges. \"Certified\" says no more than that away from edges it is right: no model fits, so that is all that is owed."),
    Row("Pillow, ImageDraw.polygon", "python3-pil", python("pillow"), "9.4.0", "not certified", "model",
        "It draws the outline as well as the inside: edges reach half a pixel further than their triangle on all sides. Meshes overlap "
        "along their edges. No place of the samples explains that, which `model` says; away from edges it is right."),
    Row("OpenCV, fillConvexPoly", "python3-opencv", python("opencv"), "4.6.0", "certified", "",
        "It draws the outline as well as the inside: edges reach half a pixel further than their triangle on all "
        "sides. Meshes overlap along their edges."),
    Row("Qt, QPainter, not antialiased", "python3-pyqt5", python("qt_painter"), "5.15.8", "not certified", "partition-fan",
        "Positions go to the nearest 1/64 pixel, samples are at the centres of pixels, ties go to the bottom right. A fault: slopes are kept "
        "with 16 bits after the point, so a sample at a vertex of a mesh may be drawn three times (22 of 266 random fans around a sample). Under 900 random "
        "triangles, 12 of 1.4 million samples are other than on that grid, none further than 7e-5 pixels from an edge."),
    Row("pygame, draw.polygon", "python3-pygame", python("pygame_polygon"), "2.1.2", "not certified", "model",
        "It takes whole pixels, and draws the outline as well as the inside. A fault that the adapter hides: it goes through all rows of a "
        "triangle, those outside of the image, too, so that one of 2^23 rows takes more than 5 s."),
    Row("three.js, SoftwareRenderer", "npm:three@0.106.2", '--command "node examples/rivals/three_software.mjs"', "106",
        "not certified", "model-small-world-homogeneous",
        "Faults: samples are taken at the corner of a pixel, half a pixel off; a triangle with one vertex before the near or behind the far "
        "plane is dropped whole; one that is wider than 100 pixels is cut at snapped midpoints, over and over. The adapter hides that "
        "this goes on outside of the image, so that a triangle of 2^23 pixels never ends."),
)


def is_there(row):
    if row.package.startswith("npm:"):
        return (ROOT / "build/rivals/node_modules" / row.package[4:].split("@")[0]).is_dir()
    query = subprocess.run(["dpkg-query", "-W", "-f", "${db:Status-Abbrev}", row.package], capture_output=True, text=True)
    return query.stdout == "ii "


def certify(command, row):
    """The certificate; None, and why, where there is none."""
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "certificate.json")
        words = [command, "certify", "--level", "quick", "--jobs", "1", "--output-dir", folder, "--json", file]
        run = subprocess.run(words + shlex.split(row.options), cwd=ROOT, capture_output=True, text=True)
        if run.returncode not in (0, 1):
            return None, run.stderr.strip()
        return json.loads(pathlib.Path(file).read_text()), ""


def found_by(certificate):
    return ", ".join(check["name"] for check in certificate["checks"] if check["failed"] > 0)


def section(row, certificate):
    judged = sum(1 for check in certificate["checks"] if check["samples"] > 0)
    rival = certificate["rival"]
    lines = [f"## {row.name}", "", f"```console\n$ surefill certify --level quick {row.options}\n```", ""]
    said = [f"*Found*: {rival['inferred_model']}."]
    if rival["departures"]:
        said.append("Notes: " + "; ".join(rival["departures"]) + ".")
    said.append(f"Verdict: {certificate['verdict']}, {judged} of {len(certificate['checks'])} checks judged" +
                (f"; {found_by(certificate)} found differences." if found_by(certificate) else "."))
    lines += [" ".join(said), "", f"*By hand*: {row.cause}"]
    if row.unfair:
        lines += ["", f"*Not so*, and the fault of the judge: {row.unfair}"]
    return "\n".join(lines) + "\n"


def matrix_line(row, model):
    verdict = "certified" if row.verdict == "certified" else f"not certified: {row.found}"
    return f"| {row.name} {row.version} | {row.package.replace('npm:', 'npm: ')} | {model} | {verdict} | {'yes' if row.unfair else ''} |"


# Beside the project: from public repositories, fetched and built by hand.
OUTSIDE = """## From public repositories, run by hand
Nothing of these is in the project but the adapter, and no test runs them. Each was fetched at the commit that is named, and built as its
adapter says ([examples/rivals/outside](../examples/rivals/outside)); then `surefill certify --level quick --plugin`.

| rasterizer | commit | model found | verdict | by hand |
| --- | --- | --- | --- | --- |
| [tinyrenderer](https://github.com/ssloy/tinyrenderer), `rasterize` | 87bc715 | positions exact; samples at (0, 1) | certified: 20 of 56 checks | Samples are at the corner \
of a pixel, half a pixel off (y is up there); both sides draw what lies on an edge; one facing is left out, and triangles of less than half a square pixel's \
area: its source says `det() < 1`, "less than a pixel". |
| [RenderHelp](https://github.com/skywind3000/RenderHelp) | 4e71027 | whole pixels; top-left | certified: 14 of 56 checks | Positions go to the nearest whole pixel, and samples \
are at the corner: `(int)(x + 0.5)`. The words for x are not the simplest ("floor, offset 8/16, samples at -0.5" is "nearest-up, samples at 0"). |
| [PortableGL](https://github.com/rswinkle/PortableGL) | 911292f | positions exact within 0.00013 px; samples at (0.5, 0.49); the viewport lacks 0.01 pixel | certified: 20 of 56 checks | The viewport is \
0.01 pixel too small, as its source has it (`w - 0.01`), so pixels at the far border see another place than those at the near one. |

"""

WEBGPU = """## WebGPU and WebGL2
By hand, once: `surefill certify --level quick --command "node web/serve.mjs --swiftshader"`, seed 1; `./dev web` runs it again. npm's webgpu 0.6.2 (Dawn) under Node on the
SwiftShader of Debian's chromium-common 156.0.8078.108.

| rasterizer | model found | verdict | by hand |
| --- | --- | --- | --- |
| SwiftShader 5.0.0 by Dawn | grid of 4 bits, nearest-even, offset (0, 0), fill rule top-left, rows from the top, profile vulkan | not certified: clear-samples, layers, values, values-clipped | Faults: with four samples a pixel (`values`, `layers`), depth is taken at places that are mirrored in x (four values of one triangle are those of its plane, snapped, at the mirrored places, to four digits; with one sample they are right). A triangle with a vertex of W = 0 may be dropped whole; with W = 2^-20 there it is drawn (`clear-samples`). It cuts triangles by the far plane, and those that reach more than some 256 pixels beyond the target, and snaps the new vertices, which the standard allows: what lies near edges of these is open (R9), so `model-random` finds nothing (before that rule it found one scene, unfairly). `values-clipped` was not looked into beyond one scene, whose vertices have W = 0. |
| SwiftShader by ANGLE, WebGL2 in headless Chromium 156, by the page ([web/](../web/README.md)) | grid of 4 bits, nearest-even, offset (0, 0), fill rule bottom-left, rows from the bottom, profile opengl, clip depth -1 to 1 | not certified: values, values-clipped | The same driver, rows turned. `values`: in 2 of 480 scenes attributes are beyond what is granted, 1.3 times of it, where W is 2 and 2^-12 in one triangle. `values-clipped` as above. Not looked into further. |
| SwiftShader by wgpu, WebGPU in Firefox 153 ESR, by the page | as by Dawn | as by Dawn | Firefox says nothing of its adapter. |
| Mesa's llvmpipe 22.3.6, WebGL2 in Firefox 153 ESR, by the page | grid of 8 bits, nearest-even, offset (0, 0), fill rule bottom-left, rows from the bottom, profile opengl, clip depth -1 to 1 | not certified: model-random, values, values-clipped, values-ordinary | The same checks find something by OpenGL ([llvmpipe.md](certificates/llvmpipe.md)). The scene of `model-random` has the form of bug 1 there: three triangles, the last drawn without area. The others were not looked into. |

The page judges with the engine where the command has the oracle. Of WebGPU on SwiftShader, level quick, seed 1, its certificate and the command's, of one commit, agreed in all 57 checks that
both have: cases, samples, open samples, findings, reduced scenes, largest errors, names (`web/tests/same_test.mjs`; `./dev web` runs it).

"""

HEAD = """# Rasterizers that others made

What `surefill certify` says of rasterizers that Debian 12 and npm deliver, and what a look by hand says of that. Written by `./dev rivals
--write`; `./dev rivals` runs each row again whose package is there, and so does a test. `./dev setup all` installs the packages.
The adapters are in [examples/rivals](../examples/rivals); most are ten lines over `surefill.serve`
([certify-your-rasterizer.md](certify-your-rasterizer.md)). Mesa's llvmpipe, softpipe and lavapipe have pages of their own:
[certificates](certificates/README.md).

Nobody here is wrong for being another rasterizer than ours. Drawing libraries that draw outlines, or whole pixels that a triangle
touches, do what they are for. No place of samples explains such a rule, so that little is owed: certify says "no samples that fit", and what they cover instead, and judges them away
from edges; where it says "not certified: model" of one of them, read what is said by hand. Where certify itself says what is not so, the last column says "yes", and the section says what; each is a fault of the judge that
is to be mended.

| rasterizer | package | model found | verdict | unfair to it |
| --- | --- | --- | --- | --- |
"""


def main(arguments):
    if "--packages" in arguments:
        print(" ".join(row.package for row in ROWS if not row.package.startswith("npm:")))
        return 0
    only = arguments[arguments.index("--only") + 1].split(",") if "--only" in arguments else []
    command, write = os.path.abspath(arguments[0]), "--write" in arguments
    page = PAGE.read_text() if PAGE.is_file() else ""
    matrix, sections, wrong, ran = [], [], [], 0
    for row in ROWS:
        if only and not any(name.lower() in row.name.lower() for name in only):
            continue
        certificate, why = certify(command, row) if is_there(row) else (None, f"{row.package} is not installed")
        version = certificate["rival"]["version"] if certificate else ""
        if certificate and version != row.version:
            certificate, why = None, f"this is {version}, and the row is about {row.version}"
        if not certificate:
            print(f"skipped  {row.name}: {why}")
            continue
        ran += 1
        complaints = [f"{what} is {is_!r}, written is {should!r}" for what, is_, should in (
            ("verdict", certificate["verdict"], row.verdict), ("found by", found_by(certificate), row.found)) if is_ != should]
        matrix.append(matrix_line(row, certificate["rival"]["inferred_model"]))
        sections.append(section(row, certificate))
        if not write and (matrix[-1] not in page or sections[-1] not in page):
            complaints.append("docs/rivals.md says otherwise (--write)")
        wrong += complaints
        print(f"{'DIFFERS' if complaints else 'ok     '}  {row.name} {version}: {certificate['verdict']}; "
              f"{certificate['rival']['inferred_model']}; {found_by(certificate) or 'nothing found'}; {certificate['seconds']:.1f} s")
        for complaint in complaints:
            print(f"         {complaint}")
    if write:
        PAGE.write_text(HEAD + "\n".join(matrix) + "\n\n" + OUTSIDE + WEBGPU + "\n".join(sections))
    if ran == 0:
        return 77
    return 1 if wrong else 0


if __name__ == "__main__":
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1:]))
