#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Are the files of this folder valid under their schemas? validate.py [FILE.json ...] needs Debian's python3-jsonschema."""
import json
import pathlib
import sys

try:
    import jsonschema
except ImportError:
    print("skipped: there is no python3-jsonschema")
    sys.exit(77)


def main(names):
    folder, faults = pathlib.Path(__file__).resolve().parent, 0
    files = [pathlib.Path(name) for name in names] or sorted(folder.glob("*.json"))
    for path in files:
        document = json.loads(path.read_text(encoding="utf-8"))
        schema = json.loads((path.parent / document["schema"]).read_text(encoding="utf-8"))
        jsonschema.Draft202012Validator.check_schema(schema)
        errors = list(jsonschema.Draft202012Validator(schema).iter_errors(document))
        if len(document["tests"]) != document["number_of_tests"]:
            faults += 1
            print(f"{path}: {len(document['tests'])} tests, and not {document['number_of_tests']}")
        for error in errors[:5]:
            print(f"{path}: {'/'.join(map(str, error.absolute_path))}: {error.message[:200]}")
        faults += len(errors)
    print(f"{len(files)} files, {faults} faults")
    return 1 if faults or not files else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
