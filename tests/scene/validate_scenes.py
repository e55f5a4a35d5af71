"""Checks that every scene among the examples satisfies schema/scene.schema.json.

Usage: validate_scenes.py SCHEMA FOLDER. Exit code 77 (skipped) where python3-jsonschema is missing.
"""
import json
import pathlib
import re
import sys

try:
    import jsonschema
except ImportError:
    print("skipped: python3-jsonschema not found")
    sys.exit(77)


def without_comments(text):
    """Removes // comments outside of strings."""
    return re.sub(r'("(?:\\.|[^"\\])*")|//[^\n]*', lambda match: match.group(1) or "", text)


def main():
    schema = json.loads(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    misspelt = {"terms": [{"type": "cst_stvk", "yuong": "1 MPa"}]}
    defects = [] if list(validator.iter_errors(misspelt)) else ["the schema accepts a misspelt key"]
    for scene in sorted(pathlib.Path(sys.argv[2]).rglob("scene*.json")):
        content = json.loads(without_comments(scene.read_text(encoding="utf-8")))
        defects += [f"{scene}: {error.json_path}: {error.message}" for error in validator.iter_errors(content)]
    print("\n".join(defects) or "all scenes satisfy the schema")
    return 1 if defects else 0


sys.exit(main())
