#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Results as JSON, held against the files by `surefill verify RESULTS`: right ones pass, each fault is found. results.py SUREFILL"""
import copy
import json
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "examples" / "vectors"))
import run  # noqa: E402: the runner in Python and its rasterizer

faults = checked = 0


def lowest(runs):
    return [word.split(":")[0] if isinstance(word, str) else word for word in runs]


def results_of(document):
    """What a right rasterizer says: the expected side itself, of intervals the lower end."""
    def frame(expected):
        planes = {name: lowest(runs) for name, runs in expected.items() if name not in ("open", "barycentrics", "attributes")}
        planes["barycentrics"] = [lowest(runs) for runs in expected.get("barycentrics", [])]
        planes["attributes"] = [[lowest(runs) for runs in array] for array in expected.get("attributes", [])]
        return planes
    return [{"id": test["id"], "frames": [frame(f["expected"]) for f in test["frames"]]} for test in document["tests"]]


def verify(what, text, status, *needed, stderr=False, folder=HERE):
    """Runs the command on results, and says if its exit status is another one or a needed text is not there."""
    global faults, checked
    checked += 1
    path = pathlib.Path(work) / "results.json"
    path.write_text(text if isinstance(text, str) else json.dumps({"results": text}))
    done = subprocess.run([sys.argv[1], "verify", "--folder", folder, path], capture_output=True, text=True, check=False)
    said = done.stderr if stderr else done.stdout
    one_line = not stderr or (said.count("\n") == 1 and said.startswith(f"surefill: {path}: ") and not done.stdout)
    if (done.returncode == 0) != (status == 0) or done.returncode < 0 or not all(text in said for text in needed) or not one_line:
        faults += 1
        print(f"{what}: exit status {done.returncode}, {needed} needed, said:\n{done.stdout}{done.stderr}")


def main():
    documents = {path.stem: json.loads(path.read_text(encoding="utf-8")) for path in sorted(HERE.glob("*.json"))}
    right = {name: results_of(document) for name, document in documents.items()}
    smoke = right.pop("smoke")
    every = [result for results in right.values() for result in results]
    verify("all files", every, 0, f"PASSED: {len(every)} tests answered")
    verify("the smoke set", smoke, 0, f"PASSED: {len(smoke)} tests answered")
    # From here on a folder of three files.
    small = pathlib.Path(work) / "vectors"
    small.mkdir()
    for name in ("modes", "ties", "values_grid8"):
        (small / f"{name}.json").symlink_to(HERE / f"{name}.json")

    def changed(what, change, *needed, name="modes"):
        results = copy.deepcopy(right[name])
        change(results)
        verify(what, results, 1, "FAILED", *needed, folder=small)

    # One value of each output of the first test that has it.
    for output, bits in (("count", 0), ("index", 0), ("depth", 1), ("winding", 0), ("barycentrics", 1), ("attributes", 2)):
        n = next(n for n, result in enumerate(right["modes"]) if result["frames"][0].get(output))

        def change(results, n=n, output=output, bits=bits):
            runs = results[n]["frames"][0][output]
            for _ in range(bits if output != "depth" else 0):
                runs = runs[0]
            runs[1] = f"{int(runs[1], 16) ^ 1:08x}" if bits else (runs[1] + 1) % 2**31
        name = {"barycentrics": "b0", "attributes": "a0.0"}.get(output, output)
        changed(f"one {output}", change, f"modes test {right['modes'][n]['id']}: {name} of sample 0: ")
    n = next(n for n, result in enumerate(right["values_grid8"]) if 1 in result["frames"][0]["count"][1::2])
    lit = right["values_grid8"][n]["frames"][0]["count"].index(1, 1) // 2

    def outside(results):
        words = results[n]["frames"][0]["barycentrics"][0]
        words[2 * lit + 1] = "7f7fffff"
    changed("outside of an interval", outside, "b0 of sample ", " to ", name="values_grid8")
    changed("a test left out", lambda results: results.pop(), "1 of the same files without an answer")
    changed("a plane left out", lambda results: results[0]["frames"][0].pop("depth"), "test 15001: depth: 0 samples of 16")
    changed("a plane too long", lambda results: results[0]["frames"][0]["count"].__setitem__(0, 10**12), "count: more than 16 samples")
    changed("a plane too short", lambda results: results[0]["frames"][0]["count"].__setitem__(slice(None), [1, 0]), "test 15001: count")
    # The runner's rasterizer: right, and with its fault, which is named.
    for fault in (False, True):
        rows = [{"id": test["id"], "frames": [{"count": [word for value in run.counts(test, fault) for word in (1, value)]}]}
                for test in documents["ties"]["tests"]]
        verify("the runner", rows, fault, "likely: fill-rule-fixed" if fault else "PASSED", folder=small)
    # What is no results: one line, with the file and the cause.
    one = {"id": 15001, "frames": [copy.deepcopy(right["modes"][0]["frames"][0])]}

    def refused(what, *needed, text=None, **parts):
        whole = text if text is not None else json.dumps({"results": [one | parts]})
        verify(what, whole, 1, *needed, stderr=True, folder=small)

    def frame(**planes):
        return [one["frames"][0] | planes]
    refused("nothing", "no JSON", text="")
    refused("half a file", "no JSON", text='{"results": [{"id": 15001, "frames": [{"count"')
    refused("no results", "no results", text='{"result": []}')
    refused("an array", "no results", text="[1, 2]")
    refused("results that are a number", "no results", text='{"results": 3}')
    refused("a result that is a number", "result 1: no id", text='{"results": [3]}')
    refused("an unknown id", "result 1: 999999 is the number of no test", id=999999)
    refused("an id beyond 32 bits", "4294982297 is the number of no test", id=2**32 + 15001)
    refused("an id of text", "result 1: no id", id="15001")
    refused("twice", "result 2: test 15001 a second time", text=json.dumps({"results": [one, one]}))
    refused("no frames", "test 15001: no array of frames", text='{"results": [{"id": 15001}]}')
    refused("two frames", "test 15001: no array of frames, 1 of them", frames=one["frames"] * 2)
    refused("a frame that is text", "frame 0, count: the frame is no object", frames=["count"])
    refused("a count that is a number", "frame 0, count: no array", frames=frame(count=16))
    refused("half a run", "frame 0, count: no array of lengths and values", frames=frame(count=[16]))
    refused("a broken number", "frame 0, count: 0.5 is no whole number", frames=frame(count=[16, 0.5]))
    refused("a count as bits", 'frame 0, count: "00000000" is no whole number', frames=frame(count=[16, "00000000"]))
    refused("true", "frame 0, count: true is no whole number", frames=frame(count=[16, True]))
    refused("a negative length", "frame 0, count: -1 is no length", frames=frame(count=[-1, 0]))
    refused("a depth that is a number", "frame 0, depth: 0.5 is not the bits of a float32", frames=frame(depth=[16, 0.5]))
    refused("seven digits", 'frame 0, depth: "3f00000" is not the bits', frames=frame(depth=[16, "3f00000"]))
    changed("a negative count", lambda results: results[0]["frames"][0]["count"].__setitem__(1, -1), "count: not a number: -1")
    changed("no results at all", lambda results: results.clear(), "0 tests answered")
    print(f"{checked} runs of surefill verify, {faults} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as work:
        sys.exit(main())
