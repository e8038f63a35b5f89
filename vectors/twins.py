#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Is each test's line of SUBJECT.txt, word for word, what docs/vectors.md makes of its JSON, and SUBJECT.faults.txt of its kills?

And is each test of the smoke set word for word one of another file, and are all ids unique? The page alone says how words follow.
"""
import itertools
import json
import pathlib
import sys

MODELS = {"exact": 1, "grid4": 2, "grid8": 4}
OUTPUTS = {"count": 1, "index": 2, "depth": 4, "barycentrics": 8, "attributes": 16, "winding": 32}


def unroll(runs):
    return [value for length, value in zip(runs[::2], runs[1::2]) for _ in range(length)]


def rolled(values):
    """A plane: the number of runs, and each one's length and value."""
    runs = [(len(list(group)), value) for value, group in itertools.groupby(values)]
    return [len(runs)] + [word for run in runs for word in run]


def planes(expected, end):
    """In the order of the text, the least values (end 0) or the largest (end -1)."""
    found = []
    if "count" in expected:
        opened = unroll(expected.get("open", [])) if end else []
        found.append([count + more for count, more in itertools.zip_longest(unroll(expected["count"]), opened, fillvalue=0)])
    named = [expected[name] for name in ("index", "depth") if name in expected] + expected.get("barycentrics", [])
    for runs in named + sum(expected.get("attributes", []), []) + ([expected["winding"]] if "winding" in expected else []):
        found.append([value.split(":")[end] if isinstance(value, str) else value for value in unroll(runs)])
    return [word for values in found for word in rolled(values)]


def draw_words(draw, names):
    """`names` are the schema's enumerators, in their order."""
    state, words = draw["state"], []
    for name in ("fill_rule", "front_face", "cull", "depth_mode"):
        words.append(names[name].index(state[name]))
    words += [int(state["depth_write"]), names["conservative"].index(state["conservative"])]
    words += [1, *state["scissor"]] if "scissor" in state else [0]
    if "grid" in state:
        *numbers, rounding = state["grid"]
        words += [1, *numbers, names["rounding"].index(rounding)]
    else:
        words.append(0)
    words += [1, *state["culling_box"]] if "culling_box" in state else [0]
    words += [1, *state["depth_bias"]] if "depth_bias" in state else [0]
    words += [draw.get("first_index", 0), len(draw["vertices"]["bits"])] + sum(draw["vertices"]["bits"], [])
    words += [len(draw["triangles"])] + sum(draw["triangles"], [])
    words += [1, *draw["identifiers"]] if "identifiers" in draw else [0]
    words.append(len(draw.get("attributes", [])))
    for array in draw.get("attributes", []):
        words += [len(array["bits"][0]), names["interpolation"].index(array["interpolation"])] + sum(array["bits"], [])
    return words


def line_of(test, names):
    target = test["target"]
    places = target.get("sample_locations", [])
    asked = test["frames"][0]["expected"]
    words = [sum(MODELS[model] for model in test["models"]), target["width"], target["height"], target["samples"],
             names["depth_test"].index(target["depth_test"]), names["attribute_location"].index(target["attribute_location"]),
             *target.get("origin", (0, 0)), len(places), *sum(places, []), target.get("layers", 1),
             *test.get("window", (0, 0, target["width"], target["height"])), sum(OUTPUTS[name] for name in asked if name != "open"),
             len(test["frames"])]
    for frame in test["frames"]:
        initial = frame.get("initial_depth")
        words += [2] if initial == "previous" else [1, *rolled(unroll(initial))] if initial else [0]
        words += [len(frame["draws"])] + [word for draw in frame["draws"] for word in draw_words(draw, names)]
    words = [test["id"], len(words) + 2] + words
    for frame in test["frames"]:
        words += planes(frame["expected"], 0) + planes(frame["expected"], -1)
    return " ".join(map(str, words))


def names_of(schema):
    kinds = schema["$defs"]
    state, target = kinds["state"]["properties"], kinds["test"]["properties"]["target"]["properties"]
    attribute = kinds["draw"]["properties"]["attributes"]["items"]["properties"]
    names = {name: member["enum"] for name, member in (state | target | attribute).items() if "enum" in member}
    return names | {"rounding": state["grid"]["items"]["anyOf"][1]["enum"]}


def main(folder):
    faults, lines, tests = 0, 0, {}
    documents = {path.stem: json.loads(path.read_text(encoding="utf-8")) for path in sorted(folder.glob("*.json"))}

    def differs(what):
        nonlocal faults
        faults += 1
        print(what)

    for subject, document in documents.items():
        names = names_of(json.loads((folder / document["schema"]).read_text(encoding="utf-8")))
        text = (folder / f"{subject}.txt").read_text(encoding="utf-8").splitlines()
        if len(text) != len(document["tests"]):
            differs(f"{subject}.txt: {len(text)} lines, {len(document['tests'])} tests")
        for line, test in zip(text, document["tests"]):
            lines += 1
            if line != line_of(test, names):
                differs(f"{subject}.txt: the line of test {test['id']} is not what its JSON says")
            if subject != "smoke" and tests.setdefault(test["id"], test) is not test:
                differs(f"{subject}.json: {test['id']} is the number of another test, too")
        shown = {row.split()[0]: row.split()[1:] for row in (folder / f"{subject}.faults.txt").read_text(encoding="utf-8").splitlines()}
        said = {name: [str(test["id"]) for test in document["tests"] if name in test["kills"]] for name in document["notes"]}
        if shown != {name: ids for name, ids in said.items() if ids}:
            differs(f"{subject}.faults.txt: not what the tests kill")
    for test in documents["smoke"]["tests"]:
        if tests.get(test["id"]) != test:
            differs(f"smoke.json: test {test['id']} is none of another file")
    print(f"{lines} lines, {faults} faults")
    return 1 if faults or not lines else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent))
